"""Winch and rope below the UAV: forces in balance, and what they do to a landing."""

import numpy as np
import pytest

from armland.experiments.episode import fly, prepare
from armland.mission.unaided.decide import AWAY, DESCEND, READY
from armland.plant.unaided import tether
from armland.records import layout
from armland.scenario import load_scenario


@pytest.fixture(scope="module")
def landed():
    return fly(load_scenario("tether"), "tether", 3)


@pytest.fixture
def winch():
    scenario = load_scenario("tether")
    simulator = prepare(scenario, "tether", 3).simulator
    truth = np.zeros(1, layout("truth", 0))
    truth["deck_quat"][0, 0] = 1.0
    p = simulator.tether
    tether.forget(p)
    truth["r"] = p["fairlead"] + [0.0, 0.0, 0.4]

    def pulled(phase, ticks, move=0.0, aside=0.0):
        applied = np.zeros(6)
        for _ in range(ticks):
            applied[:] = 0.0
            truth["r"][0, 2] += move * 1e-3
            truth["v"][0, 2] = move
            tether.pull(p[0], phase, truth[0], truth["r"][0] + [aside, 0.0, 0.06], applied)
        return applied

    return p, pulled


def test_a_taut_rope_pulls_with_what_the_winch_keeps(winch):
    p, pulled = winch
    applied = pulled(READY, 3000)
    assert p["tension"][0, 3] == pytest.approx(0.3, abs=0.02)
    assert applied[2] == pytest.approx(-0.3, abs=0.03)
    np.testing.assert_allclose(applied[:2], 0.0, atol=1e-6)


def test_it_turns_the_uav_as_its_lever_says(winch):
    _, pulled = winch
    applied = pulled(READY, 3000, aside=0.1)
    # The pivot is 0.1 m beside where the wrench acts: r × F.
    assert applied[4] == pytest.approx(0.1 * applied[2], rel=1e-6)


def test_it_pays_out_to_one_that_rises_and_takes_in_from_one_that_sinks(winch):
    p, pulled = winch
    pulled(READY, 2000)
    before = float(p["rope"][0, 0])
    pulled(READY, 1000, move=0.1)
    assert float(p["rope"][0, 0]) - before == pytest.approx(0.1, abs=0.01)
    pulled(READY, 1000, move=-0.1)
    assert float(p["rope"][0, 0]) - before == pytest.approx(0.0, abs=0.01)


def test_it_reels_in_against_one_that_gives_way(winch):
    p, pulled = winch
    pulled(READY, 2000)
    before = float(p["rope"][0, 0])
    pulled(DESCEND, 1000, move=-0.2)
    assert before - float(p["rope"][0, 0]) == pytest.approx(0.2, abs=0.03)


def test_it_lets_go_of_one_that_flies_away(winch):
    _, pulled = winch
    pulled(READY, 500)
    assert not pulled(AWAY, 1).any()


def test_uav_comes_down_at_the_winchs_speed(landed):
    assert landed.result["state"] == "standing"
    sink = load_scenario("tether").descent.sink_mps
    assert landed.result["touchdown"]["speed_mps"] == pytest.approx(sink, abs=0.08)


def test_rope_holds_the_uav_on_the_pad(landed):
    force = landed.ticks["truth"]["cradle_force"][-200:, 2].mean()
    weight = float(landed.metadata["weight"])
    assert force == pytest.approx(weight + load_scenario("tether").tether.hold_n, rel=0.05)


def test_without_its_pull_it_does_not_follow_the_winch():
    # With next to no thrust beyond the weight the rope is slack, and nothing brings the UAV down but its own loop.
    idle = fly(load_scenario("tether", {"tether": {"pull_n": 0.01}}), "tether", 3)
    pulled = fly(load_scenario("tether"), "tether", 3)
    down = [np.flatnonzero(e.ticks["truth"]["cradle_force"][:, 2] > 0.2) for e in (idle, pulled)]
    begun = [np.flatnonzero(e.ticks["mission"]["phase"] == DESCEND)[0] for e in (idle, pulled)]
    taken = [d[0] - b if len(d) else np.inf for d, b in zip(down, begun, strict=True)]
    assert taken[1] < taken[0]


def test_same_seed_same_bytes(landed):
    assert fly(load_scenario("tether"), "tether", 3).ticks.tobytes() == landed.ticks.tobytes()
