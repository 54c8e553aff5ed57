"""Captures from the gate: the flight's own, repeated ones, and those that must fail."""

import numpy as np
import pytest

from armland.experiments.envelope.bench import Start
from armland.models.capture import GATE_M
from armland.plant.scene.gear import PADS


def test_the_flights_own_capture_holds(bench):
    found = bench.capture(Start())
    assert found.held, found.why
    assert found.touching == PADS
    assert found.force < 0.6 * 177.0
    assert found.slip < 1e-4


def test_the_same_start_gives_the_same_capture(bench):
    start = Start(offset=0.003, speed=0.05, tilt=0.05)
    first = bench.capture(start)
    bench.capture(Start(offset=0.02, plate=0.4, closing=0.9))
    assert bench.capture(start) == first


def test_tilted_uav_that_is_held_has_not_slipped(bench):
    # The filter lets it fly on along its tilt, by more than `bounds.slipped_m`: the images say that it stays.
    found = bench.capture(Start(tilt=np.deg2rad(15.0)))
    assert found.held, found.why
    assert found.slip < 1e-3


@pytest.mark.parametrize(
    ("start", "why"),
    [
        (Start(offset=0.009), "3 of 4 pads"),
        (Start(offset=0.040), "no grip"),
        (Start(speed=0.25), "3 of 4 pads"),
        (Start(speed=0.35), "no grip: miss"),
        (Start(closing=0.9), "hinge_force"),
        (Start(tilt=np.deg2rad(35.0)), "no grip"),
        (Start(offset=0.004, speed=0.06, tilt=0.1, plate=np.deg2rad(15.0)), "1 of 4 pads"),
    ],
)
def test_outside_the_capture_fails(bench, start, why):
    found = bench.capture(start)
    assert not found.held
    assert why in found.why


def test_the_start_is_as_asked_for(bench):
    b = bench
    b.run.restore(b.gate)
    b._place(
        Start(offset=0.004, offset_to=1.0, speed=0.1, speed_to=2.0, closing=0.2, tilt=0.2, plate=0.3, plate_to=0.7)
    )
    d, s, truth = b.simulator.data, b.simulator.scene, b.tick.truth[0]
    pivot = d.sensordata[s.sensor["r"] :][:3] - truth["ee"]
    np.testing.assert_allclose(pivot[:2], 0.004 * np.array([np.cos(1.0), np.sin(1.0)]), atol=1e-12)
    velocity = d.sensordata[s.sensor["v"] :][:3] - truth["ee_v"]
    np.testing.assert_allclose(velocity, [0.1 * np.cos(2.0), 0.1 * np.sin(2.0), -0.2], atol=1e-12)
    up = d.body(s.plate_body).xmat.reshape(3, 3)[:, 2]
    np.testing.assert_allclose(up, [np.sin(0.3) * np.cos(0.7), np.sin(0.3) * np.sin(0.7), np.cos(0.3)], atol=1e-12)
    assert b._smallest_gap() == pytest.approx(GATE_M, abs=1e-12)
