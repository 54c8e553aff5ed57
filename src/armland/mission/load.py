"""What the force-torque sensor and the UAV's momentum say: hinge force, who carries the weight, disturbance; compiled.

| symbol | name | unit, frame |
|---|---|---|
| F | `estimate.hinge_force` (3,): of the end effector on plate and UAV | N, D |
| d̂ | `estimate.disturbance` (3,): what the model of the held UAV misses | N, D |
"""

import numpy as np
from numba import njit

from armland.estimation.contact import detect
from armland.estimation.disturbance import observe_force
from armland.estimation.wrench import compensate
from armland.models.environment import apparent_gravity
from armland.records import Record
from armland.rotations import cross, matrix, turned


@njit(cache=True)
def estimate_load(free: bool, magnet: bool, retreat: float, b: Record) -> None:
    """Hinge force without bias and tool, and the shares of arm, rotors and ground.

    Args:
        free: whether the end effector is known to touch nothing.
        magnet: whether the magnet was commanded on.
        retreat: displacement of the end effector since the magnet was switched off, m.
        b: board; the estimate's attitude and thrust are those of the present tick.
    """
    m, e, p, s = b.tick.measurement, b.tick.estimate, b.told.estimate, b.kept.estimate
    external, sigma, lifted = np.zeros(6), np.zeros(6), np.empty(3)
    gravity = apparent_gravity(b.environment, e.r, e.v)
    for i in range(3):
        lifted[i] = p.tool_follows * b.kept.refer.a[i] - gravity[i]
    compensate(m.wrench, b.arm.rotation, lifted, free, p.wrench, s.wrench, external, sigma)
    known = m.tick - m.wrench_tick <= p.wrench_age
    force = turned(b.arm.rotation, external)
    up = 1.0 - 2.0 * (e.quat[1] ** 2 + e.quat[2] ** 2)
    detect(force, e.thrust * up, magnet, retreat, p.contact, s.contact, s.load)
    e.arm_share, e.ground_share = s.load.arm_share, s.load.ground_share
    for i in range(3):
        # A force that is not known gives way to nothing.
        e.hinge_force[i] = force[i] if known else 0.0


@njit(cache=True)
def observe(b: Record, learns: bool) -> None:
    """Disturbance (3,), N, deck, that the momentum of the held UAV shows (X.3), from what acted on it since the tick before.

    The force that the law asked of the arm stands for the force given: an error of the arm's model is observed and made up for too.

    Args:
        b: board; its estimate is that of the present tick.
        learns: whether the phase lets it learn; what has been learnt stays.
    """
    e, p, s = b.tick.estimate, b.told.estimate, b.kept.estimate
    R = matrix(e.quat)
    v_cm, r_cm = turned(R, cross(e.omega, p.lever)), turned(R, p.lever)
    for i in range(3):
        v_cm[i], r_cm[i] = e.v[i] - v_cm[i], e.r[i] - r_cm[i]
    gravity = apparent_gravity(b.environment, r_cm, v_cm)
    observe_force(R, e.thrust, b.kept.act.force, v_cm, gravity, learns, p.observer, s.observer)
    for i in range(3):
        e.disturbance[i] = s.observer.force[i]
