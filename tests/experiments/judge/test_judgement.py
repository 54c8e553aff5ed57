"""The judge on records made by hand: what succeeds, what fails, and that the reason says where the UAV really is."""

import json

import numpy as np
import pytest

from armland.experiments.episode import fly, fly_prepared, prepare
from armland.experiments.judge.judgement import end_of, judge, last_flown, phase_times
from armland.mission.supervisor.remedies import REMEDIES
from armland.scenario import load_scenario


def test_a_landing_that_keeps_all_bounds_succeeds(ticks, brief):
    j = judge(ticks, brief)
    assert (j.success, j.reason, j.end, j.state, j.fault) == (True, "landed", "done", "standing", "none")
    assert j.figures["touchdown"] == {
        "speed_mps": pytest.approx(0.1),
        "tilt_deg": 0.0,
        "offset_m": pytest.approx(0.001),
    }
    assert [(p.name, p.start_s) for p in j.phases] == [
        ("guide", 0.0),
        ("close", 1.0),
        ("carry", 1.5),
        ("release", 2.0),
        ("done", 2.5),
    ]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda t: t["v"].__setitem__(1998, [0.0, 0.0, -0.2]), "speed at touchdown: 0.2 m/s, above 0.15 m/s"),
        (
            lambda t: t["r"].__setitem__((slice(2000, None), 0), 0.7),
            "placed beside the cradle's middle: 0.02 m, above 0.01 m",
        ),
        (lambda t: t["touching"].__setitem__(slice(-10, None), 2), "not let go: 2 pads, above 0 pads"),
        (lambda t: t["cradle_force"].__setitem__(slice(None), 0.0), "the UAV never stood on the cradle"),
        (lambda t: t["foul"].__setitem__((100, 1), 3.0), "limits violated: arm_touched_floor"),
    ],
)
def test_each_bound_can_fail(ticks, brief, change, words):
    change(ticks["truth"])
    j = judge(ticks, brief)
    assert not j.success
    assert words in j.reason


def test_a_uav_that_is_lost_is_called_lost_although_the_controller_is_done(ticks, brief):
    ticks["truth"]["v"][3000:, 2] = -3.1
    ticks["truth"]["r_cm"][-1] = [1.2, 0.1, 0.06]
    j = judge(ticks, brief)
    assert (j.success, j.end, j.state) == (False, "done", "lost")
    assert "the UAV is lost: it fell at up to 3.1 m/s, and is now at (1.20, 0.10, 0.06) m" in j.reason


@pytest.mark.parametrize("end", ["abort", "holding"])
def test_a_uav_that_is_lost_is_called_lost_whatever_the_end_promises(ticks, brief, end):
    ticks["mission"]["phase"][2500:] = brief.phases.index(end)
    ticks["mission"]["fault"][2500:] = 1
    ticks["truth"]["v"][3000:, 2] = -3.1
    reason = judge(ticks, brief).reason
    assert reason.startswith(f"ended in {end} after release: uav_silent")
    assert "the UAV is lost" in reason
    assert "flies" not in reason
    assert reason.endswith(REMEDIES["uav_silent"][1])


def test_a_time_out_says_what_may_be_wrong(ticks, brief):
    ticks["mission"]["phase"][1500:] = brief.phases.index("holding")
    assert "the arm did not arrive" not in judge(ticks, brief).reason
    ticks["mission"]["phase"][1500:2500] = brief.phases.index("carry")
    assert "the arm did not arrive" in judge(ticks, brief).reason


def test_an_end_that_leads_on_to_a_graver_one_is_no_phase_of_the_mission(ticks, brief):
    ticks["mission"]["phase"][2000:3000] = brief.phases.index("abort")
    ticks["mission"]["phase"][3000:] = brief.phases.index("holding")
    assert judge(ticks, brief).reason.startswith("ended in holding after carry")


def test_a_mission_that_has_not_ended_says_so(ticks, brief):
    assert judge(ticks[:1800], brief).reason.startswith("still in phase carry when the time was over: the arm")


def test_result_is_plain_data(ticks, brief):
    result = json.loads(json.dumps(judge(ticks, brief).result(), allow_nan=False))
    assert result["touchdown"]["offset_m"] == pytest.approx(0.001)
    assert {"success", "reason", "phases", "state", "end", "fault", "capture", "rest"} <= set(result)


def test_messages_of_a_log_are_judged_like_ticks(ticks, brief):
    messages = {name: np.array(ticks[name]) for name in ticks.dtype.names}
    assert judge(messages, brief) == judge(ticks, brief)


def test_a_contact_before_its_phase_is_no_landing(ticks, brief):
    """The same contact, later, is the touchdown: its figures are of that one."""
    ticks["truth"]["cradle_force"][1200:1210, 1] = 41.0
    ticks["truth"]["v"][1190:1210, 2] = -0.4
    j = judge(ticks, brief)
    assert not j.success
    assert j.reason == "limits violated: uav_touched_cradle (in close at 1.20 s, up to 41 N, at 0.40 m/s)"
    assert j.figures["touchdown"]["speed_mps"] == pytest.approx(0.1)
    assert judge(ticks, brief._replace(on_cradle=brief.on_cradle | {"close"})).limits_violated == []


def test_a_uav_that_only_hit_the_rails_early_never_stood(ticks, brief):
    ticks["truth"]["cradle_force"][:] = 0.0
    ticks["truth"]["cradle_force"][1200:1210, 2] = 41.0
    assert "the UAV never stood on the cradle" in judge(ticks, brief).reason


def test_cause_stands_before_the_end_and_what_followed_after_it(ticks, brief):
    ticks["mission"]["phase"][1500:] = brief.phases.index("abort")
    ticks["mission"]["fault"][1500:] = 1
    ticks["truth"]["foul"][1200:1600, 0] = 12.0
    ticks["truth"]["foul"][1700, 4] = 3.0
    ticks["truth"]["ee_v"][1198] = [0.0, 0.3, 0.0]
    reason = judge(ticks, brief).reason
    first = (
        "limits violated: arm_touched_cradle (in close at 1.20 s, up to 12 N, at 0.30 m/s); ended in abort after close"
    )
    assert reason.startswith(first)
    assert "; then limits violated: uav_touched_floor (in abort at 1.70 s, up to 3 N, at 0.10 m/s)" in reason


def test_whole_flights_figures_are_in_the_result(ticks, brief):
    ticks["truth"]["hinge_force"][1200] = [6.0, 8.0, -50.0]
    ticks["truth"]["v_cm"][1999, 2] = -0.1
    result = judge(ticks, brief).result()
    assert result["magnet_pull_max_n"] == pytest.approx(50.0)
    assert result["magnet_shear_max_n"] == pytest.approx(10.0)
    assert result["magnet_shear_max_ratio"] == pytest.approx(1.0)
    assert result["fall_m"] == pytest.approx(0.1**2 / (2 * 9.81))
    assert judge(ticks, brief._replace(hold=None)).magnet_pull_max_n is None


def test_phases_join_without_gaps(ticks, brief):
    times = phase_times(ticks["mission"]["phase"], brief.phases, brief.rate_hz)
    assert [(p.name, p.start_s, p.end_s) for p in times[:2]] == [("guide", 0.0, 1.0), ("close", 1.0, 1.5)]
    assert times[-1].end_s == len(ticks) / brief.rate_hz


def test_an_end_that_another_follows_is_no_phase_of_the_mission(ticks, brief):
    assert (end_of(ticks, brief), last_flown(ticks, brief)) == ("done", "release")
    ticks["mission"]["phase"][1500:2500] = brief.phases.index("abort")
    assert last_flown(ticks, brief) == "close"


def test_a_mission_that_has_not_ended_was_last_in_its_phase(ticks, brief):
    assert last_flown(ticks[:1800], brief) == "carry"


def test_an_arm_that_is_pushed_into_the_cradle_has_failed_for_that_reason():
    push = {"kind": "push", "phase": "guide", "after_s": 0.05, "size": 100.0, "body": "elbow"}
    flight = prepare(load_scenario("landing", {"faults": [{**push, "direction": [0.0, 1.0, 0.0]}]}), "landing", 1)
    # Its joints would feel the push, and the supervisor would stop the arm before.
    flight.controller.board["told"]["estimate"]["momentum"]["steady"] = np.inf
    j = fly_prepared(flight).judgement
    assert not j.success
    assert j.reason.startswith("limits violated: arm_touched_cradle (in align at ")


def test_a_uav_that_was_pushed_aside_and_came_back_lands_all_the_same():
    push = {"kind": "push", "phase": "approach", "after_s": 0.3, "lasts_s": 1.0, "size": 0.15, "body": "uav"}
    scenario = load_scenario("landing", {"faults": [{**push, "direction": [0.0, 1.0, 0.0]}]})
    j = fly(scenario, "landing", 1).judgement
    assert (j.success, j.limits_violated) == (True, [])
