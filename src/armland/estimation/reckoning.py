"""Motion of the UAV between camera samples: attitude and model acceleration of each tick, reckoned from what the UAV reports; compiled.

| symbol | name | unit, frame |
|---|---|---|
| q_imu, ω | attitude and rates that the UAV reports | 1, rad/s, body |
| δ | q_wb = δ ⊗ q_imu, by `alignment` | 1 |
| f_T, m, g | `thrust`, `mass`, `gravity` | N, kg, m/s² |
| a | acceleration of the centre of mass by the thrust model | m/s², world |

a = (f_T/m) R_wb e₃ − g e₃ (P.1), plus `memory.push`. An attitude is written back to the tick at which the UAV took it, and carried on
with its rates from there to the present; where it is older than `hold` it is held, and the acceleration counts as guessed. Without a
thrust model (`driven` = 0) a = 0, and the acceleration bias of `late_fusion` is the whole acceleration.

Assumption: an attitude that arrives after a camera sample of a later tick has been fused improves only what comes after
that sample.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.estimation.late_fusion import RING, Noise, carry, insert, reckon
from armland.records import Record
from armland.rotations import Array, from_rotation_vector, matrix, multiply


@njit(cache=True)
def advance(
    tick: int,
    imu_tick: int,
    imu_quat: Array,
    imu_rate: Array,
    thrust: float,
    camera_position: Array,
    camera_quat: Array,
    p_: NDArray[np.void],
    s_: NDArray[np.void],
) -> None:
    """One tick, to be called at every tick, before `armland.estimation.pose_filter.fuse`.

    Args:
        tick: present tick.
        imu_tick: tick at which the UAV took the newest attitude that has arrived.
        imu_quat: that attitude (4,), scalar first.
        imu_rate: angular velocity (3,), rad/s, body, of the same tick.
        thrust: total thrust that acts now as far as is known, N.
        camera_position: optical centre (3,), m, world, from the arm's joints.
        camera_quat: (4,), world<-camera, from the arm's joints.
        p_: `armland.estimation.plate.PARAMETERS` (1,).
        s_: `armland.estimation.plate.MEMORY` (1,), zeros at first, updated.
    """
    p, s = p_[0], s_[0]
    row, fresh = tick % RING, imu_tick != s.imu_tick
    if not s.track.begun:
        s.first_tick, s.align.quat[0], fresh = tick, 1.0, True
    s.thrust[row] = thrust
    for i in range(4):
        s.camera_quat[row, i] = camera_quat[i]
    for i in range(3):
        s.camera_position[row, i] = camera_position[i]
        if fresh:
            s.rate[i] = imu_rate[i]
    if fresh:
        s.imu_tick = imu_tick
        start = min(max(imu_tick, s.first_tick, tick - RING // 2), tick)
        late = p.tick_s * min(start - imu_tick, p.hold)
        _reckon_from(start, tick, multiply(imu_quat, from_rotation_vector(s.rate * late)), p, s)
    else:
        _reckon_from(tick, tick, _carried(tick, p, s), p, s)
    if s.track.marks > 0 and tick - s.track.mark[s.track.marks - 1].tick >= RING - 2:
        # The newest mark is about to leave the ring: the state as it is predicted becomes a mark of its own.
        x, P = present(p, s)
        insert(s.track, s.track.marks, tick, x, P, np.zeros(3), np.eye(3), False)


@njit(cache=True)
def _carried(tick: int, p: Record, s: Record) -> Array:
    # q_imu of `tick` from the one before; held where the rates are too old to say how it goes on.
    before = s.quat[(tick - 1) % RING]
    if tick - s.imu_tick > p.hold:
        return before.copy()
    return multiply(before, from_rotation_vector(s.rate * p.tick_s))


@njit(cache=True)
def _reckon_from(start: int, tick: int, q: Array, p: Record, s: Record) -> None:
    # Attitude and model acceleration from `start`, where the attitude is q, up to `tick`.
    R_align = matrix(s.align.quat)
    for k in range(start, tick + 1):
        if k > start:
            q = _carried(k, p, s)
        for i in range(4):
            s.quat[k % RING, i] = q[i]
        guessed = p.driven == 1 and k - s.imu_tick > p.hold
        a = _model_acceleration(q, R_align, s.thrust[k % RING], p) + s.push[k % RING]
        reckon(s.track, k, a, guessed, p.tick_s)


@njit(cache=True)
def _model_acceleration(q: Array, R_align: Array, thrust: float, p: Record) -> Array:
    a = np.zeros(3)
    if p.driven:
        lift = thrust / p.mass
        x = lift * 2.0 * (q[1] * q[3] + q[0] * q[2])
        y = lift * 2.0 * (q[2] * q[3] - q[0] * q[1])
        z = lift * (1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]))
        for i in range(3):
            a[i] = R_align[i, 0] * x + R_align[i, 1] * y + R_align[i, 2] * z
        a[2] -= p.gravity  # (P.1)
    return a


@njit(cache=True)
def present(p: Record, s: Record) -> tuple[Array, Array]:
    """State (9,) and covariance (9, 9) of the centre of mass at the newest tick; there must have been a sample."""
    noise = Noise(p.white, p.blind, p.walk)
    return carry(s.track, s.track.mark[s.track.marks - 1], s.track.tick, noise, p.tick_s)
