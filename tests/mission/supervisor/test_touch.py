"""When the arm's joints are watched, and from what they begin anew."""

import numpy as np
import pytest

from armland.mission.supervisor.table import FAULT
from armland.mission.supervisor.touch import touched


@pytest.fixture
def bench(bench):
    """An arm at rest that is held by its own weight's torques, with a step of the observer behind it."""
    bench.board["arm"]["coriolis"] = 0.0
    bench.kept["limit"]["tau"] = bench.board["arm"]["gravity"]
    return bench


def watch(bench, phase, ticks, pushed=0.0, joint=1):
    """What the last of some ticks says, in which a contact balances `pushed`, N·m, of a motor."""
    bench.enter(phase)
    number = bench.plan.number(phase)
    bench.kept["limit"]["tau"] = bench.board["arm"]["gravity"]
    bench.kept["limit"]["tau"][0, joint] += pushed
    for _ in range(ticks):
        bench.m["tick"] += 1
        found = touched(number, bench.b)
    return found


def kept(bench):
    return bench.kept["estimate"]["momentum"]


@pytest.mark.parametrize("phase", ["self_test", "guide", "approach", "align", "close", "miss"])
def test_arm_that_pushes_at_something_and_stays_where_it_is_is_touched(bench, phase):
    assert not watch(bench, phase, 200)
    assert float(kept(bench)["ratio"][0]) < 1e-6
    assert watch(bench, phase, 200, pushed=30.0)
    np.testing.assert_allclose(kept(bench)["r"][0, 1], -30.0, rtol=0.01)


@pytest.mark.parametrize("phase", ["hand_over", "carry", "unload", "withdraw", "done", "braked_free"])
def test_arm_that_carries_or_gives_way_or_has_ended_is_not_watched_and_begins_anew(bench, phase):
    assert not watch(bench, phase, 200, pushed=30.0)
    watch(bench, "guide", 200, pushed=30.0)
    watch(bench, phase, 1)
    assert not watch(bench, "guide", 10)
    assert np.abs(kept(bench)["r"]).max() < 1e-9


def test_doubt_bounds_what_goes_unnoticed(bench):
    watch(bench, "guide", 10)
    gravity, limit = abs(float(bench.board["arm"]["gravity"][0, 1])), float(bench.plan.arm.tau_max[1])
    least = 0.016 * limit + 0.24 * gravity
    assert not watch(bench, "guide", 300, pushed=0.9 * least)
    assert watch(bench, "guide", 300, pushed=2.0 * least)


@pytest.mark.parametrize(("phase", "excused"), [("guide", False), ("close", True)])
def test_reading_of_the_force_sensor_is_an_excuse_only_where_the_tool_may_touch(bench, phase, excused):
    watch(bench, phase, 20)
    bench.e["hinge_force"] = [0.0, 0.0, 60.0]
    felt = bench.board["arm"]["jacobian"][0, 2]
    bench.enter(phase)
    bench.kept["limit"]["tau"] = bench.board["arm"]["gravity"] + felt * 60.0
    for _ in range(300):
        bench.m["tick"] += 1
        found = touched(bench.plan.number(phase), bench.b)
    assert found != excused


def test_it_is_asked_only_where_the_table_says_so(bench):
    bench.board["table"]["faults"][0, FAULT["arm_blocked"], bench.plan.number("guide")] = -1
    assert not watch(bench, "guide", 300, pushed=100.0)
