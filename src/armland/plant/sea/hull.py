"""A hull that follows the waves' contour: the mean of the surface over its waterline, and the plane that fits it best.

| symbol | name | unit, frame |
|---|---|---|
| hull axes | x ahead, y to port, z up; at rest those of D and W | |
| ζ = Re(a e^{i(ω_e t − k·r + ε)}) | elevation at r of a wave that travels towards χ | m |
| k = ω²/g, ω_e = ω − k U cos χ | deep water; frequency of encounter at the speed U ahead | rad/m, rad/s |
| H (6,) | motion = Re(H a e^{i(ω_e t + ε)}), in the order of `MOTIONS`; a positive phase leads the crest at r = 0 | m/m, rad/m |
| s, σ | mean of a wave over the length, over the beam, 1: sin(x)/x; best slope over its slope, 1: 3 (sin x − x cos x)/x³ | |
| x, y | ½ k L cos χ, ½ k B sin χ | 1 |

The surface's water moves by −i a along χ. So H = (−i cos χ s_x s_y, −i sin χ s_x s_y, s_x s_y, −i k sin χ s_x σ_y, i k cos χ σ_x s_y,
−k sin χ cos χ σ_x s_y): roll is positive with port up, pitch with the bow down. There is no inertia and no resonance in it:
a lightly damped monohull rolls up to three times as far; give its response as a table.
"""

import numpy as np

from armland.rotations import Array

GRAVITY = 9.81

MOTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


def contour(omega: Array, towards: Array, length: float, beam: float) -> Array:
    """H (k, 6), complex, m/m and rad/m.

    Args:
        omega: of the waves (k,), rad/s.
        towards: χ (k,), rad, from the bow counter-clockwise.
        length: L, m.
        beam: B, m.
    """
    k, ahead, aside = omega**2 / GRAVITY, np.cos(towards), np.sin(towards)
    x, y = 0.5 * k * length * ahead, 0.5 * k * beam * aside
    mean = _mean(x) * _mean(y)
    pitching = k * _slope(x) * _mean(y)
    rows = (
        *(-1j * ahead * mean, -1j * aside * mean, mean),
        *(-1j * k * aside * _mean(x) * _slope(y), 1j * ahead * pitching, -aside * ahead * pitching),
    )
    return np.stack(rows, axis=1)


def _mean(x: Array) -> Array:
    return np.sinc(x / np.pi)


def _slope(x: Array) -> Array:
    # 3 (sin x − x cos x)/x³ is 1 − x²/10 + … near zero, where it would be 0/0.
    far = np.where(np.abs(x) < 1e-3, 1.0, x)
    return np.where(np.abs(x) < 1e-3, 1.0 - x**2 / 10.0, 3.0 * (np.sin(far) - far * np.cos(far)) / far**3)
