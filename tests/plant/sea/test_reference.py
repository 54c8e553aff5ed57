"""The motion reference unit: late, at its rate, with the noise and the biases that it is told; and what it knows without them."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.plant.simulator import Simulator
from armland.rotations import conjugate, matrix, multiply


def test_unit_gives_the_deck_as_it_was(waiting):
    """Without noise: the truth of the sample's tick in deck axes, every 10 ms, 10 ms late."""
    led = waiting(sea={"state": "ss3"})
    rows = led.step(300)
    m, t = rows["measurement"], rows["truth"]
    assert m["deck_known"].all()
    np.testing.assert_array_equal(m["deck_tick"][50:], (np.arange(50, 300) - 10) // 10 * 10)
    for k in (100, 187, 255):
        then = t[m["deck_tick"][k]]
        R = matrix(then["deck_quat"].copy())
        np.testing.assert_allclose(m["deck_quat"][k], then["deck_quat"], atol=1e-12)
        for name, truth in (("deck_rate", "deck_omega"), ("deck_v", "deck_v"), ("deck_a", "deck_a")):
            np.testing.assert_allclose(m[name][k], R.T @ then[truth], atol=1e-12)


def test_unit_errs_as_it_is_told(landing):
    """Over 60 seeds the biases scatter by their standard deviations, and within a flight the samples by their noise."""
    biases = []
    for seed in range(60):
        sim = Simulator(
            landing(sea={"state": "ss1"}, imperfections={"noise": True}).with_seed(seed), np.zeros(7), "air"
        )
        biases.append(sim.world["told"]["reference"][0].copy())
    told = np.array(biases)
    assert np.rad2deg(2.0 * told["bias"][:, 1:3]).std() == pytest.approx(0.03, rel=0.25)
    assert told["a_bias"].std() == pytest.approx(0.01, rel=0.2)
    assert told["v_bias"].std() == pytest.approx(0.02, rel=0.2)
    np.testing.assert_allclose(told["sigma"][0], [*np.deg2rad([0.005, 0.07]), 0.003, 0.0042])


def test_tilt_that_the_unit_gets_wrong_leaves_gravity_in_its_acceleration(waiting):
    """b of 0.01 rad of roll: 0.0981 m/s² sideways."""
    led = waiting(sea={"state": "ss1"})
    tilt = np.array([np.cos(0.005), np.sin(0.005), 0.0, 0.0])
    led.sim.world["told"]["reference"]["bias"] = tilt
    rows = led.step(60)
    m, t = rows["measurement"][50], rows["truth"][40]
    np.testing.assert_allclose(multiply(conjugate(t["deck_quat"]), m["deck_quat"]), tilt, atol=1e-9)
    wrong = m["deck_a"] - matrix(t["deck_quat"].copy()).T @ t["deck_a"]
    np.testing.assert_allclose(wrong, [0.0, -0.0981, 0.0], atol=2e-3)


def test_delay_beyond_the_ring_is_refused(landing):
    scenario = landing(sea={"state": "ss1"}, motion_reference={"delay_ms": 700.0})
    with pytest.raises(ConfigurationError, match=r"motion_reference.delay_ms = 700: at 100 Hz at most 630 ms"):
        Simulator(scenario, np.zeros(7), "air")
    Simulator(landing(motion_reference={"delay_ms": 700.0}), np.zeros(7), "air")
