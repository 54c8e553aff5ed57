"""The arm's part while it balances a UAV that has lost a rotor, or sets it down where the rails are near; compiled.

| symbol | name | unit |
|---|---|---|
| x, ẋ, u | `kept.sway`, `.sway_v`, `.sway_a` (2,): pivot's displacement from where balancing began, as commanded | m, m/s, m/s² |
| φ, φ̇, φ̈ | `kept.lean`, `.lean_v`, `.lean_a` (3,): rotation vector of the end effector from upright | rad, rad/s, rad/s² |

The pivot moves by (B.3) of `control.laws.balance`. The arm follows that trajectory as it follows any other reference, with
acceleration and load fed forward, so friction in its joints does not disturb the balance. The tool leans in the direction of the
displacement: φ = φ_m tanh(c x/(L φ_m)) about the axis across x, with L from the wrist to the pivot and c = `swing` the wrist's share
of small displacements. So the arm behind the wrist, which may stand between the cradle's rails, moves little, and the speed is divided
among the joints. φ_m = `lean_most` leaves the hinge room for what the UAV leans the other way: at its stop nothing is balanced.
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.control.laws.balance import BalanceGains, capture_angle, falling, lean_of, observed, predicted, push
from armland.records import Record
from armland.rotations import Array

RING = 256
"""Ticks of the pivot's velocity that are remembered, to know what it gained since an attitude was measured."""

SETTLE_MPS = 0.04
"""Mean speed at which a UAV near the rails is set down."""

SEAT_M = 0.0005
"""How far below the rails it is set down: the arm's stiffness then presses it on."""

BALANCED, SETTLED, GIVEN_UP = 0, 1, 2

OBSERVED = 1.0
"""Poles of the observer of what is upright, over −ω₀: slower than those that right the body, faster than those that bring it back."""

OBSERVED_AFTER_S = 0.12
"""When observing begins: what the rotors still give while they run down is no wind."""

UPRIGHT_MOST = 0.15
"""Largest tilt, 1, that counts as upright: 9°, the lean in a wind of 3 m/s."""


@lru_cache
def told_layout() -> np.dtype:
    """What balancing is told."""
    return np.dtype(
        [
            ("gains", "f8", (4,)),  # of the push
            ("fall_rate", "f8"),  # rad/s
            ("push_max", "f8"),  # m/s²
            ("sway_max", "f8"),  # m
            ("swing", "f8"),  # share of the pivot's displacement that the wrist makes
            ("wrist", "f8"),  # m, from the wrist to the pivot
            ("lean_most", "f8"),  # rad, of the tool
            ("attitude_age", "i8"),  # ticks, of an attitude that can be balanced by
            ("down", "f8"),  # m, height of the pivot when the UAV stands on the cradle
            ("lost", "f8"),  # rad, capture point beyond which it cannot be balanced
            ("settle", "f8"),  # m, height above it below which a UAV is set down and not balanced
            ("gravity", "f8"),  # m/s²
        ]
    )


@lru_cache
def kept_layout() -> np.dtype:
    """What balancing keeps from tick to tick."""
    return np.dtype(
        [
            ("state", "i8"),  # BALANCED, SETTLED or GIVEN_UP
            ("sway", "f8", (2,)),  # m [D]
            ("sway_v", "f8", (2,)),  # m/s
            ("sway_a", "f8", (2,)),  # m/s²
            ("sway_log", "f8", (RING, 2)),  # m/s, the pivot's velocity
            ("upright", "f8", (2,)),  # 1, tilt at which it would stand
            ("carried", "f8", (2,)),  # 1/s, what the observer of that carries on
            ("sampled", "i8"),  # tick of the attitude that was observed last
            ("lean", "f8", (3,)),  # rad [D]
            ("lean_v", "f8", (3,)),  # rad/s
            ("lean_a", "f8", (3,)),  # rad/s²
        ]
    )


@njit(cache=True)
def begin_balance(e: Record, hovered: Array, p: Record, s: Record) -> None:
    """Anchor the pivot where it is, with the speed it has; decide whether the rails are near enough to be set down on.

    Args:
        e: estimate.
        hovered: acceleration (2,), m/s², D, that held the UAV against the wind while it hovered.
        p: `told_layout`.
        s: `kept_layout`, written.
    """
    s.state = SETTLED if e.r[2] - p.down < p.settle else BALANCED
    s.sampled = -1
    for i in range(2):
        s.upright[i] = min(max(hovered[i] / p.gravity, -UPRIGHT_MOST), UPRIGHT_MOST)
        s.sway[i], s.sway_v[i], s.sway_a[i] = 0.0, e.v[i], 0.0
        for k in range(RING):
            s.sway_log[k, i] = e.v[i]
    for i in range(3):
        s.lean[i] = s.lean_v[i] = s.lean_a[i] = 0.0


@njit(cache=True)
def refer_balance(elapsed: float, age: int, e: Record, told: Record, kept: Record, r: Record) -> None:
    """Fill the reference of one tick of balancing, whose height `moves` has filled.

    Args:
        elapsed: time since it began, s.
        age: of the attitude, ticks; beyond `attitude_age` the pivot is brought to rest.
        e: estimate.
        told: what the reference is told.
        kept: what it keeps, written.
        r: reference, written.
    """
    p, s = told.balance, kept.balance
    x, y, x_rate, y_rate = lean_of(e.quat, e.omega)
    if s.state == BALANCED and capture_angle(e.quat, e.omega, p.fall_rate, s.upright) > p.lost:
        # It falls, whatever the arm does: less is broken if that rests.
        s.state = GIVEN_UP
    if s.state == SETTLED:
        _settle(elapsed, p.down, told.coast, kept, r)
    since = e.tick - age - s.sampled
    for i in range(2):
        tilt, tilt_rate = (x, x_rate) if i == 0 else (y, y_rate)
        s.sway_log[e.tick % RING, i] = s.sway_v[i]
        if elapsed > OBSERVED_AFTER_S and age <= p.attitude_age and since > 0:
            _observe(i, tilt - tilt_rate * age * told.tick_s, tilt_rate, since, age, e.tick, told, s)
        _sway(i, tilt - s.upright[i], tilt_rate, age, e.tick, told, s)
        r.r[i], r.v[i], r.a[i] = kept.r0[i] + s.sway[i], s.sway_v[i], s.sway_a[i]
        _lean(i, p, s)
    if elapsed > OBSERVED_AFTER_S:
        s.sampled = max(s.sampled, e.tick - age)
    for i in range(2):
        # On a circle about the wrist the pivot sinks.
        r.r[2] -= 0.5 * p.wrist * s.lean[i] ** 2
        r.v[2] -= p.wrist * s.lean[i] * s.lean_v[i]
        r.a[2] -= p.wrist * (s.lean_v[i] ** 2 + s.lean[i] * s.lean_a[i])


@njit(cache=True)
def _observe(i: int, tilt: float, tilt_rate: float, since: int, age: int, tick: int, told: Record, s: Record) -> None:
    # What is upright along axis i, by an attitude as it was sampled `age` ticks ago, `since` ticks after the one before.
    p = told.balance
    w = falling(tilt_rate, s.sway_log[(tick - age) % RING, i], p.fall_rate, p.gravity)
    if s.sampled < 0:
        s.carried[i] = w
        return
    pole, step = OBSERVED * p.fall_rate, since * told.tick_s
    found, s.carried[i] = observed(s.upright[i], s.carried[i], tilt, w, step, p.fall_rate, pole)
    s.upright[i] = min(max(found, -UPRIGHT_MOST), UPRIGHT_MOST)


@njit(cache=True)
def _sway(i: int, tilt: float, tilt_rate: float, age: int, tick: int, told: Record, s: Record) -> None:
    # One tick of the pivot along axis i.
    p, now = told.balance, tick % RING
    if s.state != BALANCED or age > p.attitude_age:
        s.sway_a[i] = min(max(-s.sway_v[i] / told.coast, -p.push_max), p.push_max)
    else:
        gains = BalanceGains(p.gains[0], p.gains[1], p.gains[2], p.gains[3])
        gained = s.sway_v[i] - s.sway_log[(now - age) % RING, i]
        tilt, tilt_rate = predicted(tilt, tilt_rate, gained, age * told.tick_s, p.fall_rate)
        s.sway_a[i] = push(tilt, tilt_rate, s.sway[i], s.sway_v[i], gains, p.push_max, p.sway_max)
    s.sway[i] += (s.sway_v[i] + 0.5 * s.sway_a[i] * told.tick_s) * told.tick_s
    s.sway_v[i] += s.sway_a[i] * told.tick_s


@njit(cache=True)
def _settle(elapsed: float, down: float, coast: float, kept: Record, r: Record) -> None:
    apart = down - SEAT_M - kept.r0[2] - kept.v0[2] * coast
    u = min(elapsed * SETTLE_MPS / max(abs(apart), 1e-4), 1.0)
    # A smooth step: at rest at both ends.
    r.r[2] += u * u * (3.0 - 2.0 * u) * apart
    r.v[2] += 6.0 * u * (1.0 - u) * np.sign(apart) * SETTLE_MPS


@njit(cache=True)
def _lean(i: int, p: Record, s: Record) -> None:
    # Towards x the tool turns about +y, towards y about −x.
    axis, slope = (1, p.swing / p.wrist) if i == 0 else (0, -p.swing / p.wrist)
    t = np.tanh(slope * s.sway[i] / p.lean_most)
    steep = slope * (1.0 - t * t)
    s.lean[axis], s.lean_v[axis] = p.lean_most * t, steep * s.sway_v[i]
    s.lean_a[axis] = steep * (s.sway_a[i] - 2.0 * t * slope / p.lean_most * s.sway_v[i] ** 2)
