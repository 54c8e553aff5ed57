"""Motion of the UAV between camera samples: attitude and model acceleration of each tick, reckoned from what the UAV reports; compiled.

| symbol | name | unit, frame |
|---|---|---|
| q_imu, ω | attitude and rates that the UAV reports | 1, rad/s, body |
| δ | q_wb = δ ⊗ q_imu, by `alignment` | 1 |
| f, m | `lift` along the body's z: rotors and, where it is held, the hinge; `mass` | N, kg |
| γ, d | `gravity`; `push`, what else is known | m/s², D |
| f_B | specific force that the UAV's accelerometers felt at its newest sample, where they are asked | m/s², body |
| u | `gust`: what of it the model does not explain | m/s², body |
| a | acceleration of the centre of mass by this model | m/s², D |

a = (f/m) R_wb e₃ + γ + d + R_wb u (P.1), u = f_B − (f/m) e₃ − R_bw d of that sample, each component within `gust_max`: wind and
what rotors really give are known as late as the sample and not as late as images make them out.

An attitude is written back to the tick at which the UAV took it, and carried on
with its rates from there to the present; where it is older than `hold` it is held, and the acceleration counts as guessed.

Assumption: an attitude that arrives after a camera sample of a later tick has been fused improves only what comes after
that sample.
"""

import numpy as np
from numba import njit

from armland.estimation.plate.late_fusion import RING, Noise, carry, insert, reckon
from armland.records import Record
from armland.rotations import Array, from_rotation_vector, matrix, multiply, turned


@njit(cache=True)
def advance(
    m: Record,
    lift: float,
    push: Array,
    gravity: tuple[float, float, float],
    eye: Array,
    view: Array,
    p: Record,
    s: Record,
) -> None:
    """One tick, to be called at every tick, before `pose_filter.fuse`.

    Args:
        m: measurement, of which the tick and the UAV's newest attitude and rates are read, and the tick at which it took them.
        lift: force along the body's z that acts now as far as is known, N.
        push: (3,), m/s², D: what else is known to accelerate it.
        gravity: γ (3,), m/s², D.
        eye: optical centre (3,), m, D, from the arm's joints.
        view: quaternion (4,), D<-camera, from the arm's joints.
        p: of `layouts.told_layout`.
        s: of `layouts.kept_layout`, zeros at first, updated.
    """
    tick, imu_tick = m.tick, m.uav_tick
    row, fresh = tick % RING, imu_tick != s.imu_tick
    if not s.track.begun:
        s.first_tick, s.align.quat[0], fresh = tick, 1.0, True
    s.lift[row] = lift
    for i in range(4):
        s.camera_quat[row, i] = view[i]
    for i in range(3):
        s.camera_position[row, i] = eye[i]
        s.push[row, i] = push[i] + gravity[i]
        if fresh:
            s.rate[i] = m.uav_rate[i]
    if fresh:
        s.imu_tick = imu_tick
        start = min(max(imu_tick, s.first_tick, tick - RING // 2), tick)
        late = p.tick_s * min(start - imu_tick, p.hold)
        if p.gust_max > 0.0:
            _feel(m, s.push[start % RING], s.lift[start % RING] / p.mass, gravity, p, s)
        _reckon_from(start, tick, multiply(m.uav_quat, from_rotation_vector(s.rate * late)), p, s)
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
        a = _model_acceleration(q, R_align, s.lift[k % RING] / p.mass, s.push[k % RING])
        if p.gust_max > 0.0:
            gust = turned(R_align, turned(matrix(q), s.gust))
            for i in range(3):
                s.felt[i] = gust[i]
                a[i] += gust[i]
        reckon(s.track, k, a, k - s.imu_tick > p.hold, p.tick_s)


@njit(cache=True)
def _feel(m: Record, push: Array, lift: float, gravity: tuple[float, float, float], p: Record, s: Record) -> None:
    # u of the newest sample; of a UAV that sends no specific force, none.
    if m.uav_force[0] == 0.0 and m.uav_force[1] == 0.0 and m.uav_force[2] == 0.0:
        return
    R, R_align = matrix(m.uav_quat), matrix(s.align.quat)
    for i in range(3):
        u = m.uav_force[i] - (lift if i == 2 else 0.0)
        for k in range(3):
            for j in range(3):
                u -= R[k, i] * R_align[j, k] * (push[j] - gravity[j])
        s.gust[i] = min(max(u, -p.gust_max), p.gust_max)


@njit(cache=True)
def _model_acceleration(q: Array, R_align: Array, lift: float, push: Array) -> Array:
    x = lift * 2.0 * (q[1] * q[3] + q[0] * q[2])
    y = lift * 2.0 * (q[2] * q[3] - q[0] * q[1])
    z = lift * (1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]))
    a = np.empty(3)
    for i in range(3):
        a[i] = R_align[i, 0] * x + R_align[i, 1] * y + R_align[i, 2] * z + push[i]  # (P.1)
    return a


@njit(cache=True)
def present(p: Record, s: Record) -> tuple[Array, Array]:
    """State (9,) and covariance (9, 9) of the centre of mass at the newest tick; there must have been a sample."""
    noise = Noise(p.white, p.blind, p.walk)
    return carry(s.track, s.track.mark[s.track.marks - 1], s.track.tick, noise, p.tick_s)
