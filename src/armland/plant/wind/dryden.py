"""Dryden turbulence at low altitude, as one exact step per tick.

| symbol | name | unit |
|---|---|---|
| h | `height` above ground or sea, from 10 to 1000 ft | m; ft where the source's numbers need it |
| W20 | `w20`: mean wind at 20 ft | m/s |
| σ_u, σ_v, σ_w | intensities along the mean wind, across it, upwards | m/s |
| L_u, L_v, L_w | lengths | m |
| V | `speed` at which the field passes by | m/s |
| Δ | `x` = V Δt/L: a tick as a share of the field's time | 1 |

σ_w = 0.1 W20, σ_u = σ_v = σ_w/(0.177 + 0.000823 h)^0.4, L_w = h, L_u = L_v = h/(0.177 + 0.000823 h)^1.2, h in ft.
Φ_u ∝ 1/(1 + (L_u Ω)²), Φ_v,w ∝ (1 + 3(LΩ)²)/(1 + (LΩ)²)². Source: MIL-F-8785C, 3.7. MIL-HDBK-1797 writes L for L/2 across and
upwards, in lengths and spectra alike: at low altitude both are the same turbulence.

In time L/V as unit the shaping filters of unit variance are 1/(1 + s) and (1 + √3 s)/(1 + s)², the latter with the states
ẋ = A x + b n, y = x₁ + √3 x₂, A = [0 1; −1 −2], b = [0 1]ᵀ, whose stationary covariance is I/4. A tick is x ← Φx + R ν with
Φ = e^(AΔ) and RRᵀ = ∫₀^Δ e^(As) b bᵀ e^(Aᵀs) ds, both from one matrix exponential (Van Loan 1978, IEEE TAC 23, 395): the variance
is σ² at every tick of any length.

The field is taken as frozen: it passes at V = the mean wind, as the UAV hovers. That needs σ ≪ V, which a UAV that hovers near
the ground does not have: at 10 ft σ_u is a third of V. Real turbulence there changes faster than this. Rotation of the air is left out.
"""

import numpy as np
from scipy.linalg import cholesky, expm

from armland.rotations import Array

FOOT_M = 0.3048
KNOT_MPS = 0.514444

W20_MPS = {"light": 15.0 * KNOT_MPS, "moderate": 30.0 * KNOT_MPS, "severe": 45.0 * KNOT_MPS}
"""W20 by name of the turbulence. Source: MIL-F-8785C, 3.7."""

LOWEST_M, HIGHEST_M = 10.0 * FOOT_M, 1000.0 * FOOT_M
"""Heights between which the source gives lengths and intensities of low altitude; others count as the nearer of them."""

SLOWEST_MPS = 1.0
"""V of a field that hardly moves: one that stood still would be no turbulence. Assumption; RotorPy takes the same."""


def intensities(w20: float, height: float) -> Array:
    """σ (3,) m/s along the mean wind, across it, upwards."""
    up = 0.1 * w20
    level = up / _bracket(height) ** 0.4
    return np.array([level, level, up])


def lengths(height: float) -> Array:
    """L (3,) m along the mean wind, across it, upwards, of MIL-F-8785C."""
    h = _clipped(height)
    level = h / _bracket(height) ** 1.2
    return np.array([level, level, h])


def _clipped(height: float) -> float:
    return min(max(height, LOWEST_M), HIGHEST_M)


def _bracket(height: float) -> float:
    return 0.177 + 0.000823 * _clipped(height) / FOOT_M


def along_step(x: float) -> tuple[float, float]:
    """e^(−Δ) and the weight of fresh noise √(1 − e^(−2Δ)) of the first filter, for Δ = `x`."""
    return float(np.exp(-x)), float(np.sqrt(-np.expm1(-2.0 * x)))


def across_step(x: float) -> tuple[Array, Array]:
    """Φ and R (2, 2), R lower triangular, of the second filter, for Δ = `x`."""
    A, b = np.array([[0.0, 1.0], [-1.0, -2.0]]), np.array([[0.0], [1.0]])
    found = expm(x * np.block([[-A, b @ b.T], [np.zeros((2, 2)), A.T]]))
    step = found[2:, 2:].T
    return step, cholesky(step @ found[:2, 2:], lower=True)
