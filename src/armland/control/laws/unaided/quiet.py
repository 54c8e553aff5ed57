"""When to come down on a pad that moves: the unrest that is expected at the touchdown; compiled.

| symbol | name | unit, frame |
|---|---|---|
| n, v | tilt (2,) of the pad's normal against its mean, and velocity upwards of the pad's middle | rad, m/s |
| n̈, v̈ = −ω_c² n, −ω_c² v | how both go on: one swing of frequency ω_c = √(A/V), (K.3) | |
| T | `ahead`: time until the touchdown | s |
| ṽ | speed of the UAV against its station | m/s |
| v₀, n₀ | `SPEED_MPS`, `TILT_RAD`: what a touchdown may have | m/s, rad |

    n̂ = n cos ω_c T + ṅ sin ω_c T/ω_c,  v̂ = v cos ω_c T + a sin ω_c T/ω_c                               (Q.1)
    U² = (v̂/v₀)² + |n̂|²/n₀² + (ṽ/v₀)²                                                                   (Q.2)

The UAV goes along with the pad, so v̂ itself is no speed of the touchdown; where the pad is slow, lateness of link and rotors makes
the least error of it. A sea of one swing is a strong simplification: the prediction is good for a fraction of its period.

Source: the idea to time a landing by a forecast of tilt is that of arXiv 2410.21674, which learns the cost; this index is our own.
"""

import numpy as np
from numba import njit

from armland.rotations import Array

SPEED_MPS = 0.25
"""v₀: largest relative speed of a touchdown in wind, `mission.missions.weather`."""

TILT_RAD = 0.0873
"""n₀: its largest tilt, 5 degrees."""


@njit(cache=True)
def ahead_of(value: float, rate: float, omega: float, ahead: float) -> float:
    """What a swing of `omega`, rad/s, comes to after `ahead`, s, from `value` and `rate`, any unit and per s."""
    if omega * ahead < 1e-6:
        return value + rate * ahead
    return float(value * np.cos(omega * ahead) + rate * np.sin(omega * ahead) / omega)  # (Q.1)


@njit(cache=True)
def unrest(tilt: Array, tilt_rate: Array, rise: tuple[float, float], error: float, swing: tuple[float, float]) -> float:
    """U, ratio: 1 where the pad alone uses up what a touchdown may have.

    Args:
        tilt: n (2,), rad.
        tilt_rate: ṅ (2,), rad/s.
        rise: v, m/s, and its rate, m/s².
        error: ṽ, m/s.
        swing: ω_c, rad/s, and T, s.
    """
    omega, ahead = swing
    total = (ahead_of(rise[0], rise[1], omega, ahead) / SPEED_MPS) ** 2 + (error / SPEED_MPS) ** 2
    for i in range(2):
        total += (ahead_of(tilt[i], tilt_rate[i], omega, ahead) / TILT_RAD) ** 2
    return float(np.sqrt(total))  # (Q.2)
