"""Each limit is found where it is exceeded, and only where it is judged."""

import pytest

from armland.experiments.judge.limits import limits_violated


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
