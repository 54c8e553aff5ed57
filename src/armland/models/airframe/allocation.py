"""Allocation of thrust and torque to any four to eight rotors, upright or tilted, each within its limits; compiled.

| symbol | name | unit |
|---|---|---|
| T | (n,), thrust of each rotor | N |
| w | thrust along body z and torque (3,), body axes; lateral force (2,), wanted zero | N, N·m |
| E | `effect` (6, n): rows of thrust, torque, lateral force | 1, m |
| S | `scale` (6,): weight of each row | 1/N, 1/(N·m) |
| σ | `spread`: weight of each rotor's thrust | 1/N |

Four upright rotors have one solution: `models.uav.allocate`. Others have a null space: rotor thrusts that make neither thrust nor
torque. Inside the limits the least lateral force is taken, then the least sum of squares, by a constant matrix; at the limits

    min ‖S(E T − w)‖² + σ²‖T‖²,  low ≤ T ≤ high    (1)

is solved exactly. The weights stand in the order of priority, each some thirty times the next: roll and pitch,
thrust, yaw, lateral force. So yaw is
dropped first, then thrust, then roll and pitch, each only once the null space is used up. (1) is strictly convex: T is a continuous
function of w.

Source of the formulation: Härkegård, "Efficient active set algorithms for solving constrained least squares problems in aircraft
control allocation", 2002; of the method: Stark, Parker, "Bounded-variable least-squares: an algorithm and applications", 1995.
"""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.models.uav import allocate
from armland.records import MOST_ROTORS, Record, Records
from armland.rotations import Array

ROWS = 6

PRIORITY = np.array([30.0, 1e3, 1e3, 1.0, 0.03, 0.03])
"""Weight of thrust, roll, pitch, yaw and the two lateral forces, each over what all rotors together could make of it."""

SPREAD = 1e-3
"""Weight of each rotor's thrust, likewise: far below all others, so that it chooses among equals only."""

ORDER = np.array([1, 2, 0, 3, 4, 5])
"""Rows with the heaviest first: so Householder's reflections keep the light ones exact."""

TURNS = 60
"""Most changes of the active set. Six to ten are usual with eight rotors."""


def allocation_layout() -> list[Any]:
    """Fields that the allocation is told."""
    return [
        ("rotors", "i8"),  # number of them
        ("exact", "i8"),  # 1 where they are four, upright: then there is one solution
        ("low", "f8"),  # N, of each
        ("high", "f8"),
        ("mixer", "f8", (4, MOST_ROTORS)),  # thrust and torque of each rotor's thrust
        ("mixer_inverse", "f8", (MOST_ROTORS, 4)),
        ("rows", "f8", (ROWS + MOST_ROTORS, MOST_ROTORS)),  # S E, heaviest first, and σ 1
        ("scale", "f8", (ROWS,)),
    ]


def tell_allocation(told: Records, effect: Array, low: float, high: float) -> None:
    """Fill the fields of `allocation_layout` in `told` (1,); `effect` (6, n), of `models.airframe.rotor_set.effect_of`; limits in N."""
    n = effect.shape[1]
    upright = not effect[4:].any() and bool(np.all(effect[0] == 1.0))
    told["rotors"], told["exact"], told["low"], told["high"] = n, n == 4 and upright, low, high
    told["mixer"][0, :, :n] = effect[:4]
    told["mixer_inverse"][0, :n] = inverse_of(effect)
    # What all rotors together could make of each row at their limit.
    most = high * np.maximum(np.abs(effect).sum(axis=1), 1e-9)
    most[1:3] = most[1:3].max()
    most[4:] = most[0]
    told["scale"] = PRIORITY / most
    told["rows"][0, :ROWS, :n] = ((PRIORITY / most)[:, None] * effect)[ORDER]
    told["rows"][0, ROWS : ROWS + n, :n] = SPREAD / high * np.eye(n)


def inverse_of(effect: Array) -> Array:
    """(n, 4): rotor thrusts for thrust and torque, with the least lateral force, then the least sum of squares."""
    wanted, lateral, n = effect[:4], effect[4:], effect.shape[1]
    if n == 4:
        return np.asarray(np.linalg.inv(wanted))
    exact = np.linalg.pinv(wanted)
    free = np.linalg.svd(wanted)[2][4:].T
    return np.asarray(exact - free @ np.linalg.pinv(lateral @ free, rcond=1e-9) @ (lateral @ exact))


@njit(cache=True)
def share_out(thrust: float, torque: Array, p: Record) -> Array:
    """Rotor thrusts (8,) N for a total thrust and a torque (3,) N·m; zero for rotors that there are not.

    Exact where the rotors can give it. What they cannot is dropped in this order: yaw torque, total thrust, roll and pitch torque.
    The result is a continuous function of what was asked.

    Args:
        thrust: along body z, N.
        torque: (3,), N·m, body.
        p: fields of `allocation_layout`.

    Source: (1).
    """
    out, n = np.zeros(MOST_ROTORS), p.rotors
    if p.exact:
        inverse = np.empty((4, 4))
        for i in range(4):
            for j in range(4):
                inverse[i, j] = p.mixer_inverse[i, j]
        four = allocate(thrust, torque, inverse, p.low, p.high)
        for i in range(4):
            out[i] = four[i]
        return out
    inside = True
    for i in range(n):
        out[i] = p.mixer_inverse[i, 0] * thrust
        for j in range(3):
            out[i] += p.mixer_inverse[i, 1 + j] * torque[j]
        inside = inside and p.low <= out[i] <= p.high
    if inside:
        return out
    A, b = np.zeros((ROWS + n, n)), np.zeros(ROWS + n)
    for i in range(ROWS):
        for j in range(n):
            A[i, j] = p.rows[i, j]
    for i in range(n):
        A[ROWS + i, i] = p.rows[ROWS + i, i]
    b[0], b[1], b[2], b[3] = torque[0] * p.scale[1], torque[1] * p.scale[2], thrust * p.scale[0], torque[2] * p.scale[3]
    bounded = least_squares(A, b, p.low, p.high)
    for i in range(n):
        out[i] = bounded[i]
    return out


@njit(cache=True)
def least_squares(A: Array, b: Array, low: float, high: float) -> Array:
    """The x (n,), N, in [low, high] that makes ‖A x − b‖ least.

    From the middle of the bounds, with all unknowns free: a step to the free unknowns' least-squares solution
    ends at the first bound in
    its way, which joins the active set; at the solution the bound with the most wrong multiplier leaves it.

    Args:
        A: (m, n), 1/N, of full column rank.
        b: (m,), 1.
        low: least x, N.
        high: largest x, N.

    Source: Stark, Parker, as above.
    """
    n = A.shape[1]
    x, free = np.full(n, 0.5 * (low + high)), np.ones(n, np.bool_)
    for _ in range(TURNS):
        wanted = _freed(A, b, x, free)
        step, hit = 1.0, -1
        for i in range(n):
            if free[i] and not low <= wanted[i] <= high:
                room = ((low if wanted[i] < low else high) - x[i]) / (wanted[i] - x[i])
                if room < step or hit < 0:
                    step, hit = min(room, step), i
        for i in range(n):
            if free[i]:
                x[i] += step * (wanted[i] - x[i])
        if hit >= 0:
            free[hit], x[hit] = False, low if wanted[hit] < low else high
            continue
        worst, leaves = 0.0, -1
        for i in range(n):
            if not free[i]:
                pull, size = 0.0, 0.0
                for k in range(A.shape[0]):
                    rest = b[k]
                    for j in range(n):
                        rest -= A[k, j] * x[j]
                    pull += A[k, i] * rest
                    size += abs(A[k, i] * b[k])
                inwards = pull if x[i] == low else -pull
                if inwards > 1e-14 * size + worst:
                    worst, leaves = inwards, i
        if leaves < 0:
            return x
        free[leaves] = True
    return x


@njit(cache=True)
def _freed(A: Array, b: Array, x: Array, free: NDArray[np.bool_]) -> Array:
    # The least-squares solution in the free unknowns, the others held at x: by Householder's reflections.
    m, n, count = A.shape[0], A.shape[1], 0
    at, R, rest, out = np.empty(n, np.int64), np.empty((m, n)), b.copy(), x.copy()
    for j in range(n):
        if free[j]:
            at[count] = j
            for k in range(m):
                R[k, count] = A[k, j]
            count += 1
        else:
            for k in range(m):
                rest[k] -= A[k, j] * x[j]
    for c in range(count):
        size = 0.0
        for k in range(c, m):
            size += R[k, c] * R[k, c]
        alpha = -np.sqrt(size) if R[c, c] > 0.0 else np.sqrt(size)
        R[c, c] -= alpha
        norm = 0.0
        for k in range(c, m):
            norm += R[k, c] * R[k, c]
        for d in range(c + 1, count + 1):
            dot = 0.0
            for k in range(c, m):
                dot += R[k, c] * (R[k, d] if d < count else rest[k])
            dot *= 2.0 / norm
            for k in range(c, m):
                if d < count:
                    R[k, d] -= dot * R[k, c]
                else:
                    rest[k] -= dot * R[k, c]
        R[c, c] = alpha
    for c in range(count - 1, -1, -1):
        value = rest[c]
        for d in range(c + 1, count):
            value -= R[c, d] * out[at[d]]
        out[at[c]] = value / R[c, c]
    return out
