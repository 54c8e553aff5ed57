"""The filter on the plate's motion: follows, limits, and comes to rest where nobody vouches for the plate."""

import numpy as np
import pytest

from armland.mission.reference.refer import kept_layout, told_layout
from armland.mission.reference.track import begin_track, track
from armland.records import layout

RATE, TICK_S = 12.0, 1e-3


@pytest.fixture
def made():
    p, s, e = np.zeros(1, told_layout()), np.zeros(1, kept_layout()), np.zeros(1, layout("estimate", 7))
    p["tick_s"], p["track"], p["track_max"], p["track_speed"] = TICK_S, RATE, 3.0, 1.0
    p["room"] = [[-10.0] * 3, [10.0] * 3]
    e["plate"], e["plate_valid"] = [0.62, 0.01, 0.86], 1
    begin_track(e[0], p[0], s[0])
    return p, s, e


def run(made, ticks):
    p, s, e = made
    for _ in range(ticks):
        track(e[0], p[0], s[0])
    return s["p"][0]


@pytest.mark.parametrize(("valid", "far"), [(1, 0.3), (0, 0.02 / (2.0 * RATE))])
def test_plate_is_followed_only_while_somebody_vouches_for_it(made, valid, far):
    _, s, e = made
    s["pv"][0, 0], e["plate_valid"] = 0.02, valid
    e["plate"][0, 0] += 0.3
    start = s["p"].copy()
    assert run(made, 3000)[0] - start[0, 0] == pytest.approx(far, abs=1e-3)
    assert np.abs(s["pv"]).max() < 1e-3


def test_small_step_is_followed_by_a_double_pole(made):
    """x(t) = 1 − (1 + λt) e^(−λt), as long as no acceleration is limited."""
    _, s, e = made
    e["plate"][0, 1] += 0.01
    for t in (0.05, 0.1, 0.2):
        before = s.copy()
        x = run(made, round(t / TICK_S))[1] - 0.01
        assert x == pytest.approx(0.01 * (1.0 - (1.0 + RATE * t) * np.exp(-RATE * t)), rel=0.03)
        s[:] = before


def test_plate_that_moves_evenly_is_followed_without_lag(made):
    p, s, e = made
    e["plate_v"] = 0.1
    for _ in range(2000):
        e["plate"] += 0.1 * TICK_S
        track(e[0], p[0], s[0])
    np.testing.assert_allclose(s["p"][0], e["plate"][0], atol=2e-4)


def test_acceleration_is_fed_forward_and_limited(made):
    _, s, e = made
    e["plate_a"][0] = [1.0, 10.0, -10.0]
    run(made, 1)
    np.testing.assert_allclose(s["pa"][0], [1.0, 3.0, -3.0])


def test_one_tick_by_hand(made):
    """a = a_p + 2·12 (v_p − v) + 144 (p_p − p) while somebody vouches for the plate, and −2·12 v while nobody does."""
    _, s, e = made
    s["pv"][0], e["plate_v"][0], e["plate_a"][0] = [0.02, -0.01, 0.0], [0.05, 0.02, -0.01], [0.3, 0.0, -0.2]
    e["plate"][0] += [0.001, -0.002, 0.003]
    place, speed = s["p"][0].copy(), s["pv"][0].copy()
    for valid, wanted in (
        (1, [0.3 + 24.0 * 0.03 + 0.144, 24.0 * 0.03 - 0.288, -0.2 - 24.0 * 0.01 + 0.432]),
        (0, [-24.0 * 0.02, 24.0 * 0.01, 0.0]),
    ):
        s["p"], s["pv"], e["plate_valid"] = place, speed, valid
        run(made, 1)
        np.testing.assert_allclose(s["pa"][0], wanted, atol=1e-12)
        np.testing.assert_allclose(s["pv"][0], speed + 1e-3 * np.array(wanted), atol=1e-15)
        np.testing.assert_allclose(s["p"][0], place + 1e-3 * s["pv"][0], atol=1e-15)


def wandering(seed, ticks):
    """Estimates of a plate that leaps, flies off and goes blind, (ticks, 10): place, velocity, acceleration, validity."""
    rng = np.random.default_rng(seed)
    out = np.empty((ticks, 10))
    for k in range(0, ticks, 400):
        out[k : k + 400, :3] = np.array([0.62, 0.01, 0.86]) + rng.normal(scale=0.5, size=3)
        out[k : k + 400, 3:6], out[k : k + 400, 6:9] = rng.normal(scale=3.0, size=3), rng.normal(scale=20.0, size=3)
        out[k : k + 400, 9] = rng.random() < 0.8
    return out


@pytest.mark.parametrize("seed", range(3))
def test_arm_never_leaves_its_room_whatever_the_estimate_says(made, seed):
    """Nor its speed, nor does its place step: each tick it moves by no more than its speed allows."""
    p, s, e = made
    low, high = np.array([0.5, -0.02, 0.7]), np.array([0.7, 0.03, 0.95])
    p["room"], p["track_speed"] = [low, high], 0.4
    begin_track(e[0], p[0], s[0])
    places, speeds = [s["p"][0].copy()], []
    for row in wandering(seed, 12_000):
        e["plate"], e["plate_v"], e["plate_a"], e["plate_valid"] = row[:3], row[3:6], row[6:9], row[9]
        track(e[0], p[0], s[0])
        places.append(s["p"][0].copy())
        speeds.append(s["pv"][0].copy())
    assert (np.array(places) >= low).all()
    assert (np.array(places) <= high).all()
    assert np.abs(speeds).max() <= 0.4
    assert np.abs(np.diff(places, axis=0)).max() <= 0.4 * TICK_S + 1e-12
    # It is led to its walls, so that they are what holds it.
    np.testing.assert_allclose([np.min(places, axis=0), np.max(places, axis=0)], [low, high], atol=2e-3)


def test_plate_beyond_a_wall_is_followed_to_the_wall_and_back(made):
    p, s, e = made
    p["room"] = [[0.5, -0.02, 0.7], [0.7, 0.03, 0.95]]
    e["plate"][0, 1], e["plate_v"][0, 1] = 0.3, 0.5
    run(made, 3000)
    assert s["p"][0, 1] == pytest.approx(0.03, abs=1e-6)
    assert abs(s["pv"][0, 1]) < 1e-6
    e["plate"][0, 1], e["plate_v"][0, 1] = 0.01, 0.0
    assert run(made, 3000)[1] == pytest.approx(0.01, abs=1e-6)


def test_track_begins_inside_the_room(made):
    p, s, e = made
    p["room"] = [[0.5, -0.02, 0.7], [0.7, 0.03, 0.95]]
    e["plate"], e["plate_v"] = [0.9, 0.01, 0.86], [0.3, 2.0, -0.1]
    begin_track(e[0], p[0], s[0])
    np.testing.assert_array_equal(s["p"][0], [0.7, 0.01, 0.86])
    np.testing.assert_array_equal(s["pv"][0], [0.0, p["track_speed"][0], -0.1])
