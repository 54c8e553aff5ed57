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
from armland.mission.reference.moves import NOD
from armland.models.environment import apparent_gravity
from armland.records import Record
from armland.rotations import cross, matrix, turned

WEIGHED_S = 0.3
"""Time constant with which the held UAV's weight is learnt."""

MOST_ROTORS = 0.75
"""Share of the weight on the rotors above which too little is left to weigh."""

LEAST_ROTORS = 0.25
"""Share of the weight below which neither command nor lift say what the rotors make of a command."""

LEARNT_SHARE = 0.4
"""Of the believed weight: how far from it the UAV's may be. Beyond, something else pulls or the load is gone."""


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
    row = b.table.phases[b.kept.decide.phase]
    if row.arm == NOD and known:
        feel_nod(m, b)
    force = turned(b.arm.rotation, external)
    up = 1.0 - 2.0 * (e.quat[1] ** 2 + e.quat[2] ** 2)
    # By what carries the weight in hover: what the rotors really give of what they are asked for, nobody measures.
    lift = e.thrust * s.weight / max(b.kept.act.hover, 1e-3)
    s.felt = heaviness(b.environment, gravity[2])
    detect(force, lift * up, s.weight * s.felt, magnet, retreat, p.contact, s.contact, s.load)
    e.arm_share, e.ground_share = s.load.arm_share, s.load.ground_share
    for i in range(3):
        # A force that is not known gives way to nothing.
        e.hinge_force[i] = force[i] if known else 0.0
        s.calm[i] = s.calm[i] + p.calm_gain * (e.hinge_force[i] - s.calm[i]) if p.calm_gain < 1.0 else e.hinge_force[i]
    if known and row.held and row.observe and p.learns and e.r[2] > b.told.decide.clear_z:
        if p.windy:
            b.kept.act.hover = lift_felt(force[2], e.thrust, b.kept.act.hover, s.felt, p)
        else:
            weigh(force[2], e.thrust / max(b.kept.act.hover, 1e-3), p, s)


@njit(cache=True)
def heaviness(environment: Record, gravity_z: float) -> float:
    """What one weighs on the deck over what one weighs at rest, −γ_z/g, of `gravity_z` = γ_z, m/s², D; on land exactly 1.

    A hull that falls with 0.8 m/s² takes a twelfth of the load off the arm, as much as a cradle that begins to carry.
    """
    if not environment.moves:
        return 1.0
    g = environment.gravity
    return float(-gravity_z / np.sqrt(g[0] ** 2 + g[1] ** 2 + g[2] ** 2))


@njit(cache=True)
def feel_nod(m: Record, b: Record) -> None:
    """Compare the force that the sensor reads while the arm nods with the tool's inertia force, by the slope of a straight line,
    and the arm's speed with the one asked for.

    A constant bias does not change the first. A dead sensor gives 0, a reversed one −1. An arm that sticks makes part of the nod, and
    the tool's inertia force is as small. On a deck that moves it is weighed by all that moves it, a − γ: on a platform the deck makes
    three times as much force as the nod. Taken off as −m_t γ, what sensor and belief of m_t err of that would count as the nod's.

    Args:
        m: measurement.
        b: board; what the estimate keeps of the nod is updated.
    """
    n, mass = b.kept.estimate.nod, b.told.estimate.wrench.mass
    force, a, v, w = turned(b.arm.rotation, m.wrench[:3]), b.kept.refer.a.copy(), b.kept.refer.v, b.tick.estimate.v
    n.count += 1
    if b.environment.moves:
        gravity = apparent_gravity(b.environment, b.tick.estimate.r, v)
        for i in range(3):
            a[i] -= gravity[i]
    for i in range(3):
        n.a[i] += a[i]
        n.f[i] += force[i]
        n.aa[i] += a[i] * a[i]
        n.fa[i] += force[i] * a[i]
        spread = n.aa[i] - n.a[i] ** 2 / n.count
        if spread > 0.0:
            n.gain[i] = (n.fa[i] - n.f[i] * n.a[i] / n.count) / (mass * spread)
        n.vv[i] += v[i] ** 2
        n.wv[i] += w[i] * v[i]
        n.followed[i] = n.wv[i] / n.vv[i] if n.vv[i] > 0.0 else 1.0


@njit(cache=True)
def weigh(force: float, rotors: float, p: Record, s: Record) -> None:
    """Learn the weight of the UAV that hangs on the arm clear of the cradle; what cannot be one is not learnt.

    Args:
        force: vertical hinge force, N.
        rotors: share of the weight that the rotors carry.
        p: what the estimate is told.
        s: what it keeps; `weight`, N, is updated.
    """
    if rotors > MOST_ROTORS:
        return
    found = force / (s.felt - rotors)
    if abs(found - p.weight) < LEARNT_SHARE * p.weight:
        s.weight += p.tick_s / WEIGHED_S * (found - s.weight)


@njit(cache=True)
def lift_felt(force: float, thrust: float, hover: float, felt: float, p: Record) -> float:
    """The command that would carry the weight of a UAV that hangs on the arm in wind, N: T W/(W − F_z), averaged.

    There it is not the weight that is in doubt: level on the hinge the same command lifts up to 1.4 times as much as leaning in
    free flight, since no wind blows down through the rotors, and gusts change it.

    Args:
        force: vertical hinge force, N.
        thrust: that acts as far as is known, N.
        hover: that command as it was known, N.
        felt: share of the weight that is felt, 1, of `heaviness`.
        p: what the estimate is told.
    """
    lift = p.weight * felt - force
    if thrust < LEAST_ROTORS * p.weight or lift < LEAST_ROTORS * p.weight:
        return hover
    found = min(max(thrust * p.weight / lift, hover * (1.0 - LEARNT_SHARE)), hover * (1.0 + LEARNT_SHARE))
    return hover + p.tick_s / WEIGHED_S * (found - hover)


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
