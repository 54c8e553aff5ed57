"""The demonstrator's devices as compiled functions of one tick: sensors, wireless link, onboard attitude controller.

Their state and parameters are structured records of shape (1,): values, not objects.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.control.attitude import (
    AttitudeMemory,
    CascadeGains,
    GeometricGains,
    QuaternionPdGains,
    cascade,
    geometric,
    quaternion_pd,
)
from armland.models.uav import allocate
from armland.records import Record
from armland.rotations import cross, from_rotation_vector, matrix, multiply

Array = NDArray[np.float64]

CONTROLLERS = ("quaternion_pd", "geometric", "cascade")
GEOMETRIC, CASCADE = 1, 2

DERIVATIVE_LAG_S = 0.01
"""Low pass of the cascade's derivative, s."""

RING = 1024
"""Length of the link's delay lines in ticks; the longest delay that can be simulated is one tick less."""

PARAMETERS = np.dtype(
    [
        ("uplink", "i8"),  # ticks
        ("downlink", "i8"),  # ticks
        ("link_period", "i8"),  # ticks
        ("onboard_period", "i8"),  # ticks
        ("effectiveness", "f8"),
        ("torque_limit", "f8", (3,)),
        ("controller", "i8"),  # index into CONTROLLERS
        ("kp", "f8", (3,)),
        ("kd", "f8", (3,)),
        ("lead", "f8"),  # s
        ("onboard_s", "f8"),
        ("inertia", "f8", (3, 3)),  # what the onboard controller believes
        ("observer", "f8"),  # rad/s
        ("lag_gain", "f8"),  # share of a step that a rotor makes between two samples on board
        ("mixer_inverse", "f8", (4, 4)),
        ("rotor_min", "f8"),
        ("rotor_max", "f8"),
        ("rotor_gain", "f8"),  # share of a step that a rotor makes in one tick
        ("tick_s", "f8"),
        ("force", "f8", (3,)),  # constant disturbance, N, world
        ("moment", "f8", (3,)),  # constant disturbance, N·m, body
        ("mixer", "f8", (4, 4)),
        ("sigma_q", "f8"),
        ("sigma_qd", "f8"),
        ("sigma_force", "f8"),
        ("sigma_torque", "f8"),
        ("force_bias", "f8", (3,)),
        ("filter_gain", "f8"),
        ("sigma_attitude", "f8"),
        ("sigma_rate", "f8"),
        ("idle_thrust", "f8"),
    ]
)

STATE = np.dtype(
    [
        ("up", "f8", (RING, 4)),  # Δτ and thrust as sent
        ("down", "f8", (RING, 7)),  # attitude and rates as sampled
        ("imu", "f8", (7,)),  # attitude and rates as the UAV measured them last
        ("wrench", "f8", (6,)),  # force-torque sensor's filter
        ("rotor_asked", "f8", (4,)),  # rotor thrusts that the onboard controller asks for
        ("rotor", "f8", (4,)),  # rotor thrusts that act
        ("filtering", "i8"),
        ("integral", "f8", (3,)),  # of the cascade's rate loop
        ("rate", "f8", (3,)),  # of its derivative
        ("torque", "f8", (3,)),  # that the rotors are believed to give
        ("momentum", "f8", (3,)),  # of the onboard observer
    ]
)

ADDRESSES = np.dtype([(name, "i8") for name in ("q", "qd", "tau", "force", "quat", "gyro", "r", "v", "v_cm", "hinge")])


@njit(cache=True)
def sense(
    tick: int,
    data: Array,
    adr: NDArray[np.void],
    p_: NDArray[np.void],
    s_: NDArray[np.void],
    joint_noise: Array,
    wrench_noise: Array,
    imu_noise: Array,
    measurement: NDArray[np.void],
    truth: NDArray[np.void],
) -> None:
    """Fill `measurement` and `truth` from MuJoCo's `sensordata` and one row each of standard normal noise."""
    a, p, s, m, t = adr[0], p_[0], s_[0], measurement[0], truth[0]
    n = m.q.shape[0]
    m.tick = tick
    t.tick = tick
    for i in range(n):
        m.q[i] = data[a.q + i] + p.sigma_q * joint_noise[i]
        m.qd[i] = data[a.qd + i] + p.sigma_qd * joint_noise[n + i]
        t.tau[i] = data[a.tau + i]
    gain = p.filter_gain if s.filtering else 1.0
    s.filtering = 1
    for i in range(6):
        raw = data[a.force + i]
        raw += p.sigma_force * wrench_noise[i] + p.force_bias[i] if i < 3 else p.sigma_torque * wrench_noise[i]
        s.wrench[i] += gain * (raw - s.wrench[i])
        m.wrench[i] = s.wrench[i]
    for i in range(3):
        t.r[i] = data[a.r + i]
        t.v[i] = data[a.v + i]
        t.v_cm[i] = data[a.v_cm + i]
        t.omega[i] = data[a.gyro + i]
    for i in range(4):
        t.quat[i] = data[a.quat + i]
        t.rotor_thrust[i] = s.rotor[i]
    for i in range(3):
        torque = 0.0
        for k in range(4):
            torque += p.mixer[i + 1, k] * t.rotor_thrust[k]
        t.tau_uav[i] = torque
    _rotate(t.quat, data, a.hinge, t.hinge_force)
    _uav_sample(tick, p, s, imu_noise, m, t)


@njit(cache=True)
def _rotate(q: Array, data: Array, at: int, out: Array) -> None:
    # The hinge's force sensor speaks body axes, the record world axes.
    w, x, y, z = q[0], q[1], q[2], q[3]
    a, b, c = data[at], data[at + 1], data[at + 2]
    out[0] = (1 - 2 * (y * y + z * z)) * a + 2 * (x * y - w * z) * b + 2 * (x * z + w * y) * c
    out[1] = 2 * (x * y + w * z) * a + (1 - 2 * (x * x + z * z)) * b + 2 * (y * z - w * x) * c
    out[2] = 2 * (x * z - w * y) * a + 2 * (y * z + w * x) * b + (1 - 2 * (x * x + y * y)) * c


@njit(cache=True)
def _uav_sample(tick: int, p: Record, s: Record, noise: Array, m: Record, t: Record) -> None:
    if tick % p.onboard_period == 0:
        tilt = np.array([p.sigma_attitude * noise[0], p.sigma_attitude * noise[1], p.sigma_attitude * noise[2]])
        quat = multiply(t.quat, from_rotation_vector(tilt))
        for i in range(4):
            s.imu[i] = quat[i]
        for i in range(3):
            s.imu[4 + i] = t.omega[i] + p.sigma_rate * noise[3 + i]
    if tick % p.link_period == 0:
        row = s.down[tick % RING]
        for i in range(7):
            row[i] = s.imu[i]
    taken = tick - p.downlink
    if taken >= 0 and taken % p.link_period == 0:
        row = s.down[taken % RING]
        m.uav_tick = taken
        for i in range(4):
            m.uav_quat[i] = row[i]
        for i in range(3):
            m.uav_rate[i] = row[4 + i]
    elif taken < 0:
        # Before the first sample has arrived the ground knows the attitude from before the run.
        for i in range(4):
            m.uav_quat[i] = s.down[0, i]
        for i in range(3):
            m.uav_rate[i] = 0.0


@njit(cache=True)
def actuate(
    tick: int,
    command: NDArray[np.void],
    truth: NDArray[np.void],
    tau_max: Array,
    p_: NDArray[np.void],
    s_: NDArray[np.void],
    ctrl: Array,
    applied: Array,
) -> bool:
    """Turn a `command` into joint torques `ctrl` (n,) and the wrench `applied` (6,), world, at the UAV's CM.

    Joint torques act at once; the UAV's part goes over the link to its own attitude controller. The wrench is applied from
    outside (MuJoCo's `xfrc_applied`), because MuJoCo's force sensors do not see actuators that act at a site.

    Returns whether the state is still a finite number.
    """
    c, t, p, s = command[0], truth[0], p_[0], s_[0]
    for i in range(c.tau.shape[0]):
        ctrl[i] = min(max(c.tau[i], -tau_max[i]), tau_max[i])
    row = s.up[tick % RING]
    for i in range(3):
        row[i] = c.delta_tau[i]
    row[3] = c.thrust
    if tick % p.onboard_period == 0:
        _onboard(tick, p, s)
    for i in range(4):
        s.rotor[i] += p.rotor_gain * (s.rotor_asked[i] - s.rotor[i])
    # The truth is one step old; the attitude now is a step of the angular velocity further.
    R = matrix(multiply(t.quat, from_rotation_vector(t.omega * p.tick_s)))
    wrench = np.zeros(4)
    for i in range(4):
        for k in range(4):
            wrench[i] += p.mixer[i, k] * s.rotor[k]
    for i in range(3):
        applied[i] = R[i, 2] * wrench[0] + p.force[i]
        applied[3 + i] = 0.0
        for k in range(3):
            applied[3 + i] += R[i, k] * (wrench[1 + k] + p.moment[k])
    total = 0.0
    for i in range(3):
        total += t.r[i] + t.omega[i]
    return bool(np.isfinite(total))


@njit(cache=True)
def _onboard(tick: int, p: Record, s: Record) -> None:
    # The UAV's own attitude controller and allocation, with what has arrived over the link.
    sent = tick - p.uplink
    extra = np.zeros(3)
    thrust = p.idle_thrust
    if sent >= 0:
        arrived = s.up[sent % RING]
        thrust = arrived[3]
        for i in range(3):
            extra[i] = p.effectiveness * min(max(arrived[i], -p.torque_limit[i]), p.torque_limit[i])
    quat, omega = s.imu[:4].copy(), s.imu[4:].copy()
    torque = _attitude_torque(quat, omega, p, s) + extra - _disturbance(omega, p, s, extra)
    rotor = allocate(thrust, torque, p.mixer_inverse, p.rotor_min, p.rotor_max)
    for i in range(4):
        s.rotor_asked[i] = rotor[i]


@njit(cache=True)
def _attitude_torque(quat: Array, omega: Array, p: Record, s: Record) -> Array:
    level, still = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
    memory = AttitudeMemory(s.integral.copy(), s.rate.copy())
    if p.controller == GEOMETRIC:
        torque, _ = geometric(quat, omega, level, still, still, GeometricGains(p.kp, p.kd, p.inertia), memory)
        return torque
    if p.controller == CASCADE:
        # PD times (1 + lead s): the derivative on the rate makes up for the rotors' lag.
        k_rate = p.kd + p.kp * p.lead
        unlimited = np.full(3, 1e9)
        gains = CascadeGains(
            p.kp / k_rate, unlimited, k_rate, still, p.kd * p.lead, unlimited, DERIVATIVE_LAG_S, p.onboard_s
        )
        torque, memory = cascade(quat, omega, level, still, still, gains, memory)
        for i in range(3):
            s.integral[i] = memory.integral[i]
            s.rate[i] = memory.rate[i]
        return torque
    torque, _ = quaternion_pd(quat, omega, level, still, still, QuaternionPdGains(p.kp, p.kd), memory)
    return torque


@njit(cache=True)
def _disturbance(omega: Array, p: Record, s: Record, extra: Array) -> Array:
    # Momentum observer of the torque that is neither the rotors' nor gyroscopic; the rotors' lag is modelled. What comes over
    # the link is there to cancel part of that torque, so it counts as part of what is left to find. (X.3)
    if p.observer == 0.0:
        return np.zeros(3)
    momentum = p.inertia @ omega
    gyroscopic = cross(omega, momentum)
    found = p.observer * (momentum - s.momentum)
    for i in range(3):
        asked = -extra[i]
        for k in range(4):
            asked += p.mixer[i + 1, k] * s.rotor_asked[k]
        s.torque[i] += p.lag_gain * (asked - s.torque[i])
        s.momentum[i] += p.onboard_s * (s.torque[i] - gyroscopic[i] + found[i])
    return found
