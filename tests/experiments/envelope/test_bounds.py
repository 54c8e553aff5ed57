"""Bounds of the envelope: the search, and what shrinks and widens them."""

import numpy as np
import pytest

from armland.experiments.envelope.bench import CaptureBench, Start
from armland.experiments.envelope.bounds import Axis, Detail, Edge, Envelope, edge
from armland.scenario import load_scenario


def bound(bench, detail, name):
    return Envelope(bench, detail).edge(name, 0.0).bound


def other(**overrides):
    return CaptureBench(load_scenario("landing", overrides))


@pytest.mark.slow
def test_a_weaker_magnet_shrinks_the_envelope(bench, coarse):
    # The bound on the hinge's force goes with the rating.
    assert bound(other(magnet={"rating_n": 45.0}), coarse, "fastest") < 0.7 * bound(bench, coarse, "fastest")


def test_a_coil_that_has_yet_to_rise_shrinks_the_envelope(bench, coarse):
    b = bench
    before, gate = bound(b, coarse, "speed"), b.gate
    # As if the magnet were switched on at the gate: the plate drifts on while the current rises.
    b.run.restore(gate)
    magnet = b.simulator.world["kept"]["magnet"]
    magnet["current"], magnet["on_ticks"] = 0.0, 0
    b.gate = b.run.keep()
    try:
        assert bound(b, coarse, "speed") < 0.9 * before
    finally:
        b.gate = gate


@pytest.mark.slow
def test_a_larger_plate_widens_the_offset(bench, coarse):
    # The same mass: another weight would make another flight.
    larger = other(plate={"radius_m": 0.025, "mass_kg": 7850.0 * np.pi * 0.022**2 * 0.004})
    assert bound(larger, coarse, "offset") - bound(bench, coarse, "offset") == pytest.approx(0.003, abs=0.0006)


def test_edge_finds_the_first_failure(bench, coarse):
    held = bench.capture(Start())

    def caught(x):
        return replace_held(held, x < 0.37 or x > 0.8)

    found = edge(caught, 0.0, 1.0, Detail(coarse=5, fine=10))
    assert found.bound == pytest.approx(0.37, abs=3e-4)
    assert found.why == "made up"
    assert edge(lambda x: replace_held(held, True), 0.0, 1.0, coarse).bound == 1.0
    assert edge(lambda x: replace_held(held, False), 0.0, 1.0, coarse).bound == 0.0


def replace_held(capture, held):
    return capture._replace(held=held, why="held" if held else "made up")


def test_the_tightest_bound_counts():
    edges = Edge(0.01, "x"), Edge(0.05, "y")
    assert Axis("offset", edges, edges, 0.0, 0.0).bound.bound == 0.01
    assert Axis("slowest", edges, edges, 0.0, 0.0).bound_together.bound == 0.05
