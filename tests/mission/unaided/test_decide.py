"""What leads from one phase of a landing without an arm to the next, on a board filled by hand."""

import numpy as np
import pytest

from armland.mission.unaided.controller import UnaidedController
from armland.mission.unaided.decide import AWAY, DESCEND, DONE, FIND, GUIDE, READY, SETTLE, UNDER_M, decide
from armland.mission.unaided.plan import unaided_plan
from armland.scenario import load_scenario

PLAIN = {"quiet": 0.6, "cut_m": 0.01, "ready_m": 0.2, "sink_mps": 0.2, "patience_s": 15.0, "align_m": 0.1}


class Bench:
    """The board of a UAV in `phase`, seen just now, on its station `height` above standing."""

    def __init__(self, phase, height, **descent):
        plan = unaided_plan(load_scenario("unassisted", {"descent": {**PLAIN, **descent}}), "unassisted")
        self.controller = UnaidedController(plan)
        self.board = self.controller.board
        self.m, self.e = self.board["tick"]["measurement"], self.board["tick"]["estimate"]
        self.kept, self.told = self.board["kept"]["descent"], self.board["told"]["descent"]
        self.m["tick"], self.kept["phase"], self.kept["begin"] = 1000, phase, 1000
        self.e["plate_valid"] = 1
        self.e["plate"] = self.told["stand"] + [0.0, 0.0, height]

    def run(self, ticks):
        for _ in range(ticks):
            decide(self.board[0])
            self.m["tick"] += 1
        return int(self.kept["phase"][0])


def test_a_uav_that_is_known_is_guided():
    assert Bench(FIND, 0.6).run(250) == FIND
    assert Bench(FIND, 0.6).run(350) == GUIDE


def test_a_uav_that_is_never_seen_flies_away():
    bench = Bench(FIND, 0.6)
    bench.e["plate_valid"] = 0
    bench.kept["begin"] = -39_000
    assert bench.run(1100) == AWAY


def test_it_comes_down_from_its_station_alone():
    assert Bench(GUIDE, 0.5).run(350) == READY
    aside = Bench(GUIDE, 0.5)
    aside.e["plate"][0, 0] += 0.2
    assert aside.run(350) == GUIDE
    fast = Bench(GUIDE, 0.5)
    fast.e["plate_v"][0, 1] = 0.5
    assert fast.run(350) == GUIDE


def test_a_station_that_gusts_do_not_let_it_keep_is_good_enough_after_a_while():
    bench = Bench(GUIDE, 0.5)
    bench.e["plate_v"][0, 1], bench.kept["begin"] = 0.5, -9_500
    assert bench.run(600) == READY


def test_it_waits_for_a_quiet_moment():
    bench = Bench(READY, 0.2)
    bench.e["plate_v"][0, 2] = 0.4
    assert bench.run(100) == READY
    bench.e["plate_v"][0, 2] = 0.0
    assert bench.run(2) == DESCEND


def test_without_timing_it_does_not_wait():
    bench = Bench(READY, 0.2, timed=False)
    bench.e["plate_v"][0, 2] = 0.4
    assert bench.run(2) == DESCEND


def test_its_patience_ends():
    bench = Bench(READY, 0.2, patience_s=2.0)
    bench.e["plate_v"][0, 2] = 0.4
    assert bench.run(1990) == READY
    assert bench.run(20) == DESCEND


def test_it_does_not_go_down_unseen_and_looks_again():
    bench = Bench(READY, 0.2)
    bench.e["plate_age"] = 1.0
    assert bench.run(600) == GUIDE
    low = Bench(DESCEND, 0.04)
    low.e["plate_age"] = 1.0
    assert low.run(5) == DESCEND
    high = Bench(DESCEND, 0.15)
    high.e["plate_age"] = 1.0
    assert high.run(5) == GUIDE
    assert int(high.kept["retries"][0]) == 1


def test_a_descent_is_given_up_so_often_and_no_more():
    bench = Bench(DESCEND, 0.15)
    bench.e["plate"][0, 1] += 0.4
    bench.kept["retries"] = int(bench.told["retries"][0])
    assert bench.run(1) == AWAY


def test_rotors_stop_low_above_the_pad_and_a_second_later_it_is_done():
    assert Bench(DESCEND, 0.011).run(1) == DESCEND
    bench = Bench(DESCEND, 0.009)
    assert bench.run(1) == SETTLE
    assert bench.run(900) == SETTLE
    assert bench.run(200) == DONE


def test_one_that_sinks_no_more_has_touched_the_pad_whatever_its_height():
    bench = Bench(DESCEND, 0.03)
    bench.e["plate_v"][0, 2] = -0.01
    assert bench.run(60) == DESCEND
    assert bench.run(40) == SETTLE
    sinks = Bench(DESCEND, 0.03)
    sinks.e["plate_v"][0, 2] = -float(sinks.told["sink"][0])
    assert sinks.run(100) == DESCEND
    # High above the pad it may stand still.
    high = Bench(DESCEND, 0.15)
    assert high.run(100) == DESCEND


def test_a_height_that_is_wrong_does_not_keep_the_rotors_running():
    bench = Bench(DESCEND, 0.03)
    bench.kept["place"], bench.e["plate_v"][0, 2] = -0.85 * UNDER_M, -0.2
    assert bench.run(100) == SETTLE


def test_height_that_is_asked_for_falls_no_faster_than_the_descent():
    bench = Bench(READY, 0.5)
    bench.run(100)
    assert float(bench.kept["place"][0]) == pytest.approx(0.5 - 0.1 * 0.2)
    assert float(bench.kept["sinking"][0]) == 0.2
    bench.run(3000)
    assert float(bench.kept["place"][0]) == pytest.approx(0.2)
    assert float(bench.kept["sinking"][0]) == 0.0


def test_message_says_what_is_decided():
    bench = Bench(GUIDE, 0.5)
    bench.run(50)
    out = bench.board["tick"]["mission"]
    assert int(out["phase"][0]) == GUIDE
    np.testing.assert_allclose(out["elapsed"], 0.049)
