"""The plan of a run-up within the arm's limits, and what is refused."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.feasibility.launch import (
    ACCELERATIONS,
    LEAVE_S,
    SPEED_SHARE,
    WAIT_S,
    Carrying,
    Launch,
    displacement,
    plan_launch,
    timed,
)
from armland.mission.missions.takeoff import CURRENT_GONE_S, PHASES, gives_speed, launch_phases
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
    assert [p.name for p in made.phases] == [p.name for p in launch_phases(fly_on)]
    uav = {p.name: p.uav for p in made.phases}
    assert uav["done"] == ("cruise" if fly_on else "autonomous")


def test_without_a_speed_it_is_the_plain_take_off():
    assert not gives_speed(scenario())
    assert MISSIONS["takeoff"].phases(scenario()) == PHASES


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


def carrying(made, velocity, speeds=None):
    wanted = scenario(takeoff_velocity_mps=velocity)
    speeds = made.arm.qd_max if speeds is None else speeds
    return Carrying(made.arm, speeds, 0.53, wanted)


@pytest.fixture(scope="module")
def launch(takeoff_plan):
    return plan_launch(carrying(takeoff_plan, (0.0, -0.4, 0.0)), takeoff_plan.home)


def test_run_up_is_no_harder_than_its_acceleration_and_leads_through_its_point(launch, takeoff_plan):
    """A septic from rest to v takes 35/16 v/a; the point lies on the line, between begin and end."""
    assert launch.acceleration in ACCELERATIONS
    assert launch.run_up_s == pytest.approx(max(35.0 / 16.0 * 0.4 / launch.acceleration, 0.2))
    way = np.array(scenario().place.launch_m) - launch.start
    np.testing.assert_allclose(np.cross(way, launch.velocity), 0.0, atol=1e-9)
    whole = displacement(np.array([9.0]), launch.run_up_s, 0.06)[0][0] * 0.4
    assert -1e-9 <= way @ launch.velocity / 0.4 <= whole + 1e-9


@pytest.mark.parametrize(("run_up_s", "leaving_s"), [(0.6, 0.775), (0.1, 0.35)])
def test_phases_are_as_long_as_the_plan_says(run_up_s, leaving_s):
    """Leaving takes as long as the slowing down that begins half-way, and no less than the way down."""
    made = Launch(np.zeros(3), np.zeros(3), run_up_s, 0.35, 2.0)
    assert made.leaving_s == pytest.approx(leaving_s)
    plain = {p.name: p for p in launch_phases(fly_on=False)}
    phases = {p.name: p for p in timed(tuple(plain.values()), made)}
    assert (phases["launch"].duration_s, phases["launch"].timeout_s) == (run_up_s, pytest.approx(run_up_s + WAIT_S))
    assert phases["leave"].duration_s == pytest.approx(leaving_s)
    assert phases["leave"].timeout_s == pytest.approx(leaving_s + 1.0)
    assert all(phases[n] == plain[n] for n in plain if n not in ("launch", "leave"))


def test_arm_stays_up_while_it_waits_and_goes_down_by_the_septic():
    """At half of the way down's time, half the depth; before the release, nothing."""
    leaves = 0.4 + WAIT_S + CURRENT_GONE_S
    along, down = displacement(np.array([0.4, leaves, leaves + 0.5 * LEAVE_S, leaves + LEAVE_S]), 0.4, 0.06)
    np.testing.assert_allclose(down, [0.0, 0.0, 0.03, 0.06], atol=1e-12)
    np.testing.assert_allclose(along[:3], [0.2, leaves - 0.2, leaves - 0.2 + 0.5 * LEAVE_S], atol=1e-12)
