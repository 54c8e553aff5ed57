"""Laws crossed with boards: each law keeps its gains, each board its controller, and which of the two does what."""

import pytest

from armland.experiments.factorial import ARMS, BOARDS, LAWS, cross, crossed
from armland.experiments.paper import prepare, run_experiments
from armland.mission.tuning import tuned
from armland.scenario import load_scenario


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("compare")


def flown(scenario, law, board):
    return run_experiments(prepare(crossed(scenario, law, board), [law])).metrics[law]


@pytest.mark.parametrize("law", ["E3", "split", "observer"])
def test_law_with_its_own_board_is_the_row_itself(scenario, law):
    row, cell = tuned(scenario.believed(), law), tuned(crossed(scenario, law, law).believed(), law)
    assert cell.control == row.control
    assert cell.onboard == row.onboard


def test_crossing_changes_the_board_alone(scenario):
    cell, own = tuned(crossed(scenario, "E3", "observer").believed(), "E3"), tuned(scenario.believed(), "E3")
    assert cell.onboard == tuned(scenario.believed(), "observer").onboard != own.onboard
    assert cell.control == own.control
    split = tuned(crossed(scenario, "split", "E3").believed(), "split")
    assert split.control.k3_attitude == tuned(scenario.believed(), "split").control.k3_attitude is not None
    assert split.onboard == scenario.onboard


def test_arm_is_wrong_in_the_model_or_in_the_plant(scenario):
    scales = {
        arm: (s.arm.inertia_scale, s.believed().arm.inertia_scale)
        for arm, change in ARMS.items()
        for s in [scenario.replaced(change)]
    }
    assert list(scales.values()) == [(1.0, 1.0), (1.0, 0.8), (1.0, 1.2), (0.8, 1.0), (1.2, 1.0)]


def test_board_keeps_the_attitude_and_the_law_the_position(scenario):
    paper, board, law = (flown(scenario, *x) for x in (("E3", "E3"), ("E3", "split"), ("implied", "E3")))
    assert board.attitude_max_deg < 0.2 * paper.attitude_max_deg
    assert board.position_rms_m == pytest.approx(paper.position_rms_m, rel=0.02)
    assert law.attitude_max_deg > 0.8 * paper.attitude_max_deg
    assert max(law.position_rms_m) < 0.1 * max(paper.position_rms_m)


@pytest.mark.slow
def test_every_cell_is_flown(scenario):
    told = []
    found = cross(scenario, lambda *what: told.append(what))
    assert len(found.cells) == len(LAWS) * len(BOARDS) * len(ARMS) == len(found.result()["cells"])
    assert told[-1] == ("done", 5, 5)
    # The observer bears an arm that is wrong either way, whichever board it flies with.
    z = {(c.law, c.board, c.arm): c.metrics.position_rms_m[2] for c in found.cells}
    for board in BOARDS:
        for arm in list(ARMS)[1:]:
            assert z["observer", board, arm] < 0.2 * z["split", board, arm]
