"""What momentum theory and the arm's limits say about the take-off weight; weights over the static thrust, speeds in m/s.

A UAV too heavy to hover, thrown by the arm: may it gain what forward flight lifts more before it has lost its height? Point mass.

| symbol | name | unit |
|---|---|---|
| x, z; ẋ, ż | along the throw and upwards | m, m/s |
| θ | tilt of the thrust towards x | rad |
| W, c | `weight`, linear drag, horizontal | N, N·s/m |

(W/g) ẍ = T sin θ − c ẋ, (W/g) z̈ = T cos θ − W, T at full command by `models.inflow`. The pilot tilts by one angle until he has one
speed, then by what holds the drag: over all pairs of a grid that is a lower bound of what any pilot can do. No pilot can do
better for long than the heaviest UAV that flies level at any speed.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.models.environment import STANDARD_GRAVITY
from armland.models.inflow import Rotors, factor, level_flight
from armland.rotations import Array

TILTS = np.array([0.0, 0.03, 0.06, 0.1, 0.14, 0.2, 0.28, 0.4])  # rad, while it gains speed
TARGETS = np.array([0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0])  # m/s, at which it stops gaining speed
ELEVATIONS = np.deg2rad([0.0, 15.0, 30.0, 45.0, 60.0, 90.0])  # Of the throw above the horizon
LAG_S = 0.15  # With which the tilt follows: attitude loop and rotors

STEP_S, HORIZON_S = 0.01, 12.0


class Throw(NamedTuple):
    """Speed, m/s, and elevation, rad, at the release, and the height, m, that may be lost after it."""

    speed: float
    elevation: float
    height: float


class Air(NamedTuple):
    """Rotors at full command in the air: at constant power or constant speed; linear horizontal drag of the UAV, N·s/m."""

    rotors: Rotors
    drag: float
    power: bool = False


@njit(cache=True)
def survives(share: float, throw: Throw, tilt: float, target: float, air: Air) -> bool:
    """Whether a UAV of `share` times the static thrust never sinks `throw.height` below its release and no longer sinks at the end.

    It is tilted by `tilt`, rad, until it has `target`, m/s.
    """
    r, weight = air.rotors, share * air.rotors.static
    x, z, rise, theta = throw.speed * np.cos(throw.elevation), 0.0, throw.speed * np.sin(throw.elevation), 0.0
    for _ in range(int(HORIZON_S / STEP_S)):
        wanted = tilt if x < target else air.drag * x / weight
        theta += STEP_S / LAG_S * (wanted - theta)
        sine, cosine = np.sin(theta), np.cos(theta)
        across, along = abs(x * cosine - rise * sine), x * sine + rise * cosine
        t = factor(air.power, r.static / r.number, across, along, r.disc, r.slope, r.advance) * r.static
        x += STEP_S * STANDARD_GRAVITY * (t * sine - air.drag * x) / weight
        rise += STEP_S * STANDARD_GRAVITY * (t * cosine / weight - 1.0)
        z += STEP_S * rise
        if z < -throw.height:
            return False
    return rise >= -1e-3


@njit(cache=True)
def _any_pilot(share: float, throw: Throw, air: Air, tilts: Array, targets: Array) -> bool:
    for tilt in tilts:
        for target in targets:
            if survives(share, throw, tilt, target, air):
                return True
    return False


def heaviest_thrown(air: Air, speed: float, height: float) -> tuple[float, float]:
    """Largest weight over the static thrust that flies off after a throw at `speed` m/s, and the throw's best elevation, rad.

    Args:
        air: what carries it.
        speed: that the arm gives, m/s.
        height: that may be lost, m.
    """
    found = []
    for elevation in ELEVATIONS if speed > 0.0 else ELEVATIONS[:1]:
        throw, low, high = Throw(speed, float(elevation), height), 0.9, 1.3
        for _ in range(11):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if _any_pilot(middle, throw, air, TILTS, TARGETS) else (low, middle)
        found.append(low)
    best = int(np.argmax(found))
    return found[best], float(ELEVATIONS[best])


def level_share(air: Air, speed: float) -> float:
    """Largest weight over the static thrust that flies level at `speed` m/s."""
    r = air.rotors
    return float(level_flight(speed, air.drag / r.number, air.power, r.static / r.number, r.disc, r.slope, r.advance))


def heaviest_at_any_speed(air: Air) -> tuple[float, float]:
    """Largest weight over the static thrust that flies level, and the speed at which it does, m/s."""
    speeds = np.linspace(0.0, 20.0, 401)
    share = [level_share(air, v) for v in speeds]
    best = int(np.argmax(share))
    return share[best], float(speeds[best])


def speed_for_gain(air: Air, gain: float) -> float | None:
    """Smallest speed, m/s, at which the rotors carry 1 + `gain` times their static thrust in level flight; None: at none."""
    return next((float(v) for v in np.linspace(0.0, 40.0, 4001) if level_share(air, v) >= 1.0 + gain), None)


READINGS = {"constant rotor speed": False, "constant power": True}
"""What full command means, and whether the motors' power is what stays."""

HEIGHTS_M = (0.03, 0.5)  # Height that a thrown UAV may lose
GAINS = (0.05, 0.10, 0.20)  # Gains of weight for which a speed is looked for


class Theory(NamedTuple):
    """What is possible without flying; by reading, and by reading `, no drag`."""

    sustained: dict[str, float]  # Heaviest in level flight at the largest horizontal speed of the arm
    most: dict[str, tuple[float, float]]  # Heaviest in level flight at any speed, and that speed
    speed_for_gain: dict[str, dict[str, float | None]]
    thrown: dict[str, dict[str, float]]
    """Best throw at the speed that the arm gives in every direction, and at none, by reading and height that may be lost."""


def theory(rotors: Rotors, drag: float, horizontal: float, anywhere: float) -> Theory:
    """The theory for speeds of the arm.

    Args:
        rotors: of the UAV.
        drag: linear, horizontal, N·s/m.
        horizontal: largest horizontal speed that the arm can give, m/s.
        anywhere: speed that it can give in every direction, m/s.
    """
    level, thrown, gains, most = {}, {}, {}, {}
    for reading, power in READINGS.items():
        air = Air(rotors, drag, power)
        for here, name in ((air, reading), (air._replace(drag=0.0), f"{reading}, no drag")):
            level[name] = level_share(here, horizontal)
            gains[name] = {f"{g:g}": speed_for_gain(here, g) for g in GAINS}
        most[reading] = heaviest_at_any_speed(air)
        for height in HEIGHTS_M:
            weight, elevation = heaviest_thrown(air, anywhere, height)
            thrown[f"{reading}, {height:g} m"] = {
                "thrown": weight,
                "elevation_deg": float(np.rad2deg(elevation)),
                "from rest": heaviest_thrown(air, 0.0, height)[0],
            }
    return Theory(level, most, gains, thrown)
