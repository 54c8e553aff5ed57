"""The plan of a run-up within the arm's limits, and what is refused."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.feasibility.launch import LEAVE_S, SPEED_SHARE, displacement
from armland.mission.missions.launch import CURRENT_GONE_S, PHASES, gives_speed
from armland.mission.missions.lifting import PHASES as LIFTING
from armland.mission.plan import plan
from armland.mission.registry import MISSIONS
from armland.mission.table.checks import check
from armland.mission.table.thresholds import thresholds_of
from armland.scenario import load_scenario


def scenario(**place):
    return load_scenario("landing", {"place": place})


def test_displacement_of_the_plan_is_the_references():
    times = np.linspace(0.0, 2.0, 4001)
    along, down = displacement(times, 0.4, 0.06)
    assert np.gradient(along, times).max() == pytest.approx(1.0, abs=1e-3)
    assert np.abs(np.diff(along, 2)).max() < 1e-5
    assert along[-1] == pytest.approx(0.4 + 0.2 + CURRENT_GONE_S + 0.5 * LEAVE_S, abs=1e-9)
    assert down[-1] == pytest.approx(0.06)


@pytest.mark.parametrize("fly_on", [False, True])
def test_mission_is_free_of_contradictions(fly_on):
    wanted = scenario(takeoff_velocity_mps=(0.5, 0.0, 0.0), fly_on=fly_on)
    made = plan(wanted, "takeoff")
    assert check(made.phases, thresholds_of(made.mission, wanted)) == []
    assert [p.name for p in made.phases] == [p.name for p in PHASES]
    uav = {p.name: p.uav for p in made.phases}
    assert uav["done"] == ("cruise" if fly_on else "autonomous")


def test_without_a_speed_it_is_the_plain_take_off():
    assert not gives_speed(scenario())
    assert MISSIONS["takeoff"].phases(scenario()) is LIFTING


def test_plan_keeps_the_path_within_the_limits():
    made = plan(scenario(takeoff_velocity_mps=(0.0, -0.6, 0.0)), "takeoff")
    p = made.told["refer"]
    start = p["targets"][0, made.number("bring")]
    assert start[1] > 0.1
    assert p["launch"][0] == pytest.approx([0.0, -0.6, 0.0])
    assert p["coast"][0] > 0.06
    phases = {x.name: x for x in made.phases}
    assert phases["launch"].duration_s == pytest.approx(p["launch_s"][0])
    assert 0.0 < SPEED_SHARE < made.scenario.limits.joint_speed_share


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ({"takeoff_velocity_mps": [3.0, 0.0, 0.0]}, r"cannot give 3\.00 m/s .* it can give about 0\.\d+ m/s"),
        ({"takeoff_velocity_mps": [0.0, 0.75, 0.0]}, r"cannot give 0\.75 m/s .*joint A\d would turn at \d"),
        ({"takeoff_velocity_mps": [0.0, 0.0]}, "takeoff_velocity_mps"),
        ({"takeoff_velocity_mps": [0.0, float("inf"), 0.0]}, "takeoff_velocity_mps"),
        ({"takeoff_velocity_mps": [0.1, 0.0, 0.0], "launch_m": [1.4, 0.0, 0.9]}, "out of reach by"),
    ],
)
def test_refusals_before_anything_moves(place, words):
    with pytest.raises(ConfigurationError, match=words):
        plan(scenario(**place), "takeoff")
