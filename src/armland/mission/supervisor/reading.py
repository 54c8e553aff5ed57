"""Whether the force-torque sensor reads what no tool and no contact make it read: dead, reversed, scaled anew; compiled."""

from numba import njit

from armland.mission.reference.moves import BACK_OFF, NOD, YIELD
from armland.records import Record

ALIVE_S, ALIVE_N = 0.15, 0.36
"""Time constant of what the force sensor has read, and the share of the tool's weight by which it leaps where nothing touches it."""

APART_M, FOLLOWS_MPS = 0.015, 0.03
"""Distance of the plate, and the speed off its reference, up to which the arm may have touched something."""

NOTHING = 0.09
"""Share of the tool's weight below which a sensor that carries it reads nothing."""

LIFTED = 0.6
"""Share of the tool's weight, beside what load and thrust explain, below which a sensor may read nothing."""

PRESSES_S = 0.4
"""Time within which the force of an arm that gives way has passed the tool's weight."""

LEAPT_S = 0.2
"""How long a leap of the marker counts."""


@njit(cache=True)
def misreads(expected: float, row: Record, b: Record) -> bool:
    """Whether the force-torque sensor reads what no tool and no contact make it read.

    Args:
        expected: vertical hinge force that load and thrust explain, N; NaN where nothing is known.
        row: phase.
        b: board; measurement and estimate are those of the present tick. What the search for faults remembers of the force is updated.
    """
    # Force of an arm that touches nothing and leaps as the tool's weight does whose bridge is dead, reversed or scaled anew; where
    # something may touch, only a reading of nothing at all, not even the tool's weight, is no contact's.
    m, e, p, kept, seen = b.tick.measurement, b.tick.estimate, b.told.decide.watch, b.kept, b.kept.decide.seen
    apart, off, sideways, nothing = 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        apart += (e.plate[i] - e.r[i]) ** 2
        off += (kept.refer.v[i] - e.v[i]) ** 2
        sideways += e.hinge_force[i] ** 2 if i < 2 else 0.0
        nothing += (m.wrench[i] - kept.estimate.wrench.bias[i]) ** 2
    tool = b.told.estimate.wrench.mass * b.told.act.uav.gravity
    # A plate that bounces off the arm leaves a force that is gone at once: then what is read is right, whatever it was before.
    leap = min(abs(e.hinge_force[2] - seen.usual), abs(e.hinge_force[2]))
    # What a UAV on the magnet put on the sensor is no part of what an arm that has left it feels.
    touched = kept.decide.held == 1 or apart <= APART_M**2
    seen.usual += (1.0 if touched else p.tick_s / ALIVE_S) * (e.hinge_force[2] - seen.usual)
    # On the cradle the arm gives way to what it touches, seen or not.
    clear = apart > APART_M**2 and (row.free == 1 or e.plate_age < LEAPT_S) and row.arm != YIELD
    alone = kept.decide.held == 0 and clear and off < FOLLOWS_MPS**2
    quiet = row.arm == NOD or row.arm == BACK_OFF
    leapt = alone and leap > ALIVE_N * tool and sideways < (0.3 * leap) ** 2
    # A UAV whose rotors lift as much as the tool weighs leaves the sensor nothing to read, and all is well.
    lifted = abs(tool + expected) < LIFTED * tool
    dead = row.free == 0 and nothing < (NOTHING * tool) ** 2 and not lifted
    seen.nothing = seen.nothing + 1 if dead else 0
    # An arm that presses a UAV onto the cradle as hard as the tool weighs gives way to that, and a sensor that is dead stays dead.
    dead = dead and (row.arm != YIELD or seen.nothing * p.tick_s > PRESSES_S)
    return bool(not quiet and (leapt or dead))
