"""Kalman filter of a point's motion that fuses late position samples at their own capture time, compiled.

| symbol | name | unit, frame |
|---|---|---|
| x = (p, v, b) | `x` (9,): position, velocity, acceleration bias | m, m/s, m/s², D |
| P | `P` (9, 9) | |
| a | `acceleration` (3,), what a model says; v̇ = a + b + w_a, ḃ = w_b | m/s², D |
| V, S | `velocity`, `displacement` (3,): v and p that a alone makes from rest | m/s, m |
| w_a, w_b | `Noise.white`, `Noise.walk`: square roots of the densities | m/s²/√Hz, m/s³/√Hz |

The motion is linear and a enters additively, so that no tick between c and t need be replayed to carry a state from c to t: with τ
the time from c to t it is p_t = p_c + v_c τ + ½ b_c τ² + S_t − S_c − V_c τ, v_t = v_c + b_c τ + V_t − V_c, b_t = b_c, and
P_t = A(τ) P_c A(τ)ᵀ + Q(τ), with A and Q in closed form (F.1). A ring keeps V and S at each tick. Marks keep the state after
each of the last fused samples together with that sample: a late sample is fused at its capture tick, and only the marks
after it, if there are any, are computed anew. The result is that of a filter to which every sample came at once.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.models.operational import cholesky
from armland.records import Record
from armland.rotations import Array

RING = 1024
"""Ticks that the ring remembers."""

MARKS = 8
"""Fused samples that are kept for samples that come out of order."""

MARK = np.dtype(
    [
        ("tick", "i8"),
        ("measured", "i8"),  # 0 for a mark that only carries the state on
        ("x", "f8", (9,)),
        ("P", "f8", (9, 9)),
        ("z", "f8", (3,)),
        ("R", "f8", (3, 3)),
    ]
)

TRACK = np.dtype(
    [
        ("begun", "i8"),
        ("tick", "i8"),  # newest tick of the ring
        ("acceleration", "f8", (RING, 3)),  # from this tick to the next
        ("velocity", "f8", (RING, 3)),
        ("displacement", "f8", (RING, 3)),
        ("blind", "i8", (RING,)),  # ticks so far whose acceleration was a guess
        ("marks", "i8"),
        ("mark", MARK, (MARKS,)),  # by rising tick
    ]
)


class Noise(NamedTuple):
    """What drives the motion besides the modelled acceleration."""

    white: float
    """w_a, m/s²/√Hz."""
    blind: float
    """w_a across ticks whose acceleration was a guess, m/s²/√Hz."""
    walk: float
    """w_b, m/s³/√Hz."""


@njit(cache=True)
def reckon(s: Record, tick: int, acceleration: Array, guessed: bool, tick_s: float) -> None:
    """Set the acceleration that acts from a tick on, and V and S at that tick.

    Args:
        s: `TRACK`, updated.
        tick: may lie behind the newest one.
        acceleration: (3,), m/s², D.
        guessed: whether it is a guess.
        tick_s: s.
    """
    row = tick % RING
    before = (tick - 1) % RING
    for i in range(3):
        if s.begun:
            a, v = s.acceleration[before, i], s.velocity[before, i]
            s.velocity[row, i] = v + a * tick_s
            s.displacement[row, i] = s.displacement[before, i] + (v + 0.5 * a * tick_s) * tick_s
        s.acceleration[row, i] = acceleration[i]
    s.blind[row] = (s.blind[before] if s.begun else 0) + (1 if guessed else 0)
    s.begun = 1
    s.tick = max(s.tick, tick)


@njit(cache=True)
def spread(P: Array, tau: float, white: float, walk: float) -> None:
    """P ← A(τ) P A(τ)ᵀ + Q(τ).

    Args:
        P: covariance (9, 9) of p, v, b, m, m/s, m/s², spread in place.
        tau: τ, s.
        white: m/s²/√Hz, as in `Noise`; m/s.
        walk: m/s³/√Hz, likewise; m/s.

    Source: (F.1).
    """
    half = 0.5 * tau * tau
    for i in range(3):
        for k in range(9):
            P[i, k] += tau * P[3 + i, k] + half * P[6 + i, k]
            P[3 + i, k] += tau * P[6 + i, k]
    for i in range(3):
        for k in range(9):
            P[k, i] += tau * P[k, 3 + i] + half * P[k, 6 + i]
            P[k, 3 + i] += tau * P[k, 6 + i]
    a, b = white * white * tau, walk * walk * tau
    t2, t3, t4 = tau * tau, tau**3, tau**4
    for i in range(3):
        P[i, i] += a * t2 / 3.0 + b * t4 / 20.0
        P[3 + i, 3 + i] += a + b * t2 / 3.0
        P[6 + i, 6 + i] += b
        pv, pb, vb = 0.5 * a * tau + b * t3 / 8.0, b * t2 / 6.0, 0.5 * b * tau
        P[i, 3 + i] += pv
        P[3 + i, i] += pv
        P[i, 6 + i] += pb
        P[6 + i, i] += pb
        P[3 + i, 6 + i] += vb
        P[6 + i, 3 + i] += vb


@njit(cache=True)
def carry(s: Record, mark: Record, tick: int, noise: Noise, tick_s: float) -> tuple[Array, Array]:
    """State (9,) and covariance (9, 9) at `tick`, from `mark`; both ticks in the ring. Source: (F.1)."""
    x, P = mark.x.copy(), mark.P.copy()
    c, t = mark.tick % RING, tick % RING
    tau = (tick - mark.tick) * tick_s
    for i in range(3):
        velocity = s.velocity[c, i]
        x[i] += (x[3 + i] - velocity) * tau + 0.5 * x[6 + i] * tau * tau + s.displacement[t, i] - s.displacement[c, i]
        x[3 + i] += x[6 + i] * tau + s.velocity[t, i] - velocity
    # The guess of a tick acts after it: the last one has not acted yet.
    blind = s.blind[(tick - 1) % RING] > s.blind[(mark.tick - 1) % RING] if tick > mark.tick else False
    spread(P, tau, noise.blind if blind else noise.white, noise.walk)
    return x, P


@njit(cache=True)
def distance_of(y: Array, P: Array, R: Array) -> float:
    """Squared Mahalanobis distance of an innovation, χ² with 3 degrees of freedom.

    Args:
        y: innovation (3,), m.
        P: covariance (9, 9) of the state that it belongs to.
        R: covariance (3, 3) of the sample, m².
    """
    S, L, out, u = np.empty((3, 3)), np.zeros((3, 3)), 0.0, np.empty(3)
    for i in range(3):
        for j in range(3):
            S[i, j] = P[i, j] + R[i, j]
    cholesky(S, L)
    for i in range(3):
        u[i] = y[i]
        for j in range(i):
            u[i] -= L[i, j] * u[j]
        u[i] /= L[i, i]
        out += u[i] ** 2
    return out


@njit(cache=True)
def correct(x: Array, P: Array, z: Array, R: Array, gate: float) -> float:
    """Fuse what is seen of the first three elements of a state, unless its squared distance exceeds `gate`.

    Args:
        x: (n,), its first three elements m or rad, corrected in place.
        P: its covariance (n, n), corrected in place.
        z: seen (3,), in their unit.
        R: its covariance (3, 3), in its square.
        gate: largest squared Mahalanobis distance of the innovation that is believed, 1.

    Returns:
        That distance, χ² with 3 degrees of freedom.
    """
    n = x.shape[0]
    S, L, Y = np.empty((3, 3)), np.zeros((3, 3)), np.empty((3, n + 1))
    for i in range(3):
        for j in range(3):
            S[i, j] = P[i, j] + R[i, j]
    cholesky(S, L)
    # Columns: L⁻¹ of the covariance's first rows and, last, of the innovation.
    distance = 0.0
    for i in range(3):
        for k in range(n + 1):
            value = P[i, k] if k < n else z[i] - x[i]
            for j in range(i):
                value -= L[i, j] * Y[j, k]
            Y[i, k] = value / L[i, i]
        distance += Y[i, n] * Y[i, n]
    if distance <= gate:
        for i in range(n):
            for j in range(3):
                x[i] += Y[j, i] * Y[j, n]
                for k in range(n):
                    P[i, k] -= Y[j, i] * Y[j, k]
    return distance


@njit(cache=True)
def place(s: Record, tick: int) -> int:
    """Number of marks at or before `tick`: where a mark of that tick belongs."""
    at = s.marks
    while at > 0 and s.mark[at - 1].tick > tick:
        at -= 1
    return at


@njit(cache=True)
def insert(s: Record, at: int, tick: int, x: Array, P: Array, z: Array, R: Array, measured: bool) -> int:
    """Put a mark at place `at`, dropping the oldest where there is no more room; returns the place it got.

    Args:
        s: `TRACK`, updated.
        at: of `place`.
        tick: of the mark.
        x: state (9,), m, m/s, m/s², D.
        P: its covariance (9, 9).
        z: sample that was fused (3,), m, D.
        R: its covariance (3, 3), m².
        measured: whether there was one.
    """
    if s.marks == MARKS:
        for k in range(at - 1):
            _copy(s.mark[k + 1], s.mark[k])
        at -= 1
    else:
        for k in range(s.marks, at, -1):
            _copy(s.mark[k - 1], s.mark[k])
        s.marks += 1
    mark = s.mark[at]
    mark.tick, mark.measured = tick, 1 if measured else 0
    _set_state(mark, x, P)
    for i in range(3):
        mark.z[i] = z[i]
        for k in range(3):
            mark.R[i, k] = R[i, k]
    return at


@njit(cache=True)
def replay(s: Record, at: int, noise: Noise, tick_s: float) -> None:
    """Compute the marks of `s`, `TRACK`, after place `at` anew; `tick_s` in s."""
    for k in range(at + 1, s.marks):
        mark = s.mark[k]
        x, P = carry(s, s.mark[k - 1], mark.tick, noise, tick_s)
        if mark.measured:
            correct(x, P, mark.z, mark.R, np.inf)
        _set_state(mark, x, P)


@njit(cache=True)
def _set_state(mark: Record, x: Array, P: Array) -> None:
    for i in range(9):
        mark.x[i] = x[i]
        for k in range(9):
            mark.P[i, k] = P[i, k]


@njit(cache=True)
def _copy(source: Record, target: Record) -> None:
    target.tick, target.measured = source.tick, source.measured
    _set_state(target, source.x, source.P)
    for i in range(3):
        target.z[i] = source.z[i]
        for k in range(3):
            target.R[i, k] = source.R[i, k]
