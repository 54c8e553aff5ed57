"""What the controller knows of arm and UAV at each tick: screened measurement, pivot, hinge force, disturbance; compiled.

| symbol | name | unit |
|---|---|---|
| r, ṙ | `estimate.r`, `estimate.v` (3,) of the pivot | m, m/s, world |
| d̂_f (X.3) | `estimate.disturbance` (3,) | N, world |
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.estimation.disturbance import ObserverMemory, ObserverParameters, initial_observer, observe
from armland.models.uav import GRAVITY
from armland.records import Flag, Record
from armland.rotations import Array, cross, matrix, turned

NON_FINITE = Flag.NON_FINITE


def memory_layout() -> np.dtype:
    """What the controller keeps from tick to tick: the disturbance observer's memory (X.3) and what was asked last."""
    vectors = ("d_force", "d_moment", "linear", "omega", "impulse", "force", "torque")
    return np.dtype(
        [(name, "f8", (3,)) for name in vectors]
        + [("thrust", "f8"), ("gathered", "f8"), ("uav_tick", "i8"), ("started", "i8")]
    )


@njit(cache=True)
def screen(tick: NDArray[np.void], good: NDArray[np.void], qpos: Array, qvel: Array) -> None:
    """Replace what is not finite in the measurement by the last good value, say so in the health, copy q and q̇ out.

    Args:
        tick: all messages (1,), `tick_layout`.
        good: the last good measurement (1,), updated.
        qpos: receives the joint positions (n,).
        qvel: receives the joint velocities (n,).
    """
    m, g, h = tick[0].measurement, good[0], tick[0].health
    bad = keep_finite(m.q, g.q) + keep_finite(m.qd, g.qd) + keep_finite(m.wrench, g.wrench)
    bad += keep_finite(m.uav_quat, g.uav_quat) + keep_finite(m.uav_rate, g.uav_rate)
    h.flags = NON_FINITE if bad else 0
    for i in range(m.q.shape[0]):
        qpos[i] = m.q[i]
        qvel[i] = m.qd[i]


@njit(cache=True)
def keep_finite(values: Array, last: Array) -> int:
    """Replace values that are not finite by those of `last`, which is then brought up to date; returns how many."""
    bad = 0
    for i in range(values.shape[0]):
        if np.isfinite(values[i]):
            last[i] = values[i]
        else:
            values[i] = last[i]
            bad += 1
    return bad


@njit(cache=True)
def estimate_state(m: Record, p: Record, arm: Record, e: Record) -> None:
    """Fill the estimate: pivot from the arm's joints, attitude as last received, hinge force without the tool's weight."""
    e.tick = m.tick
    for i in range(3):
        e.r[i] = arm.position[i]
        speed = 0.0
        for k in range(m.q.shape[0]):
            speed += arm.jacobian[i, k] * m.qd[k]
        e.v[i] = speed
        e.omega[i] = m.uav_rate[i]
        e.hinge_force[i] = (
            arm.rotation[i, 0] * m.wrench[0] + arm.rotation[i, 1] * m.wrench[1] + arm.rotation[i, 2] * m.wrench[2]
        )
    e.hinge_force[2] -= p.tool_weight
    for i in range(4):
        e.quat[i] = m.uav_quat[i]


@njit(cache=True)
def observe_disturbance(m: Record, p: Record, memory: Record, e: Record) -> None:
    """Fill the estimate's disturbance (X.3) from the momentum of the UAV and what was asked of arm and rotors last.

    The force asked of the arm stands for the force given, so an error of the arm's model is observed and made up for too.
    """
    if p.observer == 0.0:
        return
    v_cm = e.v - turned(matrix(e.quat), cross(e.omega, p.lever))
    limits = (p.force_limit, p.moment_limit)
    q = ObserverParameters(p.mass, p.inertia, p.lever, GRAVITY, p.tick_s, p.observer, p.observer, limits[0], limits[1])
    if memory.started:
        # Copies: a field of a record has another type in compiled code than an array.
        kept = ObserverMemory(
            memory.d_force.copy(),
            memory.d_moment.copy(),
            memory.linear.copy(),
            memory.omega.copy(),
            memory.impulse.copy(),
            memory.gathered,
        )
        elapsed = (m.uav_tick - memory.uav_tick) * p.tick_s
        _, _, new = observe(e.quat, e.omega, v_cm, memory.thrust, memory.torque, memory.force, elapsed, q, kept)
    else:
        new = initial_observer(e.omega, v_cm, q)
    memory.started = 1
    memory.uav_tick = m.uav_tick
    memory.gathered = new.gathered
    for i in range(3):
        memory.d_force[i], memory.d_moment[i] = new.force[i], new.moment[i]
        memory.linear[i], memory.omega[i], memory.impulse[i] = new.linear[i], new.omega[i], new.impulse[i]
        e.disturbance[i] = new.force[i]
