"""The devices of a landing as compiled functions of one tick: sensors with their clocks, link, motors and rotors.

| symbol | name | unit |
|---|---|---|
| b | `imu_bias` (4,): q_imu = b ⊗ q_true ⊗ noise: heading and tilt that the UAV gets wrong | 1 |
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.models.inflow import factor_at_speed
from armland.plant.landing_onboard import RING, fly
from armland.records import Record
from armland.rotations import Array, from_rotation_vector, matrix, multiply

PARAMETERS = np.dtype(
    [
        ("uplink", "i8"),  # ticks
        ("downlink", "i8"),  # ticks
        ("link_period", "i8"),  # ticks
        ("onboard_period", "i8"),  # ticks
        ("watchdog", "i8"),  # ticks without a message after which the UAV helps itself
        ("climb", "f8"),  # m, by which it climbs away
        ("kp", "f8", (3,)),
        ("kd", "f8", (3,)),
        ("lead", "f8"),  # s
        ("watch", "f8"),  # share of its due thrust below which a rotor counts as lost
        ("onboard_s", "f8"),
        ("mass", "f8"),
        ("mixer", "f8", (4, 4)),
        ("mixer_inverse", "f8", (4, 4)),
        ("rotor_min", "f8"),
        ("rotor_max", "f8"),
        ("rotor_gain", "f8"),  # share of a step that a rotor makes in one tick
        ("thrust_factor", "f8"),
        ("inflow", "i8"),  # 1 where the rotors feel their own motion
        ("disc", "f8"),  # 2ρA of one rotor, kg/m
        ("slope", "f8"),
        ("advance", "f8"),
        ("drag", "f8"),  # N·s/m, horizontal
        ("tick_s", "f8"),
        ("sigma_q", "f8"),
        ("sigma_qd", "f8"),
        ("sigma_force", "f8"),
        ("sigma_torque", "f8"),
        ("wrench_bias", "f8", (6,)),
        ("filter_gain", "f8"),
        ("sigma_attitude", "f8"),
        ("sigma_rate", "f8"),
        ("imu_bias", "f8", (4,)),
        ("hover_noise", "f8"),  # m
        ("q_d", "f8", (4,)),  # set-point before the first message
    ]
)

STATE = np.dtype(
    [
        ("up", "f8", (RING, 6)),  # q_d, thrust, mode as sent
        ("sent", "i8", (RING,)),  # tick of the message in that row; -1: none
        ("down", "f8", (RING, 7)),  # attitude and rates as sampled
        ("echo", "i8", (RING,)),  # `heard` as sampled
        ("imu", "f8", (7,)),
        ("wrench", "f8", (6,)),  # force-torque sensor's filter
        ("filtering", "i8"),
        ("arrived", "f8", (6,)),  # newest message on board
        ("heard", "i8"),  # tick at which it arrived
        ("hovering", "i8"),
        ("anchor", "f8", (3,)),  # m, world, where it hovers by itself
        ("heading", "f8"),  # rad
        ("integral", "f8", (3,)),  # of the hover's position loop; kept: what the UAV knows of its own thrust
        ("thrust", "f8"),  # N, set-point in use
        ("rate", "f8", (3,)),
        ("rotor_asked", "f8", (4,)),
        ("rotor", "f8", (4,)),  # thrust that each would give at rest, N
        ("lift", "f8", (4,)),  # thrust that each gives, N
        ("air", "f8", (3,)),  # velocity of the air, m/s, world
        ("rotor_due", "f8", (4,)),  # N, what the rotors would give if all were well
        ("weak", "i8"),  # samples for which a rotor has given too little
        ("cut", "i8"),  # 1: stopped its rotors itself
        # Faults, written by the plant.
        ("uplink_lost", "i8"),
        ("downlink_lost", "i8"),
        ("wrench_frozen", "i8"),
        ("arm_stale", "i8"),
        ("drift", "f8"),  # N on the force sensor's z
        ("health", "f8", (4,)),  # share of its thrust that each rotor gives
        ("force", "f8", (3,)),  # N, world, on the UAV
        ("torque", "f8", (3,)),  # N·m, world, on the UAV
        ("away", "f8", (3,)),  # m, by which a UAV that does not obey hovers elsewhere
        ("deaf", "i8"),
        ("camera_frozen", "i8"),
        ("camera_lost", "i8"),
    ]
)

SENSORS = (
    "q",
    "qd",
    "tau",
    "force",
    "torque",
    "quat",
    "gyro",
    "r",
    "v",
    "r_cm",
    "v_cm",
    "plate_quat",
    "ee_pos",
    "ee_vel",
    "ee_quat",
    "hinge_force",
    "cradle_force",
    "arm_cradle_force",
    "arm_floor_force",
    "arm_uav_force",
)
"""Sensors of the scene that are read; of the joints' three the first joint's."""

ADDRESSES = np.dtype([(name, "i8") for name in SENSORS])


@njit(cache=True)
def sense(
    tick: int,
    data: Array,
    adr: NDArray[np.void],
    p_: NDArray[np.void],
    s_: NDArray[np.void],
    noise: Array,
    measurement: NDArray[np.void],
    truth: NDArray[np.void],
) -> None:
    """Fill `measurement` (without camera and magnet) and `truth` from MuJoCo's `sensordata`; `noise` (2n + 12,) is standard normal."""
    a, p, s, m, t = adr[0], p_[0], s_[0], measurement[0], truth[0]
    n = m.q.shape[0]
    m.tick = tick
    t.tick = tick
    for i in range(n):
        t.tau[i] = data[a.tau + i]
    if not s.arm_stale:
        m.arm_tick = tick
        for i in range(n):
            m.q[i] = data[a.q + i] + p.sigma_q * noise[i]
            m.qd[i] = data[a.qd + i] + p.sigma_qd * noise[n + i]
    gain = p.filter_gain if s.filtering else 1.0
    s.filtering = 1
    for i in range(6):
        raw = data[a.force + i] if i < 3 else data[a.torque + i - 3]
        raw += p.wrench_bias[i] + (p.sigma_force if i < 3 else p.sigma_torque) * noise[2 * n + i]
        if i == 2:
            raw += s.drift
        s.wrench[i] += gain * (raw - s.wrench[i])
        if not s.wrench_frozen:
            m.wrench[i] = s.wrench[i]
    if not s.wrench_frozen:
        m.wrench_tick = tick
    _truth(data, a, s, t)
    _uav_sample(tick, p, s, noise[2 * n + 6 :], m, t)


@njit(cache=True)
def _truth(data: Array, a: Record, s: Record, t: Record) -> None:
    for i in range(3):
        t.r[i] = data[a.r + i]
        t.v[i] = data[a.v + i]
        t.r_cm[i] = data[a.r_cm + i]
        t.v_cm[i] = data[a.v_cm + i]
        t.omega[i] = data[a.gyro + i]
        t.ee[i] = data[a.ee_pos + i]
        t.ee_v[i] = data[a.ee_vel + i]
        t.cradle_force[i] = data[a.cradle_force + i]
    for i in range(4):
        t.quat[i] = data[a.quat + i]
        t.plate_quat[i] = data[a.plate_quat + i]
        t.ee_quat[i] = data[a.ee_quat + i]
        t.rotor_thrust[i] = s.lift[i]
    R = matrix(t.plate_quat)
    for i in range(3):
        # The sensor speaks plate axes, and of the force on the plate.
        t.hinge_force[i] = 0.0
        for k in range(3):
            t.hinge_force[i] -= R[i, k] * data[a.hinge_force + k]
    t.foul[0] = _length(data, a.arm_cradle_force)
    t.foul[1] = _length(data, a.arm_floor_force)
    t.foul[2] = _length(data, a.arm_uav_force)


@njit(cache=True)
def _length(data: Array, at: int) -> float:
    return float(np.sqrt(data[at] ** 2 + data[at + 1] ** 2 + data[at + 2] ** 2))


@njit(cache=True)
def _uav_sample(tick: int, p: Record, s: Record, noise: Array, m: Record, t: Record) -> None:
    if tick % p.onboard_period == 0:
        tilt = np.array([p.sigma_attitude * noise[0], p.sigma_attitude * noise[1], p.sigma_attitude * noise[2]])
        quat = multiply(multiply(p.imu_bias, t.quat), from_rotation_vector(tilt))
        for i in range(4):
            s.imu[i] = quat[i]
        for i in range(3):
            s.imu[4 + i] = t.omega[i] + p.sigma_rate * noise[3 + i]
    if tick % p.link_period == 0:
        row = s.down[tick % RING]
        for i in range(7):
            row[i] = s.imu[i]
        s.echo[tick % RING] = s.heard
    taken = tick - p.downlink
    if taken < 0:
        # Before the first sample has arrived the ground knows the attitude from before the run.
        for i in range(4):
            m.uav_quat[i] = s.down[0, i]
    elif taken % p.link_period == 0 and not s.downlink_lost:
        row = s.down[taken % RING]
        m.uav_tick, m.uav_heard = taken, s.echo[taken % RING]
        for i in range(4):
            m.uav_quat[i] = row[i]
        for i in range(3):
            m.uav_rate[i] = row[4 + i]


@njit(cache=True)
def actuate(
    tick: int,
    command: NDArray[np.void],
    truth: NDArray[np.void],
    tau_max: Array,
    p_: NDArray[np.void],
    s_: NDArray[np.void],
    noise: Array,
    ctrl: Array,
    applied: Array,
) -> bool:
    """Turn a `command` into joint torques `ctrl` (n,) and the wrench `applied` (6,), world, at the UAV's CM.

    Returns whether command and state are finite numbers; where they are not, nothing is applied.
    """
    c, t, p, s = command[0], truth[0], p_[0], s_[0]
    total = c.thrust
    for i in range(c.tau.shape[0]):
        total += c.tau[i]
    for i in range(4):
        total += c.uav_quat[i] + t.quat[i]
    for i in range(3):
        total += t.r[i] + t.omega[i]
    if not np.isfinite(total):
        return False
    for i in range(c.tau.shape[0]):
        ctrl[i] = min(max(c.tau[i], -tau_max[i]), tau_max[i])
    row = tick % RING
    s.sent[row] = -1 if s.uplink_lost else tick
    for i in range(4):
        s.up[row, i] = c.uav_quat[i]
    s.up[row, 4], s.up[row, 5] = c.thrust, c.uav_mode
    if tick % p.onboard_period == 0:
        fly(tick, p, s, t, noise)
    # The truth is one step old; the attitude now is a step of the angular velocity further.
    R = matrix(multiply(t.quat, from_rotation_vector(t.omega * p.tick_s)))
    wrench = np.zeros(4)
    for k in range(4):
        s.rotor_due[k] += p.rotor_gain * (s.rotor_asked[k] - s.rotor_due[k])
        s.rotor[k] += p.rotor_gain * (s.rotor_asked[k] * p.thrust_factor * s.health[k] - s.rotor[k])
    _rotors_in_air(R, t, p, s)
    for k in range(4):
        for i in range(4):
            wrench[i] += p.mixer[i, k] * s.lift[k]
    for i in range(3):
        applied[i] = R[i, 2] * wrench[0] + s.force[i]
        if i < 2:
            applied[i] -= p.drag * (t.v_cm[i] - s.air[i])
        applied[3 + i] = s.torque[i]
        for k in range(3):
            applied[3 + i] += R[i, k] * wrench[1 + k]
    return True


@njit(cache=True)
def _rotors_in_air(R: Array, t: Record, p: Record, s: Record) -> None:
    # What each rotor gives of its static thrust, by the velocity of its hub through the air.
    if not p.inflow:
        for k in range(4):
            s.lift[k] = s.rotor[k]
        return
    x, y, z = 0.0, 0.0, 0.0
    for i in range(3):
        v = t.v_cm[i] - s.air[i]
        x, y, z = x + R[i, 0] * v, y + R[i, 1] * v, z + R[i, 2] * v
    in_plane = np.sqrt(x * x + y * y)
    for k in range(4):
        axial = z + t.omega[0] * p.mixer[1, k] + t.omega[1] * p.mixer[2, k]
        s.lift[k] = s.rotor[k] * factor_at_speed(s.rotor[k], in_plane, axial, p.disc, p.slope, p.advance)
