"""Experiments as missions: their phases fill the path's time."""

import pytest

from armland.errors import ConfigurationError
from armland.mission.registry import MISSIONS
from armland.scenario import load_scenario


def test_phases_last_as_long_as_settling_moves_and_rests():
    scenario = load_scenario("paper")
    moves, run = scenario.trajectory.moves, scenario.run
    phases = {p.name: p for p in MISSIONS["E1"].phases(scenario)}
    total = run.settle_s + sum(m.duration_s + m.rest_s for m in moves) + run.tail_s
    assert phases["settle"].duration_s == run.settle_s
    assert phases["rest"].duration_s == moves[-1].rest_s + run.tail_s
    assert sum(phases[n].duration_s for n in ("settle", "follow", "rest")) == pytest.approx(total)


def test_uav_is_held_by_its_hinge_from_begin_to_end():
    for p in MISSIONS["track"].phases(load_scenario("paper")):
        assert (p.uav, p.link) == ("hinged", "hinged")
        assert p.held == (p.name != "resting")


def test_scenario_without_a_path_is_refused():
    scenario = load_scenario("paper").model_copy(update={"trajectory": None})
    with pytest.raises(ConfigurationError, match="the scenario has none"):
        MISSIONS["E1"].phases(scenario)
