"""A deck whose motion grows or calms down: smooth, and as MuJoCo's own step would move it."""

import numpy as np
import pytest

from armland.plant.sea.swell import SWELLS_S, swelled, turned
from armland.plant.sea.timed import timed_deck
from armland.scenario import load_scenario

RATE = 1000


@pytest.fixture(scope="module")
def deck():
    return timed_deck(load_scenario("landing", {"sea": {"state": "ss2"}, "run": {"duration_s": 15.0}}))


def test_a_share_goes_over_without_a_step() -> None:
    share = turned(np.ones(10_000), 2000, 0.25, RATE)
    assert (share[:2001] == 1.0).all()
    np.testing.assert_allclose(share[2000 + round(SWELLS_S * RATE) :], 0.25)
    assert (np.diff(share) <= 0.0).all()
    # Speed and acceleration begin and end with nothing, and are no more than the polynomial's own.
    first, second = np.diff(share) * RATE, np.diff(share, 2) * RATE**2
    assert np.abs(first).max() < 0.75 * 1.9 / SWELLS_S
    assert np.abs(second).max() < 0.75 * 5.9 / SWELLS_S**2
    assert np.abs(np.diff(second)).max() < 0.1


def test_another_target_midway_makes_no_step_either() -> None:
    share = turned(turned(np.ones(12_000), 2000, 2.0, RATE), 3000, 0.0, RATE)
    assert np.abs(np.diff(share, 2) * RATE**2).max() < 3.0
    np.testing.assert_allclose(share[-1], 0.0, atol=1e-12)


def test_a_share_of_one_changes_nothing(deck) -> None:
    out = swelled(deck, np.ones(len(deck)), RATE)
    np.testing.assert_array_equal(out[:, :6], deck[:, :6])
    np.testing.assert_allclose(out[1:-1], deck[1:-1], rtol=0.0, atol=1e-7)


def test_speeds_lead_from_place_to_place(deck) -> None:
    out = swelled(deck, turned(np.ones(len(deck)), 4000, 1.8, RATE), RATE)
    q, v, a = out[:, :6], out[:, 6:12], out[:, 12:]
    np.testing.assert_allclose(q[1:], q[:-1] + v[1:] / RATE, atol=1e-12)
    np.testing.assert_allclose(v[1:], v[:-1] + a[:-1] / RATE, atol=1e-12)
    np.testing.assert_array_equal(out[:4000, :12], swelled(deck, np.ones(len(deck)), RATE)[:4000, :12])
    np.testing.assert_allclose(q[8000:], 1.8 * deck[8000:, :6])
    # As smooth as the sea itself: no blow where the share begins to change.
    assert np.abs(a[3990:4010]).max() < 2.0 * np.abs(deck[3000:5000, 12:]).max()
