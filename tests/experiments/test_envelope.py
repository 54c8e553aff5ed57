"""Captures from the gate, bounds among them, and the closed forms beside these."""

from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest

from armland.experiments.capture_bench import CaptureBench, Start
from armland.experiments.envelope import Axis, Detail, Edge, Envelope, edge
from armland.experiments.envelope_study import EnvelopeStudy, at_the_gate, study
from armland.experiments.landing import fly_landing
from armland.mission.landing_scenario import landing_scenario
from armland.models.capture import GATE_M, Grip
from armland.plant.landing_scene import LandingGear
from armland.plant.magnet import PADS, HingePlate

SMALL = Detail(directions=2, corners=1, points=2, coarse=3, fine=3)


@cache
def bench(**magnet):
    return CaptureBench(landing_scenario("landing", magnet or None))


@cache
def small() -> EnvelopeStudy:
    return study(landing_scenario(), SMALL, flights=1, frequencies=(0.7,))


def test_the_flights_own_capture_holds():
    found = bench().capture(Start())
    assert found.held, found.why
    assert found.touching == PADS
    assert found.force < 0.6 * 177.0
    assert found.slip < 1e-4


def test_the_same_start_gives_the_same_capture():
    start = Start(offset=0.003, speed=0.05, tilt=0.05)
    first = bench().capture(start)
    bench().capture(Start(offset=0.02, plate=0.4, closing=0.9))
    assert bench().capture(start) == first


@pytest.mark.parametrize(
    ("start", "why"),
    [
        (Start(offset=0.009), "3 of 4 pads"),
        (Start(offset=0.040), "no grip"),
        (Start(speed=0.35), "3 of 4 pads"),
        (Start(closing=0.9), "hinge_force"),
        (Start(tilt=np.deg2rad(35.0)), "no grip"),
        (Start(offset=0.004, speed=0.06, tilt=0.1, plate=np.deg2rad(15.0)), "1 of 4 pads"),
    ],
)
def test_outside_the_capture_fails(start, why):
    found = bench().capture(start)
    assert not found.held
    assert why in found.why


def test_the_start_is_as_asked_for():
    b = bench()
    b.flight.restore()
    b._place(
        Start(offset=0.004, offset_to=1.0, speed=0.1, speed_to=2.0, closing=0.2, tilt=0.2, plate=0.3, plate_to=0.7)
    )
    d, s, truth = b.plant.data, b.plant.scene, b.tick.truth[0]
    pivot = d.sensordata[s.sensor["r"] :][:3] - truth["ee"]
    np.testing.assert_allclose(pivot[:2], 0.004 * np.array([np.cos(1.0), np.sin(1.0)]), atol=1e-12)
    velocity = d.sensordata[s.sensor["v"] :][:3] - truth["ee_v"]
    np.testing.assert_allclose(velocity, [0.1 * np.cos(2.0), 0.1 * np.sin(2.0), -0.2], atol=1e-12)
    up = d.body(s.plate_body).xmat.reshape(3, 3)[:, 2]
    np.testing.assert_allclose(up, [np.sin(0.3) * np.cos(0.7), np.sin(0.3) * np.sin(0.7), np.cos(0.3)], atol=1e-12)
    assert b._smallest_gap() == pytest.approx(GATE_M, abs=1e-12)


def bound(name, **overrides):
    b = bench() if not overrides else CaptureBench(landing_scenario("landing", overrides))
    return Envelope(b, SMALL)._edge(name, 0.0, {}).bound


def test_a_weaker_magnet_shrinks_the_envelope():
    # The bound on the hinge's force goes with the rating.
    assert bound("fastest", magnet_rating_n=60.0) < 0.7 * bound("fastest")


def test_a_coil_that_has_yet_to_rise_shrinks_the_envelope():
    b = CaptureBench(landing_scenario())
    before = Envelope(b, SMALL)._edge("speed", 0.0, {}).bound
    # As if the magnet were switched on at the gate: the plate drifts on while the current rises.
    magnet = next(a for a in b.flight._kept if "on_ticks" in (a.dtype.names or ()))
    magnet["current"], magnet["on_ticks"] = 0.0, 0
    assert Envelope(b, SMALL)._edge("speed", 0.0, {}).bound < 0.9 * before


def test_a_larger_plate_widens_the_offset(monkeypatch):
    before = Envelope(bench(), SMALL)._edge("offset", 0.0, {}).bound
    larger = HingePlate(radius=0.025, density=7850.0 * (22.0 / 25.0) ** 2)
    monkeypatch.setattr("armland.plant.landing.LandingGear", partial(LandingGear, plate=larger))
    after = Envelope(CaptureBench(landing_scenario()), SMALL)._edge("offset", 0.0, {}).bound
    assert after - before == pytest.approx(0.003, abs=0.0006)


def test_edge_finds_the_first_failure():
    held = bench().capture(Start())

    def caught(x):
        return replace_held(held, x < 0.37 or x > 0.8)

    found = edge(caught, 0.0, 1.0, Detail(coarse=5, fine=10))
    assert found.bound == pytest.approx(0.37, abs=3e-4)
    assert found.why == "made up"
    assert edge(lambda x: replace_held(held, True), 0.0, 1.0, SMALL).bound == 1.0
    assert edge(lambda x: replace_held(held, False), 0.0, 1.0, SMALL).bound == 0.0


def replace_held(capture, held):
    return capture._replace(held=held, why="held" if held else "made up")


def test_the_controllers_idea_of_the_gear_is_the_plants():
    assert Envelope(bench(), SMALL).grip == Grip()


@pytest.mark.parametrize(("name", "factor"), [("offset", 1.15), ("speed", 1.25), ("tilt", 1.15), ("fastest", 1.25)])
def test_closed_forms_agree_with_the_captures(name, factor):
    axis = small().axis(name)
    for simulated, form in ((axis.bound.bound, axis.closed), (axis.bound_together.bound, axis.closed_together)):
        # A step of the search is what is left between the bound and the failure beyond it.
        assert form / factor - STEP[name] < simulated < factor * form + STEP[name]


STEP = {"offset": 0.0005, "speed": 0.017, "tilt": np.deg2rad(1.7), "fastest": 0.05}


def test_captures_hold_with_all_thresholds_at_once():
    found = small()
    assert found.corners_held == len(found.corners) == 10


def test_what_lies_outside_is_named():
    found = small()
    assert found.holds
    assert found.outside == []
    late = replace(found, allowed=found.allowed._replace(lost=0.015))
    assert [m.threshold for m in late.margins if not m.holds] == ["bounds.lost_offset_m"]
    assert not late.holds
    assert "bounds.lost_offset_m = 0.015 m" in late.outside[0]
    wide = replace(found, allowed=found.allowed._replace(offset=0.0065))
    assert "bounds.align_offset_m" in wide.outside[0]


def test_the_lowest_closing_speed_is_bounded_from_below():
    axis = Axis("slowest", (Edge(0.01, "x"),), (Edge(0.01, "x"), Edge(0.05, "y")), 0.0, 0.0)
    assert axis.bound_together.bound == 0.05
    found = replace(small(), axes=(*(a for a in small().axes if a.name != "slowest"), axis))
    lowest = found.margins[-1]
    assert not lowest.holds
    assert lowest.margin == pytest.approx(found.allowed.slowest - 0.05)


def test_result_has_the_documented_keys():
    result = small().result()
    assert set(result) == {
        "holds",
        "outside",
        "gate_m",
        "closing_mps",
        "thresholds",
        "corners",
        "axes",
        "maps",
        "flown",
        "interception",
        "captures",
    }
    assert set(result["thresholds"][0]) == {
        "threshold",
        "unit",
        "value",
        "bound",
        "alone",
        "closed_form",
        "margin",
        "limit",
        "holds",
    }


def test_flown_landings_lie_well_inside():
    (flown,) = small().flown
    assert flown.offset < 0.5 * small().axis("offset").bound.bound
    assert flown.speed < 0.5 * small().axis("speed").bound.bound
    assert flown.closing == pytest.approx(small().closing, rel=0.4)


def test_at_the_gate_reads_the_tick_of_passing():
    outcome = fly_landing(landing_scenario(), 2)
    close = 4
    state = at_the_gate(outcome.records, close)
    truth = outcome.records["truth"]
    phase = outcome.records["mission"]["phase"]
    gap = (truth["r"] - truth["ee"])[:, 2]
    first = int(np.flatnonzero((phase == close) & (gap < GATE_M))[0])
    assert state is not None
    assert state[0] == pytest.approx(np.hypot(*(truth["r"] - truth["ee"])[first, :2]))
    assert at_the_gate(outcome.records[:1000], close) is None
