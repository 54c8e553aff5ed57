"""What may touch the cradle when, and from what height a UAV fell."""

import numpy as np
import pytest

from armland.experiments.judge.contacts import falls, may_touch, touches


def test_phases_of_the_touchdown_and_ends_may_touch_the_cradle(ticks, brief):
    np.testing.assert_array_equal(may_touch(ticks, brief), np.arange(len(ticks)) >= 2000)
    ticks["mission"]["phase"][1500:] = brief.phases.index("holding")
    np.testing.assert_array_equal(may_touch(ticks, brief), np.arange(len(ticks)) >= 1500)


def test_goal_is_no_end_in_which_all_is_allowed(ticks, brief):
    """A UAV that has taken off and comes down on the rails afterwards has failed."""
    allowed = may_touch(ticks, brief._replace(on_cradle=frozenset({"release"})))
    assert not allowed[2500:].any()


def test_speed_is_that_of_what_touches(ticks, brief):
    ticks["truth"]["ee_v"][:, 0], ticks["truth"]["v"][:] = 0.3, [0.0, 0.4, 0.0]
    found = {name: touch.speed[100] for name, touch in touches(ticks, brief).items()}
    assert found == pytest.approx(
        {
            "arm_touched_cradle": 0.3,
            "arm_touched_floor": 0.3,
            "arm_touched_uav": 0.5,
            "plate_touched_cradle": 0.4,
            "uav_touched_floor": 0.4,
            "uav_touched_cradle": 0.4,
        }
    )


@pytest.mark.parametrize("where", [2, 4])
def test_fall_ends_on_arm_or_floor_too(ticks, brief, where):
    t = ticks["truth"]
    t["v_cm"][:1500, 2] = -9.81e-3 * np.arange(1500)
    t["foul"][200:, where] = 5.0
    t["v_cm"][202:] = 0.0
    # Fallen freely for 0.2 s.
    assert falls(ticks, brief).max() == pytest.approx(0.5 * 9.81 * 0.2**2, rel=1e-9)


def test_one_that_rises_sinks_slowly_or_is_carried_down_has_not_fallen(ticks, brief):
    ticks["truth"]["v_cm"][:1900, 2] = -2.0
    ticks["truth"]["v_cm"][1995:2005, 2] = 2.0
    assert falls(ticks, brief).max() == 0.0
