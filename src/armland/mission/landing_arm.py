"""The arm's part of a landing: its reference by phase, and its laws before and after the capture; compiled.

| symbol | name | unit |
|---|---|---|
| r_d, ṙ_d, r̈_d | `reference.r`, `.v`, `.a` (3,) of the end effector point | m, m/s, m/s², world |
| s(u) | septic from 0 to 1 | 1 |
| p, ṗ, p̈ | `memory.p`, `.pv`, `.pa`: the plate's pivot, smoothed | m, m/s, m/s², world |
| τ_j | `command.tau` (n,) | N·m |

Free: r̈ = r̈_d + k e + d ė in operational space, the classical impedance with K_d = Λ k, D_d = Λ d and Λ r̈_d fed forward (6).
Held: the exact law's force (X.1) with the disturbance observed (X.3), and Λ times the acceleration that it implies (X.2).
"""

import numpy as np
from numba import njit

from armland.control.exact import ExactGains, Reference, UavParameters, exact_law
from armland.control.impedance import elbow_field, orientation_pd, range_field
from armland.mission.landing_balance import lean_acceleration, load_force
from armland.mission.launch_reference import leave, run_up
from armland.mission.phases import ARM
from armland.models.operational import null_space_torque
from armland.records import Record
from armland.rotations import cross, matrix

HOLD, JOIN, TRACK, CLOSE, MOVE, BACK_OFF, YIELD, BRAKE, LAUNCH, LEAVE, BALANCE = range(len(ARM))

GRAVITY = 9.81


@njit(cache=True)
def septic(u: float, duration: float) -> tuple[float, float, float]:
    """s, ṡ and s̈ at share u of a move of `duration` s: from 0 to 1 with velocity, acceleration and jerk zero at both ends."""
    if u <= 0.0:
        return 0.0, 0.0, 0.0
    if u >= 1.0:
        return 1.0, 0.0, 0.0
    w = 1.0 - u
    s = u**4 * (35.0 + u * (-84.0 + u * (70.0 - 20.0 * u)))
    return s, 140.0 * u**3 * w**3 / duration, 420.0 * u * u * w * w * (1.0 - 2.0 * u) / duration**2


@njit(cache=True)
def track(e: Record, p: Record, s: Record, fresh_start: bool) -> None:
    """One tick of the filter that smooths the plate's motion: a double pole at `track` rad/s with the estimate's feed-forward."""
    for i in range(3):
        if fresh_start:
            s.p[i], s.pv[i], s.pa[i] = e.plate[i], e.plate_v[i], 0.0
            continue
        # A plate that nobody vouches for is not followed: the reference comes to rest.
        a = -2.0 * p.track * s.pv[i]
        if e.plate_valid:
            a = e.plate_a[i] + 2.0 * p.track * (e.plate_v[i] - s.pv[i]) + p.track**2 * (e.plate[i] - s.p[i])
        a = min(max(a, -p.track_a), p.track_a)
        s.pa[i] = a
        s.pv[i] += a * p.tick_s
        s.p[i] += s.pv[i] * p.tick_s


@njit(cache=True)
def refer(mode: int, elapsed: float, duration: float, phase: int, e: Record, p: Record, s: Record, r: Record) -> float:
    """Fill the reference of one tick; returns the progress of the phase's move.

    Args:
        mode: index into `ARM`.
        elapsed: time in the phase, s.
        duration: of its move, s.
        phase: index, for the target.
        e: estimate.
        p: parameters.
        s: memory, whose r0 and v0 are where the reference was when the phase began.
        r: reference, written.
    """
    u = elapsed / duration if duration > 0.0 else 1.0
    b, b_dot, b_ddot = septic(u, duration if duration > 0.0 else 1.0)
    fade = np.exp(-elapsed / p.coast)
    for i in range(3):
        down = 1.0 if i == 2 else 0.0
        if mode in (JOIN, TRACK):
            # The blend ends on the plate's motion, whatever that is by then.
            if mode == TRACK:
                b, b_dot, b_ddot = 1.0, 0.0, 0.0
            way = s.p[i] - down * p.standoff - s.r0[i]
            r.r[i] = s.r0[i] + b * way
            r.v[i] = b_dot * way + b * s.pv[i]
            r.a[i] = b_ddot * way + 2.0 * b_dot * s.pv[i] + b * s.pa[i]
        elif mode == CLOSE:
            reach = p.standoff + p.beyond
            r.r[i] = s.p[i] - down * (p.standoff - b * reach)
            r.v[i] = s.pv[i] + down * b_dot * reach
            r.a[i] = s.pa[i] + down * b_ddot * reach
        elif mode == LAUNCH:
            # The way that lies before the run-up's begin has its speed already.
            way, speed, rise = run_up(elapsed, p.launch_s)
            more = p.launch[i] - s.v0[i]
            r.r[i] = s.r0[i] + s.v0[i] * elapsed + more * way
            r.v[i] = s.v0[i] + more * speed
            r.a[i] = more * rise
        elif mode == LEAVE:
            way, speed, rise = leave(elapsed, p.launch_s, p.leave_s)
            b, b_dot, b_ddot = septic(elapsed / p.leave_s, p.leave_s)
            r.r[i] = s.r0[i] + s.v0[i] * way - down * b * p.depth
            r.v[i] = s.v0[i] * speed - down * b_dot * p.depth
            r.a[i] = s.v0[i] * rise - down * b_ddot * p.depth
        else:
            # What speed there was runs out over `coast`, so that the reference never jumps.
            way = 0.0
            if mode == MOVE:
                way = p.targets[phase, i] - s.r0[i] - s.v0[i] * p.coast
            elif mode == BACK_OFF:
                way = -down * p.depth
            r.r[i] = s.r0[i] + s.v0[i] * p.coast * (1.0 - fade) + b * way
            r.v[i] = s.v0[i] * fade + b_dot * way
            r.a[i] = -s.v0[i] / p.coast * fade + b_ddot * way
            if mode == YIELD:
                _give_way(i, e, p, s, r)
    return float(min(max(u, 0.0), 1.0))


@njit(cache=True)
def _give_way(i: int, e: Record, p: Record, s: Record, r: Record) -> None:
    # Where the hinge's force pushes, the reference follows, within bounds.
    v = -p.admittance * e.hinge_force[i]
    s.yielded[i] = min(max(s.yielded[i] + v * p.tick_s, -p.admittance_max), p.admittance_max)
    r.r[i] += s.yielded[i]


@njit(cache=True)
def held_force(e: Record, r: Record, p: Record, s: Record, learn: bool) -> None:
    """Observe the disturbance (X.3) and set `memory.force` to the exact law's force on the UAV (X.1)."""
    R = matrix(e.quat)
    v_cm = e.v - R @ cross(e.omega, p.lever)
    if s.observing and learn:
        for i in range(3):
            known = R[i, 2] * e.thrust + s.force[i] - (p.body_mass * GRAVITY if i == 2 else 0.0)
            missed = p.body_mass * v_cm[i] - s.linear[i] - known * p.tick_s
            # d̂ is a low pass of what the momentum gained beyond all that is known.
            d = s.d[i] + p.observer * (missed - s.d[i] * p.tick_s)
            s.d[i] = min(max(d, -p.force_limit), p.force_limit)
    s.observing = 1
    still = np.zeros(3)
    reference = Reference(e.quat, still, still, r.r, r.v, r.a)
    gains = ExactGains(p.k1, p.k2, p.k3_attitude, p.k3)
    uav = UavParameters(p.body_mass, p.inertia, p.lever)
    _, force = exact_law(e.quat, e.omega, e.r, v_cm, reference, e.thrust, still, uav, gains)  # (X.1)
    for i in range(3):
        s.linear[i] = p.body_mass * v_cm[i]
        s.force[i] = force[i] - s.d[i]  # (X.3)


@njit(cache=True)
def accelerate(held: bool, e: Record, r: Record, p: Record, s: Record, c: Record) -> tuple[float, float, float]:
    """Acceleration of the end effector that the law wants, m/s², world; fills `command.force`."""
    a = np.zeros(3)
    if held:
        R = matrix(e.quat)
        spin = R @ cross(e.omega, cross(e.omega, p.lever))
        for i in range(3):
            c.force[i] = s.force[i]
            a[i] = (s.force[i] + R[i, 2] * e.thrust + s.d[i]) / p.body_mass + spin[i]  # (X.2)
        a[2] -= GRAVITY
    else:
        for i in range(3):
            c.force[i] = 0.0
            a[i] = r.a[i] + p.k_free * (r.r[i] - e.r[i]) + p.d_free * (r.v[i] - e.v[i])  # (6)
    return a[0], a[1], a[2]


@njit(cache=True)
def arm_torque(
    held: bool, balances: bool, m: Record, e: Record, r: Record, p: Record, arm: Record, s: Record, c: Record
) -> None:
    """Fill the joint torques: τ_j = g + Cφ̇ + τ_nsp + 𝒥ᵀ(Λ(ẍ − 𝒥̇φ̇) + (F_EE, τ_ori)). Source: (6), (35), (X.2)."""
    n = m.q.shape[0]
    omega = np.zeros(3)
    for i in range(3):
        for k in range(n):
            omega[i] += arm.jacobian[3 + i, k] * m.qd[k]
    torque = orientation_pd(arm.rotation, p.R_d, omega, p.orientation_kp, p.orientation_kd)
    desired = np.zeros(6)
    desired[0], desired[1], desired[2] = accelerate(held, e, r, p, s, c)
    if balances:
        load_force(e, p, s, c)
        torque[:] = 0.0
        desired[3:] = lean_acceleration(omega, arm.rotation, p, s)
    desired -= arm.acceleration_bias
    wrench = np.zeros(6)
    for i in range(3):
        wrench[i], wrench[3 + i] = c.force[i], torque[i]
    for i in range(6):
        for k in range(6):
            wrench[i] += arm.lambda_ee[i, k] * desired[k]
    tau0 = elbow_field(arm.axis, arm.anchor, p.elbow, p.elbow_force) + range_field(
        m.q, p.q_min, p.q_max, p.range_margin, p.range_stiffness
    )
    for i in range(n):
        tau0[i] -= p.null_damping * m.qd[i]
    tau_nsp = null_space_torque(tau0, arm.mass_matrix, arm.jacobian, arm.lambda_ee)
    for i in range(n):
        tau = arm.gravity[i] + arm.coriolis[i] + tau_nsp[i]
        for k in range(6):
            tau += arm.jacobian[k, i] * wrench[k]
        c.tau[i] = tau


@njit(cache=True)
def begin_reference(mode: int, before: int, switched: bool, e: Record, r: Record, s: Record) -> None:
    """Remember where a phase's reference begins: where the last one was, or where the arm is, at rest.

    The latter where the arm begins to give way and where the law changes: the new one then begins without a force.
    """
    for i in range(3):
        s.r0[i], s.v0[i] = r.r[i], r.v[i]
        if mode == YIELD and before == YIELD:
            s.r0[i] -= s.yielded[i]
        elif mode == YIELD:
            s.r0[i], s.v0[i], s.yielded[i] = e.r[i], 0.0, 0.0
        elif switched:
            s.r0[i], s.v0[i] = e.r[i], e.v[i]
