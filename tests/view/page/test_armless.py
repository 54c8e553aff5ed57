"""What a page leaves out of a landing without an arm: limits and deviations that only joints have."""

import pytest

from armland.experiments.episode import fly
from armland.runtime.log import read_log
from armland.scenario import load_scenario
from armland.view.flown import flown, scenario_of
from armland.view.page.belief import deviations
from armland.view.page.merits import NAMES, OF_JOINTS, limits


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """Of a second of an unassisted landing, with its result."""
    file = tmp_path_factory.mktemp("armless") / "a.mcap"
    episode = fly(
        load_scenario("unassisted", {"run": {"duration_s": 1.0}, "deviation": {"level": "published"}}),
        "unassisted",
        log=file,
    )
    return read_log(file), episode.result


def test_limits_are_those_that_a_uav_has(log):
    read, result = log
    named = [str(row[0]) for row in limits(result, flown(read)).rows]
    assert not {NAMES[bit] for bit in OF_JOINTS} & set(named)
    assert {NAMES[bit] for bit in NAMES if bit not in OF_JOINTS} <= set(named)


def test_deviations_of_an_arm_are_left_out(log):
    read, _ = log
    grid = deviations(scenario_of(read), 0, hinged=False)
    paths = [str(row[0]) for row in grid.rows]
    assert "uav.mass" in paths
    assert "arm.coulomb" not in paths
