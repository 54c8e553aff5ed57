"""The judge on records made by hand: what succeeds, what fails, and that the reason says where the UAV really is."""

import json

import numpy as np
import pytest

from armland.experiments.judge.judgement import end_of, judge, last_flown, limits_violated, phase_times
from armland.mission.supervisor.remedies import REMEDIES


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


@pytest.mark.parametrize(
    ("message", "field", "index", "value", "name"),
    [
        ("measurement", "q", (50, 2), 2.1, "joint_position"),
        ("measurement", "q", (50, 2), -2.1, "joint_position"),
        ("measurement", "qd", (50, 2), -2.0, "joint_speed"),
        ("truth", "tau", (slice(None), 3), -100.1, "joint_torque"),
        ("truth", "tau", (50, 3), 1.6, "torque_rate"),
        ("health", "sigma_min", 50, 0.02, "singularity"),
        ("truth", "hinge_force", (50, 0), 110.0, "hinge_force"),
        ("truth", "foul", (50, 0), 0.1, "arm_touched_cradle"),
        ("truth", "foul", (50, 1), 0.1, "arm_touched_floor"),
        ("truth", "foul", (50, 2), 0.1, "arm_touched_uav"),
    ],
)
def test_each_limit_is_found(ticks, brief, message, field, index, value, name):
    assert limits_violated(ticks, brief) == []
    ticks[message][field][index] = value
    assert limits_violated(ticks, brief) == [name]
    judged = name.startswith("arm_touched")
    assert limits_violated(ticks, brief._replace(limits={})) == ([name] if judged else [])


def test_the_torque_that_appears_in_the_first_tick_is_no_jump(ticks, brief):
    ticks["truth"]["tau"][2:, 1] = 40.0
    assert limits_violated(ticks, brief) == []


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
