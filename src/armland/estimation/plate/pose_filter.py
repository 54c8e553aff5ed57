"""Pose and twist of the hinge plate under the flying UAV, from late camera samples and the UAV's own attitude; compiled.

| symbol | name | unit, frame |
|---|---|---|
| p, v, b | of the UAV's centre of mass, by `late_fusion`; between samples by `reckoning` | m, m/s, m/s², D |
| q_wb = δ ⊗ q_imu | attitude; δ by `alignment`, q_imu by `reckoning` | 1 |
| ρ_m, ρ_p | `marker_offset`, `plate_offset`: from the centre of mass | m, body |
| s, p_c, R_wc | sample; camera's position and attitude at its capture | m, D |

A camera sample of tick c becomes z = p_c + R_wc s − R_wb ρ_m (P.2), with the camera's pose and the attitude of tick c, and is
fused at c. The plate is at p + R_wb ρ_p and moves with v + R_wb (ω × ρ_p) (P.3).

Assumptions: white noise; errors of δ and of p are independent.
"""

import numpy as np
from numba import njit

from armland.estimation.plate import alignment
from armland.estimation.plate.late_fusion import RING, Noise, carry, correct, insert, place, replay, spread
from armland.estimation.plate.reckoning import present
from armland.estimation.plate.scatter import SETTLED, compare, compare_attitude, learn_scatter
from armland.records import Record
from armland.rotations import Array, conjugate, cross, from_rotation_vector, matrix, multiply, skew, turned

LEAP_M, LEAP_S = 0.06, 0.3
"""A marker that is found so far from where it is expected, so soon after it was seen, is another one, or nothing that flies: in that
time a UAV at its largest tilt comes 0.13 m, and the filter knows most of it."""

SCATTER_TIMES = 3
"""By how many times later the filter begins anew where images scatter."""

FUSED, STARTED, RESTARTED, REPEATED, UNUSABLE, GATED = 0, 1, 2, 3, 4, 5
"""What `fuse` did: fused; first sample; began anew after too many gated ones; image frozen; stamp or number that cannot be
used; too far from what was expected."""


@njit(cache=True)
def fuse(m: Record, p: Record, s: Record) -> int:
    """Fuse the measurement's camera sample at its capture tick.

    A sample that repeats the last one bit by bit comes from a frozen image: real noise never does that (nor may a simulated
    camera be free of noise).

    Args:
        m: measurement, of which the camera's fields are read: m, quaternion camera<-marker, standard deviations in m and rad.
        p: of `layouts.told_layout`.
        s: of `layouts.kept_layout`, updated.

    Returns:
        What was done: `FUSED`, `STARTED`, `RESTARTED`, `REPEATED`, `UNUSABLE` or `GATED`.
    """
    s.noise = max(s.noise, 1.0)
    if not _usable(m, s):
        return UNUSABLE
    if _repeats(m, s):
        return REPEATED
    capture, first = m.camera_capture, s.track.marks == 0
    if first or (capture - s.sample_tick) * p.tick_s > p.forgotten:
        _start(m, first, np.zeros(9), p, s)
        s.fused = 0
        return STARTED if first else RESTARTED
    at = place(s.track, capture)
    if at == 0 or s.track.mark[at - 1].tick <= s.track.tick - RING + 1:
        return UNUSABLE
    noise = Noise(p.white, p.blind, p.walk)
    x, P = carry(s.track, s.track.mark[at - 1], capture, noise, p.tick_s)
    predicted = x.copy()
    z, R, R_theta = _resolve(m, p, s)
    scatter = compare(z, x, P, R, s)
    s.distance[0] = correct(x, P, z, R, p.gate)
    near = s.distance[0] <= p.gate
    theta = alignment.residual(_attitude_seen(m, p, s), multiply(s.align.quat, s.quat[capture % RING]))
    gate = p.gate if near else -1.0
    s.distance[1] = alignment.correct(s.align, capture, theta, R_theta, p.align_walk, gate, p.tick_s)
    upright = s.distance[1] <= p.gate
    learn_scatter(scatter, compare_attitude(theta, R_theta, s), upright, s)
    s.gated = 0 if near and upright else s.gated + 1
    # One that is alike time and again is to be believed; scatter is noise that has yet to be learnt, unless that never ends: then
    # what was expected is wrong.
    scatters = s.scattered > 1 and s.gated < SCATTER_TIMES * p.restart_after
    again = s.gated >= p.restart_after
    if near and (upright or scatters or again):
        # Where only the attitude is not as expected, velocity and disturbance stay known.
        if not (upright or scatters):
            _align(m, p, s)
        replay(s.track, insert(s.track, at, capture, x, P, z, R, True), noise, p.tick_s)
        s.gated, s.sample_tick = 0, max(s.sample_tick, capture)
        s.scattered, s.fused = 0 if upright else s.scattered, s.fused + 1
        return FUSED if upright else RESTARTED
    if scatters or not again:
        return GATED
    _begin_anew(m, z, predicted, not upright, p, s)
    return RESTARTED


@njit(cache=True)
def _begin_anew(m: Record, z: Array, predicted: Array, anew: bool, p: Record, s: Record) -> None:
    recent = (m.camera_capture - s.sample_tick) * p.tick_s < LEAP_S
    if recent and s.fused >= SETTLED and _apart(z, predicted) > LEAP_M:
        s.leapt = s.track.tick
    _start(m, anew, predicted, p, s)
    s.fused = s.scattered = 0


@njit(cache=True)
def _apart(a: Array, b: Array) -> float:
    return float(np.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2))


@njit(cache=True)
def _usable(m: Record, s: Record) -> bool:
    total, positive = 0.0, True
    for i in range(3):
        total += m.camera_position[i]
    for i in range(4):
        total += m.camera_quat[i]
    for i in range(6):
        total += m.camera_sigma[i]
        positive = positive and m.camera_sigma[i] > 0.0
    oldest = max(s.track.tick - RING + 1, s.first_tick)
    return s.track.begun == 1 and positive and np.isfinite(total) and oldest <= m.camera_capture <= s.track.tick


@njit(cache=True)
def _repeats(m: Record, s: Record) -> bool:
    same = True
    for i in range(3):
        same = same and m.camera_position[i] == s.seen[i]
        s.seen[i] = m.camera_position[i]
    for i in range(4):
        same = same and m.camera_quat[i] == s.seen[3 + i]
        s.seen[3 + i] = m.camera_quat[i]
    return same


@njit(cache=True)
def _resolve(m: Record, p: Record, s: Record) -> tuple[Array, Array, Array]:
    # Centre of mass (3,) and its covariance (3, 3) m²; covariance (3, 3) rad² of the attitude's residual; all in deck axes.
    row = m.camera_capture % RING
    R_wc = matrix(s.camera_quat[row])
    lever = turned(matrix(multiply(s.align.quat, s.quat[row])), p.marker_offset)
    offset = turned(R_wc, m.camera_position)
    z, seen, rotated = np.empty(3), np.zeros((3, 3)), np.zeros((3, 3))
    T = alignment.covariance(s.align, 0.0, 0.0)
    for i in range(3):
        z[i] = s.camera_position[row, i] + offset[i] - lever[i]  # (P.2)
        seen[i, i] = s.noise * m.camera_sigma[i] ** 2
        rotated[i, i] = s.noise * m.camera_sigma[3 + i] ** 2 + p.sigma_attitude**2
        T[i, i] += p.sigma_attitude**2
    # An error of δ shows as one of the position, too: without it the first samples would not fit each other.
    return z, _congruent(R_wc, seen) + _congruent(skew(lever), T), _congruent(R_wc, rotated)


@njit(cache=True)
def _attitude_seen(m: Record, p: Record, s: Record) -> Array:
    # Attitude (4,), D<-B, from the camera alone.
    return multiply(multiply(s.camera_quat[m.camera_capture % RING], m.camera_quat), conjugate(p.marker_quat))


@njit(cache=True)
def _align(m: Record, p: Record, s: Record) -> None:
    # The alignment anew, from this sample.
    heading, row = np.sqrt(m.camera_sigma[5] ** 2 + p.sigma_attitude**2), m.camera_capture % RING
    alignment.begin(s.align, m.camera_capture, _attitude_seen(m, p, s), s.quat[row], p.tilt_prior, heading)


@njit(cache=True)
def _start(m: Record, anew: bool, x: Array, p: Record, s: Record) -> None:
    # Position as seen; velocity and bias as in x (9,), but hardly trusted; the alignment anew, or as it is.
    if anew:
        _align(m, p, s)
    z, R, _ = _resolve(m, p, s)
    P = np.zeros((9, 9))
    for i in range(3):
        x[i] = z[i]
        for k in range(3):
            P[i, k] = R[i, k]
        P[3 + i, 3 + i], P[6 + i, 6 + i] = p.speed_prior**2, p.bias_prior**2
    s.track.marks = s.gated = s.compared = 0
    insert(s.track, 0, m.camera_capture, x, P, z, R, True)
    s.sample_tick = m.camera_capture


@njit(cache=True)
def predict(horizon_s: float, p: Record, s: Record, o: Record) -> None:
    """Fill `o` of `layouts.plate_layout`: the plate `horizon_s` ≥ 0, s, after the present tick; 0 is now. `p`, `s` as in `fuse`.

    The acceleration is held over the horizon, the rates for `hold_s`. `valid` says: sample and attitude are not older than
    `age_max_s`, and the standard deviations are within their limits. Before the first sample these are infinite.
    """
    now = s.track.tick
    o.tick, o.valid, o.age = now, 0, (now - s.sample_tick) * p.tick_s
    left = max((p.hold - (now - s.imu_tick)) * p.tick_s, 0.0)
    turn = from_rotation_vector(s.rate * min(horizon_s, left))
    quat = multiply(s.align.quat, multiply(s.quat[now % RING], turn))
    for i in range(4):
        o.quat[i] = quat[i]
    for i in range(3):
        o.omega[i] = s.rate[i]
        o.sigma_position[i] = o.sigma_velocity[i] = o.sigma_attitude[i] = np.inf
    if s.track.marks == 0:
        return
    x, P = present(p, s)
    spread(P, horizon_s, p.blind, p.walk)
    R = matrix(quat)
    lever, swing = turned(R, p.plate_offset), turned(R, cross(s.rate, p.plate_offset))
    for i in range(3):
        a = s.track.acceleration[now % RING, i] + x[6 + i]
        o.acceleration[i], o.bias[i] = a, x[6 + i] + s.felt[i]
        o.position[i] = x[i] + (x[3 + i] + 0.5 * a * horizon_s) * horizon_s + lever[i]
        o.velocity[i] = x[3 + i] + a * horizon_s + swing[i]  # (P.3)
    _deviations(P, R, lever, horizon_s, p, s, o)
    recent = max(now - s.sample_tick, now - s.imu_tick) <= p.age_max
    sharp = o.sigma_position.max() <= p.sigma_position_max and o.sigma_velocity.max() <= p.sigma_velocity_max
    o.valid = 1 if recent and sharp else 0


@njit(cache=True)
def _deviations(P: Array, R: Array, lever: Array, horizon_s: float, p: Record, s: Record, o: Record) -> None:
    # The marker is seen where it is: an error of δ moves the plate only about the marker.
    arm = skew(turned(R, p.plate_offset - p.marker_offset))
    T = alignment.covariance(s.align, (s.track.tick - s.align.tick) * p.tick_s + horizon_s, p.align_walk)
    reach = lever[0] ** 2 + lever[1] ** 2 + lever[2] ** 2
    for i in range(3):
        T[i, i] += p.sigma_attitude**2
    by_attitude = _congruent(arm, T)
    for i in range(3):
        o.sigma_position[i] = np.sqrt(P[i, i] + by_attitude[i, i])
        o.sigma_velocity[i] = np.sqrt(P[3 + i, 3 + i] + p.sigma_rate**2 * (reach - lever[i] ** 2))
        o.sigma_attitude[i] = np.sqrt(T[i, i])


@njit(cache=True)
def _congruent(A: Array, B: Array) -> Array:
    # A B Aᵀ, all (3, 3).
    C = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                for m in range(3):
                    C[i, j] += A[i, k] * B[k, m] * A[j, m]
    return C
