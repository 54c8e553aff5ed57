"""The septic polynomial from 0 to 1 with velocity, acceleration and jerk zero at both ends, and its integral; compiled.

| symbol | name | unit |
|---|---|---|
| u | fraction of the time that has gone by | 1 |
| s(u) = 35u⁴ − 84u⁵ + 70u⁶ − 20u⁷ | first result of `septic` | 1 |
| S(u) = ∫₀ᵘ s, 1/2 at u = 1 | first result of `septic_integral` | 1 |
"""

from numba import njit

PEAK = 2.1875
"""Largest rate of s over its mean: 35/16."""

SWELL = 16.8 / 5.0**0.5
"""Largest second derivative of s by u, at u = (5 − √5)/10."""


@njit(cache=True)
def septic(u: float, duration: float) -> tuple[float, float, float]:
    """s, ṡ in 1/s and s̈ in 1/s² at the fraction u of a move of `duration` s; at rest before and after it."""
    if u <= 0.0:
        return 0.0, 0.0, 0.0
    if u >= 1.0:
        return 1.0, 0.0, 0.0
    w = 1.0 - u
    s = u**4 * (35.0 + u * (-84.0 + u * (70.0 - 20.0 * u)))
    return s, 140.0 * u**3 * w**3 / duration, 420.0 * u * u * w * w * (1.0 - 2.0 * u) / duration**2


@njit(cache=True)
def septic_integral(u: float) -> float:
    """S at u in [0, 1]: displacement over speed and duration of a motion whose speed grows as s."""
    return u**5 * (7.0 + u * (-14.0 + u * (10.0 - 2.5 * u)))
