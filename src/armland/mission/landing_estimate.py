"""What a landing's controller knows at each tick: arm, plate, hinge force, who carries the weight; compiled.

| symbol | name | unit |
|---|---|---|
| r, ṙ | `estimate.r`, `.v`: end effector point | m, m/s, world |
| p, ṗ | `estimate.plate`, `.plate_v`: the hinge's pivot on the UAV, by the pose filter | m, m/s, world |
| F | `estimate.hinge_force`: of the end effector on plate and UAV | N, world |
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.estimation.contact import detect
from armland.estimation.late_fusion import RING
from armland.estimation.pose_filter import fuse, predict
from armland.estimation.reckoning import advance
from armland.estimation.wrench import compensate
from armland.records import Record
from armland.rotations import Array, conjugate, matrix, multiply

LEAP = 0.05
"""rad from one sample to the next that no joint can move: 50 rad/s at 1 kHz, where the fastest is rated 3.14."""

ATTITUDE_LEAP = 0.15
"""Turn of the UAV's attitude between two samples, beyond what its rates explain, rad, that no UAV makes."""


@njit(cache=True)
def quaternion_of(R: Array) -> Array:
    """Unit quaternion (4,) of a rotation matrix (3, 3)."""
    q = np.empty(4)
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    if trace > 0.0:
        s = np.sqrt(trace + 1.0) * 2.0
        q[0], q[1], q[2], q[3] = 0.25 * s, (R[2, 1] - R[1, 2]) / s, (R[0, 2] - R[2, 0]) / s, (R[1, 0] - R[0, 1]) / s
        return q
    k = 0
    for i in range(1, 3):
        if R[i, i] > R[k, k]:
            k = i
    a, b = (k + 1) % 3, (k + 2) % 3
    s = np.sqrt(1.0 + R[k, k] - R[a, a] - R[b, b]) * 2.0
    q[0], q[1 + k] = (R[b, a] - R[a, b]) / s, 0.25 * s
    q[1 + a], q[1 + b] = (R[a, k] + R[k, a]) / s, (R[b, k] + R[k, b]) / s
    return q


@njit(cache=True)
def estimate_arm(m: Record, arm: Record, e: Record) -> None:
    """End effector point and its velocity, from the arm's joints."""
    e.tick = m.tick
    for i in range(3):
        e.r[i] = arm.position[i]
        speed = 0.0
        for k in range(m.q.shape[0]):
            speed += arm.jacobian[i, k] * m.qd[k]
        e.v[i] = speed


@njit(cache=True)
def estimate_plate(
    m: Record,
    arm: Record,
    camera: Array,
    lift: float,
    push: Array,
    sample_: NDArray[np.void],
    filter_p: NDArray[np.void],
    filter_s: NDArray[np.void],
    plate_: NDArray[np.void],
    e: Record,
) -> None:
    """Pose filter on camera and link: plate, and the UAV's attitude in the arm's world.

    Args:
        m: measurement.
        arm: arm model's state.
        camera: optical centre (3,), m, end effector frame.
        lift: force that lifts the UAV along its z, N: rotors and, where it is held, the hinge.
        push: (3,), m/s², world: what else is known to accelerate it.
        sample_: (1,) of `pose_filter.fuse`'s sample, overwritten.
        filter_p: the filter's parameters (1,).
        filter_s: its memory (1,).
        plate_: its output (1,).
        e: estimate, written.
    """
    for i in range(3):
        filter_s[0].push[m.tick % RING, i] = push[i]
    R = arm.rotation.copy()
    eye = arm.position.copy() + R @ camera
    advance(m.tick, m.uav_tick, m.uav_quat.copy(), m.uav_rate.copy(), lift, eye, quaternion_of(R), filter_p, filter_s)
    if m.camera_fresh:
        sample = sample_[0]
        sample.capture = m.camera_capture
        for i in range(3):
            sample.position[i] = m.camera_position[i]
        for i in range(4):
            sample.quat[i] = m.camera_quat[i]
        for i in range(6):
            sample.sigma[i] = m.camera_sigma[i]
        fuse(sample_, filter_p, filter_s)
    predict(0.0, filter_p, filter_s, plate_)
    plate = plate_[0]
    for i in range(3):
        e.plate[i], e.plate_v[i], e.plate_a[i] = plate.position[i], plate.velocity[i], plate.acceleration[i]
        e.omega[i] = plate.omega[i]
    for i in range(4):
        e.quat[i] = plate.quat[i]
    e.plate_valid, e.plate_age = plate.valid, plate.age


@njit(cache=True)
def look_at_grip(m: Record, p: Record, marker: Array, marker_quat: Array, s: Record) -> None:
    """Where the plate is on the magnet, from the newest image alone: no motion of the arm and no model comes in.

    Pivot in the end effector's frame: camera + sample + R_eb (ρ_p − ρ_m), R_eb = R(sample) R_bmᵀ. Written to the memory.

    Args:
        m: measurement.
        p: parameters.
        marker: ρ_m (3,), m, body.
        marker_quat: (4,), body<-marker.
        s: memory, written.
    """
    if not m.camera_fresh:
        return
    way = matrix(multiply(m.camera_quat, conjugate(marker_quat))) @ (p.lever - marker)
    apart = 0.0
    for i in range(3):
        apart += (p.camera[i] + m.camera_position[i] + way[i]) ** 2
    s.grip_offset, s.grip_tick = np.sqrt(apart), m.camera_capture
    s.grip_far = s.grip_far + 1 if s.grip_offset > p.slip else 0


@njit(cache=True)
def estimate_load(
    m: Record,
    arm: Record,
    acceleration: Array,
    free: bool,
    magnet: bool,
    retreat: float,
    wrench_p: NDArray[np.void],
    wrench_s: NDArray[np.void],
    contact_p: NDArray[np.void],
    contact_s: NDArray[np.void],
    load_: NDArray[np.void],
    e: Record,
) -> None:
    """Hinge force without bias and tool, and the shares of arm, rotors and ground.

    Args:
        m: measurement.
        arm: arm model's state.
        acceleration: of the tool (3,), m/s², world, as the reference has it.
        free: whether the end effector is known to touch nothing.
        magnet: whether the magnet was commanded on.
        retreat: way of the end effector since the magnet was switched off, m.
        wrench_p: parameters of `wrench.compensate` (1,).
        wrench_s: its memory (1,).
        contact_p: parameters of `contact.detect` (1,).
        contact_s: its memory (1,).
        load_: its output (1,).
        e: estimate, written; its attitude and thrust are read.
    """
    R, external, sigma = arm.rotation.copy(), np.zeros(6), np.zeros(6)
    compensate(m.wrench.copy(), R, acceleration, free, wrench_p, wrench_s, external, sigma)
    for i in range(3):
        e.hinge_force[i] = R[i, 0] * external[0] + R[i, 1] * external[1] + R[i, 2] * external[2]
    up = 1.0 - 2.0 * (e.quat[1] ** 2 + e.quat[2] ** 2)
    detect(e.hinge_force.copy(), e.thrust * up, magnet, retreat, contact_p, contact_s, load_)
    e.arm_share, e.ground_share = load_[0].arm_share, load_[0].ground_share


@njit(cache=True)
def admit(
    measurement: NDArray[np.void], good: NDArray[np.void], memory: NDArray[np.void], qpos: Array, qvel: Array
) -> int:
    """Screen a `measurement` (1,) and hand its joints (n,) to the arm model; returns how many numbers were not finite."""
    m = measurement[0]
    bad = screened(m, good[0], memory[0].held == 1)
    for i in range(qpos.shape[0]):
        qpos[i], qvel[i] = m.q[i], m.qd[i]
    return bad


@njit(cache=True)
def screened(m: Record, good: Record, held: bool) -> int:
    """Replace what is not finite, or leaps, by the last good value; returns how many numbers that were.

    A sample that cannot be used counts as not arrived: its device's clock stands still, for the watchdogs to see. Of the UAV's
    attitude a leap counts while it is `held`: there a false tilt would stop its rotors and move the arm.
    """
    if good.tick > 0:
        for i in range(m.q.shape[0]):
            if abs(m.q[i] - good.q[i]) > LEAP:
                m.q[i] = np.nan
    if held and _leaps(m, good):
        for i in range(4):
            m.uav_quat[i] = np.nan
    arm = _kept(m.q, good.q) + _kept(m.qd, good.qd)
    wrench = _kept(m.wrench, good.wrench)
    uav = _kept(m.uav_quat, good.uav_quat) + _kept(m.uav_rate, good.uav_rate)
    m.arm_tick = good.arm_tick = good.arm_tick if arm else m.arm_tick
    m.wrench_tick = good.wrench_tick = good.wrench_tick if wrench else m.wrench_tick
    m.uav_tick = good.uav_tick = good.uav_tick if uav else m.uav_tick
    good.tick = m.tick + 1
    bad = arm + wrench + uav
    if m.camera_fresh:
        total = 0.0
        for i in range(3):
            total += m.camera_position[i]
        for i in range(4):
            total += m.camera_quat[i]
        if not np.isfinite(total):
            m.camera_fresh = 0
            bad += 1
    return int(bad)


@njit(cache=True)
def _leaps(m: Record, good: Record) -> bool:
    # Further from the last good attitude than the rates, as they were and as they are, can have turned it.
    same, rate = 0.0, 0.0
    for i in range(4):
        same += m.uav_quat[i] * good.uav_quat[i]
    for i in range(3):
        rate += max(m.uav_rate[i] ** 2, good.uav_rate[i] ** 2)
    turned = 2.0 * np.arccos(min(abs(same), 1.0))
    return bool(turned > ATTITUDE_LEAP + 2.0 * np.sqrt(rate) * 1e-3 * (m.uav_tick - good.uav_tick))


@njit(cache=True)
def _kept(values: Array, last: Array) -> int:
    bad = 0
    for i in range(values.shape[0]):
        if np.isfinite(values[i]):
            last[i] = values[i]
        else:
            values[i] = last[i]
            bad += 1
    return bad


@njit(cache=True)
def tilt_of(quat: Array) -> float:
    """Angle of the body's z axis to the vertical, rad."""
    return float(np.arccos(min(max(1.0 - 2.0 * (quat[1] ** 2 + quat[2] ** 2), -1.0), 1.0)))
