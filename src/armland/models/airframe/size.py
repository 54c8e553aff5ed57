"""Ratios of a UAV to the AR.Drone 2.0, by which `sizing` carries over what was tried on it.

| symbol | name | AR.Drone |
|---|---|---|
| m | mass without plate and extra load | 0.48 kg |
| J_i | inertia about each body axis | 0.006, 0.007, 0.012 kg·m² |
| J_p | larger inertia about the pivot, J + m ρ² | 0.0087 kg·m² |
| r | mean distance of the rotors from the middle axis | 0.180 m |
| τ | rotor lag | 0.05 s |
| n | number of rotors | 4 |
| R | radius of a rotor | 0.1 m |
| ω | bandwidth of the attitude loop on board: the AR.Drone's times (τ₀/τ), and no faster than its sampling bears | |
"""

from typing import NamedTuple

import numpy as np

from armland.models.parameters import rotor_set, uav_parameters
from armland.scenario import Scenario

MASS_KG, LAG_S, RADIUS_M, RATE_HZ, RATING_N, THRUST_N = 0.48, 0.05, 0.1, 200, 177.0, 4 * 1.86
INERTIA = np.array([0.006, 0.007, 0.012])
LEVER_M, REACH_M = np.array([0.0, 0.0, -0.06]), float(np.hypot(0.127, 0.127))

FASTEST = 2.0
"""Largest bandwidth over rate of samples, in terms of the AR.Drone's: eleven samples within 1/ω are left, where it has eleven at 1."""


class Size(NamedTuple):
    """Ratios of a UAV to the AR.Drone; exactly 1 where nothing differs."""

    mass: float
    inertia: tuple[float, float, float]
    about_pivot: float
    """J_p."""
    reach: float
    """r."""
    number: float
    """n."""
    bandwidth: float
    """ω."""
    lag: float
    """τ."""
    radius: float
    """R."""
    rating: float
    """Of the magnet."""
    thrust: float
    """Largest of all rotors."""
    lever: float
    """ρ, vertical."""
    lower: float
    """How much lower the pivot is, m: a difference and no ratio."""


def size_of(scenario: Scenario) -> Size:
    """Ratios of a scenario's UAV to the AR.Drone.

    Raises:
        ModelError: the UAV's file cannot be used.
    """
    body, rotors = uav_parameters(scenario), rotor_set(scenario)
    mass = body.mass - scenario.uav.extra_mass_kg if scenario.uav.extra_mass_kg else body.mass
    inertia = np.diag(body.inertia)
    ratios = [_near(j) for j in inertia / INERTIA]
    reach = float(np.hypot(rotors.place[:, 0], rotors.place[:, 1]).mean())
    lag = scenario.rotors.time_constant_s / LAG_S
    swung = _swung(inertia, mass, body.lever) / _swung(INERTIA, MASS_KG, LEVER_M)
    return Size(
        mass=_near(mass / MASS_KG),
        inertia=(ratios[0], ratios[1], ratios[2]),
        about_pivot=_near(swung),
        reach=_near(reach / REACH_M),
        number=rotors.number / 4,
        bandwidth=min(_near(1.0 / lag), FASTEST * scenario.onboard.rate_hz / RATE_HZ),
        lag=_near(lag),
        radius=_near(scenario.rotors.radius_m / RADIUS_M),
        rating=_near(scenario.magnet.rating_n / RATING_N),
        thrust=_near(rotors.number * scenario.rotors.max_thrust_n / THRUST_N),
        lever=_near(body.lever[2] / LEVER_M[2]),
        lower=float(LEVER_M[2] - body.lever[2]),
    )


def _near(ratio: float) -> float:
    # What differs by rounding alone is the AR.Drone's.
    return 1.0 if abs(ratio - 1.0) < 1e-9 else float(ratio)


def _swung(inertia: np.ndarray, mass: float, lever: np.ndarray) -> float:
    return float(max(inertia[0], inertia[1]) + mass * lever[2] ** 2)
