"""Whether something touches the arm that should not, by the momentum of its joints; compiled."""

from numba import njit

from armland.estimation.momentum import drive, observe
from armland.mission.supervisor.table import FAULT
from armland.records import Record

ARM_BLOCKED = FAULT["arm_blocked"]


@njit(cache=True)
def touched(phase: int, b: Record) -> bool:
    """Whether a joint feels a torque that neither motors, nor model, nor the force sensor explain.

    Looked for where it matters, anew in each such stretch of phases: while the arm carries, its load is no contact. Where the end
    effector should touch nothing, what the force sensor reads is no excuse.

    Args:
        phase: index.
        b: board; measurement and estimate are those of the present tick. What the observer keeps is updated.
    """
    s, p, tick = b.kept.estimate.momentum, b.told.estimate.momentum, b.tick.measurement.tick
    if b.table.faults[ARM_BLOCKED, phase] < 0:
        s.begun, s.ratio = 0, 0.0
        return False
    if tick % p.period == 0:
        observe(b.tick.measurement.qd, b.arm, p, s)
    # What was sent last acts from this tick's sample to the next one's.
    drive(b.kept.limit.tau, b.tick.estimate.hinge_force, b.table.phases[phase].free == 0, b.arm, p, s)
    return bool(s.ratio > 1.0)
