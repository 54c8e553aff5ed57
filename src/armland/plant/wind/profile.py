"""The mean wind over height; compiled.

| symbol | name | unit |
|---|---|---|
| U | `speed` at the reference height h_r | m/s |
| h, h_r, z₀ | `height` above ground or sea, `reference`, `roughness` | m |
| a | `exponent` | 1 |

`log`: U ln(h/z₀)/ln(h_r/z₀), nothing below z₀. Source: MIL-F-8785C, 3.7.3, from 3 ft on with h_r = 20 ft and, for landing,
z₀ = 0.15 ft; below 3 ft the same law is followed. `power`: U (h/h_r)^a.
"""

import numpy as np
from numba import njit

from armland.plant.noise import stream
from armland.plant.wind.dryden import FOOT_M, SLOWEST_MPS
from armland.rotations import Array
from armland.scenario import Scenario

PROFILES = ("even", "log", "power")
"""Names by number."""

EVEN, LOG, POWER = range(3)

W20_AT_M = 20.0 * FOOT_M


@njit(cache=True)
def mean_speed(height: float, kind: int, speed: float, reference: float, roughness: float, exponent: float) -> float:
    """Mean wind, m/s, at `height` m; `kind` is the number of the profile in `PROFILES`."""
    if kind == LOG:
        return float(speed * np.log(max(height / roughness, 1.0)) / np.log(reference / roughness))
    if kind == POWER:
        return float(speed * max(height / reference, 0.0) ** exponent)
    return speed


def speed_at(scenario: Scenario, height: float) -> float:
    """Mean wind of the scenario, m/s, at `height` m above ground or sea."""
    a = scenario.air
    kind = PROFILES.index(a.profile)
    return float(mean_speed(height, kind, a.wind_mps, a.reference_m, a.roughness_m, a.exponent))


def height_of_catch(scenario: Scenario) -> float:
    """Height of the catch above ground or sea, m: turbulence has the size and the speed of there throughout a flight."""
    return scenario.air.floor_m + scenario.place.catch_m[2]


def passing_speed(scenario: Scenario) -> float:
    """V, m/s, at which turbulence and gusts pass by: the mean wind at the catch, and not less than `SLOWEST_MPS`."""
    return max(speed_at(scenario, height_of_catch(scenario)), SLOWEST_MPS)


def towards(scenario: Scenario) -> Array:
    """Horizontal direction (3,) in which the mean wind blows, W, 1: the scenario's, or one that its seed draws."""
    told = scenario.air.towards_deg
    angle = stream(scenario.run.seed, "air.towards").uniform(-np.pi, np.pi) if told is None else np.deg2rad(told)
    return np.array([np.cos(angle), np.sin(angle), 0.0])
