"""What an operator may do to a mission, on its table alone."""

import numpy as np
import pytest

from armland.mission.controller import Controller
from armland.mission.registry import MISSIONS
from armland.mission.supervisor.operator import (
    ABORTS,
    HELD_BY_HAND,
    NUMBER,
    OPERATOR,
    step_into,
    wait,
    waiting,
    why_not_held,
)
from armland.mission.supervisor.table import FAULT_TABLE, FAULTS
from armland.mission.table.arrays import FAULT_ROWS
from armland.mission.table.phases import ARM, KINDS, UAV, Phase


def test_an_abort_leads_where_a_law_that_failed_does() -> None:
    assert tuple(ABORTS) == KINDS
    assert FAULT_TABLE["law_failed"] == ABORTS


def test_the_operator_stands_behind_the_faults() -> None:
    assert OPERATOR not in FAULTS
    assert NUMBER == len(FAULTS) < FAULT_ROWS


@pytest.mark.parametrize("mission", ["landing", "takeoff"])
def test_every_abort_has_an_end_in_the_mission(mission, landing_scenario) -> None:
    phases = MISSIONS[mission].phases(landing_scenario)
    names = {p.name for p in phases if p.final}
    assert {ABORTS[p.kind] for p in phases if not p.final} <= names


@pytest.mark.parametrize(
    ("phase", "why"),
    [
        (Phase("a", arm="hold", uav="station"), ""),
        (Phase("a", arm="move", uav="ramp"), ""),
        (Phase("a", arm="follow", uav="hinged"), "follows a path by the clock"),
        (Phase("a", arm="launch", uav="run_up"), "follows a path by the clock"),
        (Phase("a", arm="hold", uav="cruise"), "has a speed that it keeps"),
        (Phase("done", arm="hold", uav="off", final=True), "has ended in done"),
        (waiting()[0], "held already"),
        (waiting()[1], "held already"),
    ],
)
def test_where_a_mission_can_wait(phase: Phase, why: str) -> None:
    assert why in why_not_held(phase)
    assert bool(why) == bool(why_not_held(phase))


@pytest.fixture
def controller(landing_plan):
    made = landing_plan.again(1)
    return Controller(made._replace(phases=(*made.phases, *waiting())))


def test_a_mission_that_waits_does_what_it_did_but_moves_no_arm(controller) -> None:
    plan, board = controller.plan, controller.board
    now = plan.number("hand_over")
    board["kept"]["decide"]["phase"] = now
    wait(board, plan.phases, now, 500, UAV.index("level"), ARM.index("hold"))
    kept, row = board["kept"]["decide"][0], board["table"]["phases"][0]
    held, before = row[plan.number(HELD_BY_HAND[0])], row[now]
    assert (kept["phase"], kept["begin"], kept["fault"]) == (plan.number(HELD_BY_HAND[0]), 500, 0)
    for name in ("magnet", "link", "held", "free", "observe", "force"):
        assert held[name] == before[name]
    assert (held["arm"], held["uav"]) == (ARM.index("hold"), UAV.index("level"))
    assert held["first"] == held["end"]
    assert (held["final"], held["on_timeout"]) == (0, kept["phase"])
    faults = board["table"]["faults"][0]
    np.testing.assert_array_equal(faults[:, kept["phase"]], faults[:, now])


def test_on_the_cradle_it_waits_in_a_phase_that_may_touch_it(controller) -> None:
    plan, board = controller.plan, controller.board
    now = plan.number("unload")
    board["kept"]["decide"]["phase"] = now
    wait(board, plan.phases, now, 500, UAV.index("level"), ARM.index("hold"))
    assert plan.names[int(board["kept"]["decide"]["phase"][0])] == HELD_BY_HAND[1]
    assert plan.phases[-1].on_cradle
    assert not plan.phases[-2].on_cradle


def test_stepping_into_a_phase_begins_it_anew(controller) -> None:
    board = controller.board
    board["kept"]["refer"]["progress"], board["kept"]["decide"]["held_for"] = 1.0, 7
    board["kept"]["decide"]["unmet"] = 3
    step_into(board, 4, 900, NUMBER)
    kept = board["kept"]["decide"][0]
    assert (kept["phase"], kept["begin"], kept["fault"], kept["unmet"]) == (4, 900, NUMBER, 0)
    assert not kept["held_for"].any()
    # A guard that waits for the end of a move must not see that of the move before.
    assert board["kept"]["refer"]["progress"][0] == 0.0
    step_into(board, 5, 901, 0)
    assert board["kept"]["decide"]["fault"][0] == NUMBER
