"""Each limit is exceeded by what it is about, and by nothing else: each has a change that must not count."""

import numpy as np
import pytest

from armland.experiments.judge.limits import excesses, in_words, limits_violated

ALWAYS = slice(None)
NO_BRIEF_NAMES_IT = ("_touched_", "_fell", "magnet_")


@pytest.mark.parametrize(
    ("message", "field", "index", "value", "name"),
    [
        ("truth", "q", (ALWAYS, 2), 2.1, "joint_position"),
        ("truth", "q", (ALWAYS, 2), -2.1, "joint_position"),
        ("truth", "q", (slice(50, None), 2), 0.002, "joint_speed"),
        ("truth", "tau", (ALWAYS, 3), -100.1, "joint_torque"),
        ("command", "tau", (50, 3), 1.6, "torque_rate"),
        ("command", "tau", (0, 3), 1.6, "torque_rate"),
        ("truth", "q", (ALWAYS, 1), -0.5 * np.pi, "singularity"),
        ("truth", "hinge_force", (50, 0), 110.0, "hinge_force"),
        ("truth", "hinge_force", (1200, 2), -61.0, "magnet_pull"),
        ("truth", "hinge_force", (1200, 1), 13.0, "magnet_shear"),
        ("truth", "hinge_force", (1200, ALWAYS), [8.0, 0.0, -40.0], "magnet_shear"),
        ("truth", "foul", (50, 0), 0.1, "arm_touched_cradle"),
        ("truth", "foul", (50, 1), 0.1, "arm_touched_floor"),
        ("truth", "foul", (50, 2), 0.1, "arm_touched_uav"),
        ("truth", "foul", (50, 3), 0.1, "plate_touched_cradle"),
        ("truth", "foul", (50, 4), 0.1, "uav_touched_floor"),
        ("truth", "cradle_force", (1999, 1), 0.1, "uav_touched_cradle"),
        ("truth", "v_cm", (1999, 2), -1.41, "uav_fell"),
        ("truth", "v_cm", (-1, 2), -1.41, "uav_fell"),
    ],
)
def test_each_limit_is_found(ticks, brief, message, field, index, value, name):
    assert limits_violated(ticks, brief) == []
    ticks[message][field][index] = value
    assert limits_violated(ticks, brief) == [name]
    judged = any(part in name for part in NO_BRIEF_NAMES_IT)
    assert limits_violated(ticks, brief._replace(limits={})) == ([name] if judged else [])


@pytest.mark.parametrize(
    ("message", "field", "index", "value"),
    [
        ("measurement", "q", (50, 2), 2.1),  # a sensor that lies
        ("measurement", "qd", (50, 2), -2.0),
        ("health", "sigma_min", 50, 0.0),
        ("truth", "tau", (50, 3), 1.6),  # torque that the motors add
        ("command", "tau", (slice(50, None), 3), 1.5),  # as fast as is allowed
        ("truth", "q", (slice(50, None), 2), 0.0018),
        ("truth", "hinge_force", (1200, 2), 61.0),  # a push
        ("truth", "hinge_force", (2700, 1), 13.0),  # nothing touches
        ("truth", "hinge_force", (1200, ALWAYS), [7.0, 0.0, -40.0]),
        ("truth", "cradle_force", (2000, 1), 90.0),  # the touchdown
        ("truth", "v_cm", (1999, 2), -1.39),
        ("truth", "v_cm", (1700, 2), -1.41),  # sinks, but nothing stops it
    ],
)
def test_what_exceeds_no_limit_is_not_found(ticks, brief, message, field, index, value):
    ticks[message][field][index] = value
    assert limits_violated(ticks, brief) == []


def test_motors_offset_that_comes_on_in_flight_is_no_jump_of_the_command(ticks, brief):
    ticks["truth"]["tau"][1000:, 1] = 40.0
    assert limits_violated(ticks, brief) == []
    ticks["command"]["tau"][1000:, 1] = 40.0
    assert limits_violated(ticks, brief) == ["torque_rate"]


def test_limits_in_words_stand_in_the_order_of_their_time(ticks, brief):
    ticks["truth"]["foul"][1200:1210, 0] = np.linspace(5.0, 41.2, 10)
    ticks["truth"]["ee_v"][1198] = [0.3, 0.0, 0.4]
    ticks["truth"]["hinge_force"][300, 0] = 110.0
    assert in_words(excesses(ticks, brief), ticks, brief) == (
        "hinge_force (in guide at 0.30 s, up to 110 N), arm_touched_cradle (in close at 1.20 s, up to 41 N, at 0.50 m/s)"
    )


def test_real_flights_exceed_nothing_and_would_if_they_might_not_touch(landed, taken_off, landing_scenario):
    """The negative control: the same records, of missions none of whose phases may touch the cradle."""
    from armland.experiments.judge.brief import brief_of

    for episode in (landed, taken_off):
        brief = brief_of(episode.metadata)
        assert limits_violated(episode.ticks, brief) == []
        assert limits_violated(episode.ticks, brief._replace(on_cradle=frozenset())) == ["uav_touched_cradle"]
