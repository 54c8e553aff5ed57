"""Operational-space inertia and the dynamically consistent null space, compiled.

| symbol | name | unit |
|---|---|---|
| Λ = (𝒥 M⁻¹ 𝒥ᵀ)⁻¹ (4) | `lambda_ee` (6, 6) | kg, kg·m² |
| 𝒥̄ = M⁻¹ 𝒥ᵀ Λ | dynamically consistent inverse (n, 6) | |

Near a singularity 𝒥 M⁻¹ 𝒥ᵀ loses rank. Its smallest LDLᵀ pivot is then damped: below `PIVOT_THRESHOLD` a multiple of the identity is
added that grows smoothly to `PIVOT_THRESHOLD` at the singularity, so Λ stays finite and continuous. Above it Λ is exact.
"""

import numpy as np
from numba import njit

from armland.rotations import Array

PIVOT_THRESHOLD = 0.02
"""Smallest pivot of 𝒥 M⁻¹ 𝒥ᵀ (1/kg or 1/(kg·m²)) that is inverted undamped: an apparent mass of 50 kg."""

ITERATIONS = 25
"""Inverse iterations of `smallest_singular_value`."""


@njit(cache=True)
def cholesky(A: Array, L: Array) -> float:
    """Lower Cholesky factor of a symmetric matrix; returns the smallest pivot: 0 or less, and the matrix is not positive definite.

    Args:
        A: (n, n), of any units.
        L: (n, n), in the units' roots, written.
    """
    n = A.shape[0]
    smallest = np.inf
    for j in range(n):
        s = A[j, j]
        for k in range(j):
            s -= L[j, k] * L[j, k]
        smallest = min(smallest, s)
        if s <= 0.0:
            return smallest
        root = np.sqrt(s)
        L[j, j] = root
        for i in range(j + 1, n):
            t = A[i, j]
            for k in range(j):
                t -= L[i, k] * L[j, k]
            L[i, j] = t / root
    return smallest


@njit(cache=True)
def _forward(L: Array, B: Array, X: Array) -> None:
    # X = L⁻¹ B
    n, m = B.shape
    for c in range(m):
        for i in range(n):
            s = B[i, c]
            for k in range(i):
                s -= L[i, k] * X[k, c]
            X[i, c] = s / L[i, i]


@njit(cache=True)
def operational_inertia(M: Array, jacobian: Array, L: Array, lambda_ee: Array) -> float:
    """Λ (4) of one configuration; returns the smallest pivot of 𝒥 M⁻¹ 𝒥ᵀ, 1/kg or 1/(kg·m²).

    Args:
        M: joint-space inertia (n, n), kg·m².
        jacobian: 𝒥 (6, n), m and 1.
        L: lower Cholesky factor of M (n, n), zero above the diagonal, written.
        lambda_ee: Λ (6, 6), kg and kg·m², written.

    Source: (4); damping below `PIVOT_THRESHOLD` is ours.
    """
    n = M.shape[0]
    cholesky(M, L)
    X = np.empty((n, 6))
    _forward(L, jacobian.T, X)
    A = np.empty((6, 6))
    for i in range(6):
        for j in range(i + 1):
            s = 0.0
            for k in range(n):
                s += X[k, i] * X[k, j]
            A[i, j] = A[j, i] = s
    L6 = np.zeros((6, 6))
    pivot = cholesky(A, L6)
    if pivot < PIVOT_THRESHOLD:
        lack = 1.0 - max(pivot, 0.0) / PIVOT_THRESHOLD
        for i in range(6):
            A[i, i] += PIVOT_THRESHOLD * lack * lack
        cholesky(A, L6)
    inverse = np.empty((6, 6))
    _forward(L6, np.eye(6), inverse)
    for i in range(6):
        for j in range(i + 1):
            s = 0.0
            for k in range(i, 6):
                s += inverse[k, i] * inverse[k, j]
            lambda_ee[i, j] = lambda_ee[j, i] = s  # (4)
    return pivot


@njit(cache=True)
def smallest_singular_value(jacobian: Array) -> float:
    """σ_min, 1, of the `jacobian` 𝒥 (6, n), m and 1, by inverse iteration on 𝒥𝒥ᵀ; 0 where that is not positive definite.

    At this size it costs a tenth of a library's singular value decomposition, which the loop would feel.
    """
    A = np.zeros((6, 6))
    for i in range(6):
        for j in range(6):
            for k in range(jacobian.shape[1]):
                A[i, j] += jacobian[i, k] * jacobian[j, k]
    L = np.zeros((6, 6))
    if cholesky(A, L) <= 0.0:
        return 0.0
    x = np.array([1.0, 0.9, 1.1, 0.8, 1.2, 0.7])
    y = np.empty(6)
    inverse = 0.0
    for _ in range(ITERATIONS):
        size = 0.0
        for i in range(6):
            size += x[i] * x[i]
        size = np.sqrt(size)
        for i in range(6):
            total = x[i] / size
            for k in range(i):
                total -= L[i, k] * y[k]
            y[i] = total / L[i, i]
        # yᵀy = xᵀA⁻¹x: the Rayleigh quotient of the inverse, whose error is the square of the vector's.
        inverse = 0.0
        for i in range(6):
            inverse += y[i] * y[i]
        for i in range(5, -1, -1):
            total = y[i]
            for k in range(i + 1, 6):
                total -= L[k, i] * x[k]
            x[i] = total / L[i, i]
    return float(1.0 / np.sqrt(inverse))


@njit(cache=True)
def null_space_torque(tau0: Array, L: Array, jacobian: Array, lambda_ee: Array) -> Array:
    """τ_nsp = (I − 𝒥ᵀ 𝒥̄ᵀ) τ₀ (n,), N·m: the part of `tau0` (n,), N·m, that does not accelerate the end effector.

    Args:
        tau0: (n,), N·m.
        L: lower Cholesky factor of the joint-space inertia (n, n).
        jacobian: 𝒥 (6, n), m and 1.
        lambda_ee: Λ (6, 6), kg and kg·m².
    """
    n = L.shape[0]
    y = np.empty(n)
    for i in range(n):
        s = tau0[i]
        for k in range(i):
            s -= L[i, k] * y[k]
        y[i] = s / L[i, i]
    for i in range(n - 1, -1, -1):
        s = y[i]
        for k in range(i + 1, n):
            s -= L[k, i] * y[k]
        y[i] = s / L[i, i]
    # 𝒥̄ᵀ τ₀ = Λ 𝒥 M⁻¹ τ₀: the wrench that τ₀ would put on the end effector.
    pushed, tau = np.zeros(6), tau0.copy()
    for i in range(6):
        for k in range(n):
            pushed[i] += jacobian[i, k] * y[k]
    for i in range(6):
        wrench = 0.0
        for k in range(6):
            wrench += lambda_ee[i, k] * pushed[k]
        for k in range(n):
            tau[k] -= jacobian[i, k] * wrench
    return tau
