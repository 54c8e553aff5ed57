"""The arm's part while it balances a UAV that has lost a rotor, or sets it down where the rails are near; compiled.

| symbol | name | unit |
|---|---|---|
| x, ẋ, u | `memory.sway`, `.sway_v`, `.sway_a` (2,): pivot's way from where balancing began, as commanded | m, m/s, m/s² |
| φ, φ̇, φ̈ | `memory.lean`, `.lean_v`, `.lean_a` (3,): rotation vector of the end effector from upright | rad, rad/s, rad/s² |

The pivot moves by (B.3) of `control.balance`, and the arm follows the way that this makes as it follows any other reference,
with acceleration and load fed forward: friction in its joints then does not come into the balance. The tool leans towards
where the pivot goes, φ = c x/L across x, L from the wrist to the pivot, c = `swing` the wrist's share of the way: the arm
behind the wrist, which may stand between the cradle's rails, moves by little, and no joint has to be fast for all.
"""

import numpy as np
from numba import njit

from armland.control.balance import BalanceGains, capture_angle, lean_of, predicted, push
from armland.mission.landing_state import RING
from armland.records import Record
from armland.rotations import Array, from_rotation_vector, matrix, rotation_error

SETTLE_MPS = 0.04
"""Mean speed at which a UAV near the rails is set down."""


SEAT_M = 0.0005
"""How far below the rails it is set down: the arm's stiffness then presses it on."""

BALANCED, SETTLED, GIVEN_UP = 0, 1, 2


@njit(cache=True)
def begin_balance(e: Record, p: Record, s: Record) -> None:
    """Anchor the pivot where it is, with the speed it has; decide whether the rails are near enough to be set down on."""
    s.balancing = SETTLED if e.r[2] - p.down < p.settle else BALANCED
    for i in range(2):
        s.sway[i], s.sway_v[i], s.sway_a[i] = 0.0, e.v[i], 0.0
        s.sway_log[:, i] = e.v[i]
    for i in range(3):
        s.lean[i] = s.lean_v[i] = s.lean_a[i] = 0.0


@njit(cache=True)
def refer_balance(elapsed: float, age: int, e: Record, p: Record, s: Record, r: Record) -> None:
    """Fill the reference of one tick of balancing.

    Args:
        elapsed: time since it began, s.
        age: of the attitude, ticks; beyond `attitude_age` the pivot is brought to rest.
        e: estimate.
        p: parameters.
        s: memory.
        r: reference, written.
    """
    fade = np.exp(-elapsed / p.coast)
    r.r[2] = s.r0[2] + s.v0[2] * p.coast * (1.0 - fade)
    r.v[2], r.a[2] = s.v0[2] * fade, -s.v0[2] / p.coast * fade
    if s.balancing == BALANCED and capture_angle(e.quat, e.omega, p.fall_rate) > p.lost:
        # It falls, whatever the arm does: less is broken if that rests.
        s.balancing = GIVEN_UP
    if s.balancing == SETTLED:
        _settle(elapsed, p, s, r)
    x, y, x_rate, y_rate = lean_of(e.quat, e.omega)
    now = e.tick % RING
    gains = BalanceGains(p.balance[0], p.balance[1], p.balance[2], p.balance[3])
    for i in range(2):
        tilt, tilt_rate = (x, x_rate) if i == 0 else (y, y_rate)
        s.sway_log[now, i] = s.sway_v[i]
        if s.balancing != BALANCED or age > p.attitude_age:
            s.sway_a[i] = min(max(-s.sway_v[i] / p.coast, -p.push_max), p.push_max)
        else:
            gained = s.sway_v[i] - s.sway_log[(now - age) % RING, i]
            tilt, tilt_rate = predicted(tilt, tilt_rate, gained, age * p.tick_s, p.fall_rate)
            s.sway_a[i] = push(tilt, tilt_rate, s.sway[i], s.sway_v[i], gains, p.push_max, p.sway_max)
        s.sway[i] += (s.sway_v[i] + 0.5 * s.sway_a[i] * p.tick_s) * p.tick_s
        s.sway_v[i] += s.sway_a[i] * p.tick_s
        r.r[i], r.v[i], r.a[i] = s.r0[i] + s.sway[i], s.sway_v[i], s.sway_a[i]
        _lean(i, p, s)
    for i in range(2):
        # On a circle about the wrist the pivot sinks.
        r.r[2] -= 0.5 * p.wrist * s.lean[i] ** 2
        r.v[2] -= p.wrist * s.lean[i] * s.lean_v[i]
        r.a[2] -= p.wrist * (s.lean_v[i] ** 2 + s.lean[i] * s.lean_a[i])


@njit(cache=True)
def _settle(elapsed: float, p: Record, s: Record, r: Record) -> None:
    way = p.down - SEAT_M - s.r0[2] - s.v0[2] * p.coast
    u = min(elapsed * SETTLE_MPS / max(abs(way), 1e-4), 1.0)
    # A smooth step: at rest at both ends.
    r.r[2] += u * u * (3.0 - 2.0 * u) * way
    r.v[2] += 6.0 * u * (1.0 - u) * np.sign(way) * SETTLE_MPS


@njit(cache=True)
def _lean(i: int, p: Record, s: Record) -> None:
    # Towards x the tool turns about +y, towards y about −x.
    axis, slope = (1, p.swing / p.wrist) if i == 0 else (0, -p.swing / p.wrist)
    s.lean[axis], s.lean_v[axis], s.lean_a[axis] = slope * s.sway[i], slope * s.sway_v[i], slope * s.sway_a[i]


@njit(cache=True)
def lean_acceleration(omega: Array, rotation: Array, p: Record, s: Record) -> Array:
    """Angular acceleration (3,), rad/s², world, that leads the end effector along φ; `omega` (3,), `rotation` (3, 3) are its own."""
    R_d = matrix(from_rotation_vector(s.lean)) @ p.R_d
    away = rotation_error(rotation, R_d)
    out = np.empty(3)
    for i in range(3):
        out[i] = s.lean_a[i] + p.k_free * away[i] + p.d_free * (s.lean_v[i] - omega[i])
    return out


@njit(cache=True)
def load_force(e: Record, p: Record, s: Record, c: Record) -> None:
    """Fill `command.force`: what the UAV takes to be held up and swung, rotors at rest: m (u + l θ̈) and its weight left."""
    x, y, _, _ = lean_of(e.quat, e.omega)
    lever, w2 = -p.lever[2], p.fall_rate**2
    for i in range(2):
        tilt = x if i == 0 else y
        c.force[i] = p.body_mass * (s.sway_a[i] + lever * w2 * (tilt - s.sway_a[i] / 9.81))  # (B.1)
    c.force[2] = max(p.weight - e.thrust, 0.0)
