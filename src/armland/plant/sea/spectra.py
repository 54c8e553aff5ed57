"""One-sided spectra of the waves' height over frequency.

| symbol | name | unit |
|---|---|---|
| S | density over ω: m₀ = ∫₀^∞ S dω, H_s = 4 √m₀ | m²·s/rad |
| ω, ω_p = 2π/T_p | `omega`; of the peak, T_p the modal `period` | rad/s, s |
| H_s | `height`: significant wave height | m |
| γ, σ | `peak`; width of the peak, 0.07 below ω_p and 0.09 above | 1 |

Bretschneider (ITTC): S = (5/16) H_s² ω_p⁴ ω⁻⁵ exp(−1.25 (ω_p/ω)⁴). JONSWAP: S_B γ^b (1 − 0.287 ln γ), b = exp(−(ω − ω_p)²/(2σ²ω_p²)).
Source: DNV-RP-C205, 3.5.5; its factor of γ keeps H_s within 1 %.
"""

import numpy as np

from armland.rotations import Array


def bretschneider(omega: Array, height: float, period: float) -> Array:
    """S (k,), m²·s/rad, at the frequencies `omega` (k,), rad/s, above 0; `height` in m, `period` in s."""
    at = 2.0 * np.pi / period / omega
    return 0.3125 * height**2 * at**4 / omega * np.exp(-1.25 * at**4)


def jonswap(omega: Array, height: float, period: float, peak: float) -> Array:
    """S (k,), m²·s/rad, at `omega` (k,), rad/s, above 0; `height` in m, `period` in s, `peak` a ratio."""
    middle = 2.0 * np.pi / period
    sigma = np.where(omega < middle, 0.07, 0.09)
    b = np.exp(-((omega - middle) ** 2) / (2.0 * (sigma * middle) ** 2))
    return (1.0 - 0.287 * np.log(peak)) * bretschneider(omega, height, period) * peak**b
