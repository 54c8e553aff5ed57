"""A rope with mass that takes tension alone: points of mass between springs that can go slack; compiled.

| symbol | name | unit, frame |
|---|---|---|
| x_i, v_i | `place`, `speed` (n, 3): inner points | m, m/s, W |
| L, λ | length that is paid out, mass per metre | m, kg/m |
| k, c | stiffness EA/l and damping of a piece of rest length l = L/(n + 1), k at most `MOST_NPM` | N/m, N·s/m |
| T_i = max(k (d_i − l) + c ḋ_i, 0) where d_i > l, else 0 | tension of a piece of length d_i (T.1) | N |

A point has λ l, at least `LEAST_KG`. Symplectic Euler in `SUBSTEPS` of a tick: with the bounds its fastest swing, 2 √(k/m), stays below
half of what that bears. So a rope shorter than 0.2 m is softer and heavier than it is. Bending and the air's drag are left out.
"""

import numpy as np
from numba import njit

from armland.rotations import Array

POINTS = 8
SUBSTEPS = 25
MOST_NPM, LEAST_KG = 1.5e4, 3e-4

DAMPING_SHARE = 0.3
"""c over the critical damping of a point between two pieces."""


@njit(cache=True)
def pull_of(a: Array, va: Array, b: Array, vb: Array, rest: float, k: float, c: float) -> tuple[float, float, float]:
    """Force (3), N, W, on one end of a piece.

    Args:
        a: that end (3,), m, W.
        va: its velocity (3,), m/s, W.
        b: the other end (3,), m, W.
        vb: its velocity (3,), m/s, W.
        rest: length of the slack piece, m.
        k: N/m.
        c: N·s/m.
    """
    d0, d1, d2 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    d = np.sqrt(d0 * d0 + d1 * d1 + d2 * d2)
    if d <= rest or d < 1e-9:
        return 0.0, 0.0, 0.0
    rate = ((vb[0] - va[0]) * d0 + (vb[1] - va[1]) * d1 + (vb[2] - va[2]) * d2) / d
    tension = max(k * (d - rest) + c * rate, 0.0)  # (T.1)
    return tension * d0 / d, tension * d1 / d, tension * d2 / d


@njit(cache=True)
def carry_rope(
    place: Array, speed: Array, ends: Array, ends_v: Array, rope: Array, gravity: Array, tick_s: float
) -> tuple[Array, float]:
    """One tick of the rope; returns the force (3,), N, W, on its upper end, and the tension at its lower end, N, means over the tick.

    Args:
        place: x (n, 3), m, W, updated.
        speed: v (n, 3), m/s, W, updated.
        ends: lower and upper end (2, 3), m, W.
        ends_v: their velocities (2, 3), m/s, W.
        rope: L, m; λ, kg/m; EA, N.
        gravity: (3,), m/s², W.
        tick_s: s.
    """
    n, h = place.shape[0], tick_s / SUBSTEPS
    rest = rope[0] / (n + 1)
    mass, k = max(rope[1] * rest, LEAST_KG), min(rope[2] / rest, MOST_NPM)
    c = DAMPING_SHARE * 2.0 * np.sqrt(2.0 * k * mass)
    force, total, low = np.empty((n, 3)), np.zeros(3), 0.0
    for _ in range(SUBSTEPS):
        for i in range(n):
            for j in range(3):
                force[i, j] = mass * gravity[j]
        for i in range(n + 1):
            a, va = (ends[0], ends_v[0]) if i == 0 else (place[i - 1], speed[i - 1])
            b, vb = (ends[1], ends_v[1]) if i == n else (place[i], speed[i])
            f = pull_of(a, va, b, vb, rest, k, c)
            for j in range(3):
                if i > 0:
                    force[i - 1, j] += f[j]
                if i < n:
                    force[i, j] -= f[j]
            if i == 0:
                low += np.sqrt(f[0] ** 2 + f[1] ** 2 + f[2] ** 2) / SUBSTEPS
            if i == n:
                for j in range(3):
                    total[j] -= f[j] / SUBSTEPS
        for i in range(n):
            for j in range(3):
                speed[i, j] += h * force[i, j] / mass
                place[i, j] += h * speed[i, j]
    return total, low
