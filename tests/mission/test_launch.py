"""The run-up: a reference without jumps that gets out of the UAV's way, a plan within the arm's limits, and what is refused."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.bounds import thresholds, tuned
from armland.mission.landing_scenario import Landing, landing_scenario
from armland.mission.landing_setup import set_up
from armland.mission.launch import LEAVE_S, SPEED_SHARE, way
from armland.mission.launch_procedure import CURRENT_GONE_S, LAUNCH, gives_speed, takeoff_phases
from armland.mission.launch_reference import leave, run_up
from armland.mission.phases import check
from armland.mission.takeoff_procedure import TAKEOFF

SKID_M, BESIDE_M = 0.035, 0.064
"""Lower edge of the skids below the plate's face, and their way to the tool."""


def scenario(**place):
    return landing_scenario("landing", {"place": place})


@pytest.mark.parametrize("move", [run_up, lambda t, duration: leave(t, duration, 0.35)])
def test_speed_and_acceleration_are_the_rates_of_the_way(move):
    h = 1e-5
    for t in (0.05, 0.2, 0.31, 0.6, 0.9):
        ahead, behind, here = move(t + h, 0.5), move(t - h, 0.5), move(t, 0.5)
        assert (ahead[0] - behind[0]) / (2.0 * h) == pytest.approx(here[1], abs=1e-6)
        assert (ahead[1] - behind[1]) / (2.0 * h) == pytest.approx(here[2], abs=1e-5)


def test_run_up_ends_at_speed_after_half_the_way():
    assert run_up(0.5, 0.5) == pytest.approx((0.25, 1.0, 0.0))
    assert run_up(0.8, 0.5) == pytest.approx((0.55, 1.0, 0.0))


def test_leave_ends_at_rest():
    assert leave(5.0, 0.5, 0.35)[1:] == (0.0, 0.0)


def slip_when_clear(slowed):
    """How far the arm lies behind a UAV at 0.65 m/s when it is `SKID_M` below; `slowed`(t): its speed over the UAV's."""
    t = np.linspace(0.0, 0.6, 6001)
    down = np.array([0.06 * run_up(x, LEAVE_S)[1] for x in t])
    behind = 0.65 * np.cumsum([1.0 - slowed(x) for x in t]) * (t[1] - t[0])
    return behind[np.argmax(down > SKID_M)]


def test_arm_is_below_the_skids_before_it_falls_behind():
    assert slip_when_clear(lambda t: leave(t, 0.25, LEAVE_S)[1]) < 0.1 * BESIDE_M
    # An arm that stops at once would be hit.
    assert slip_when_clear(lambda t: np.exp(-t / 0.06)) > BESIDE_M


def test_way_of_the_plan_is_the_reference():
    times = np.linspace(0.0, 2.0, 4001)
    along, down = way(times, 0.4, 0.06)
    assert np.gradient(along, times).max() == pytest.approx(1.0, abs=1e-3)
    assert np.abs(np.diff(along, 2)).max() < 1e-5
    assert along[-1] == pytest.approx(0.4 + 0.2 + CURRENT_GONE_S + 0.5 * LEAVE_S, abs=1e-9)
    assert down[-1] == pytest.approx(0.06)


@pytest.mark.parametrize("fly_on", [False, True])
def test_mission_is_free_of_contradictions(fly_on):
    landing = scenario(takeoff_velocity_mps=(0.5, 0.0, 0.0), fly_on=fly_on).landing
    table = set_up(landing_scenario("landing", {"place": landing.place.model_dump(mode="json")}), "takeoff").phases
    assert check(tuned(table, landing, 5.2), thresholds(landing)) == []
    assert [p.name for p in table] == [p.name for p in LAUNCH]
    uav = {p.name: p.uav for p in table}
    assert uav["done"] == ("cruise" if fly_on else "autonomous")


def test_without_a_speed_it_is_the_take_off_that_it_was():
    assert not gives_speed(Landing())
    assert takeoff_phases(Landing()) is TAKEOFF


def test_plan_keeps_the_way_within_the_limits():
    setup = set_up(scenario(takeoff_velocity_mps=(0.0, -0.6, 0.0)), "takeoff")
    p = setup.parameters[0]
    start = p["targets"][setup.table.number("bring")]
    assert start[1] > 0.1
    assert p["launch"] == pytest.approx([0.0, -0.6, 0.0])
    assert p["coast"] > 0.06
    phases = {x.name: x for x in setup.phases}
    assert phases["launch"].duration_s == pytest.approx(p["launch_s"])
    assert 0.0 < SPEED_SHARE < setup.scenario.landing.envelope.joint_speed_share


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
    with pytest.raises(Exception, match=words) as refusal:
        set_up(landing_scenario("landing", {"place": place}), "takeoff")
    assert type(refusal.value).__name__ in ("ConfigurationError", "WorkspaceError")


def test_weight_that_no_speed_of_this_kind_carries_is_refused():
    heavy = {"extra_mass_kg": 7.44 / 9.81 * 1.001 - 0.5278, "place": {"fly_on": True}}
    with pytest.raises(ConfigurationError, match=r"at 0\.00 m/s its rotors carry 7\.440 N: at most 0\.7584 kg"):
        set_up(landing_scenario("landing", heavy), "takeoff")
    # At 0.6 m/s it may fly, and for a study anything may.
    faster = {**heavy, "place": {"fly_on": True, "takeoff_velocity_mps": [0.0, -0.6, 0.0]}}
    assert set_up(landing_scenario("landing", faster), "takeoff").parameters["fly_on"][0] == 1
    assert set_up(landing_scenario("landing", heavy), "takeoff", trial=True).parameters["fly_on"][0] == 1
    # Landing it needs a hover with room for control.
    with pytest.raises(ConfigurationError, match=r"of which 6\.70 N may go into hovering"):
        set_up(landing_scenario("landing", heavy), "landing")
