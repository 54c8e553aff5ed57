"""What an operator may do to a mission: hold it where it is, go on, abort it. Like the supervisor he may only take authority away."""

from numba import njit

from armland.mission.decide import enter
from armland.mission.supervisor.table import FAULTS
from armland.mission.table.phases import Phase
from armland.records import Records

OPERATOR = "operator"
"""What a log calls the fault of a mission that the operator ended."""

NUMBER = len(FAULTS)
"""Its number, behind those that the supervisor can find."""

ABORTS = {
    "ground": "refused",
    "flight": "abort",
    "touch": "abort",
    "held": "holding",
    "cradle": "secured",
    "grip": "secured",
    "hinge": "resting",
}
"""Kind of phase -> end to which an abort leads: where a law that failed leads, too."""

HELD_BY_HAND = ("held_by_operator", "held_on_cradle")
"""Phases in which a mission waits: where the UAV may not touch the cradle, and where it may."""

STEADY = ("autonomous", "station", "level", "ramp", "off", "balance")
"""What the UAV may be doing where a mission is held: one that is given a speed cannot wait."""


def waiting() -> tuple[Phase, Phase]:
    """The two phases as a mission's table holds them before anything is held; `wait` fills their rows."""
    one, other = (Phase(name, arm="hold", uav="level", timeout_s=3600.0, on_timeout=name) for name in HELD_BY_HAND)
    return one, other._replace(on_cradle=True)


def why_not_held(phase: Phase) -> str:
    """Why a mission cannot be held in a phase; empty where it can."""
    if phase.final:
        return f"the mission has ended in {phase.name}"
    if phase.name in HELD_BY_HAND:
        return "the mission is held already"
    if phase.arm in ("follow", "launch", "leave"):
        return f"{phase.name} follows a path by the clock, which does not wait; it can be aborted"
    if phase.uav not in STEADY:
        return f"in {phase.name} the UAV has a speed that it keeps; it can be aborted"
    return ""


def wait(board: Records, phases: tuple[Phase, ...], now: int, tick: int, level: int, hold: int) -> None:
    """Let the mission wait from `tick` on: the arm rests, UAV and magnet do what they do; the supervisor watches as before.

    Args:
        board: (1,), of the controller.
        phases: of the mission, the two of `waiting` last.
        now: number of the phase in progress.
        tick: that begins.
        level: number of the UAV's word that keeps the thrust which it has.
        hold: number of the arm's word that rests.
    """
    number = len(phases) - (1 if phases[now].on_cradle else 2)
    rows, faults = board["table"]["phases"][0], board["table"]["faults"][0]
    row = rows[number]
    for name in row.dtype.names:
        row[name] = rows[now][name]
    # A thrust that was on its way stays where it is; a share that is balanced goes on being balanced.
    if phases[now].uav == "ramp":
        row["uav"] = level
    row["arm"], row["duration"], row["timeout"] = hold, 0.0, 3600.0
    row["first"] = row["end"] = 0
    row["on_timeout"], row["final"] = number, 0
    faults[:, number] = faults[:, now]
    step_into(board, number, tick, 0)


@njit(cache=True)
def step_into(board: Records, phase: int, tick: int, fault: int) -> None:
    """Begin `phase` at `tick`, the one that comes next; where `fault` is not 0 it is named as the cause.

    Args:
        board: (1,), of the controller.
        phase: number.
        tick: that begins.
        fault: number.
    """
    b = board[0]
    if fault:
        b.kept.decide.fault = fault
    b.kept.decide.unmet = 0
    # The guards of the tick must not take the end of the move before for that of this one.
    b.kept.refer.progress = 0.0
    enter(phase, tick, b)
