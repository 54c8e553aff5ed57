"""The platform's pose that cancels a hull's motion, and what its legs can follow of it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.control.laws.unaided.compensation import follow_length, wanted
from armland.models.unaided.hexapod import attitude

MIDDLE = np.array([0.62, 0.0, 0.45])
LIMITS = np.array([0.3, 0.6, 0.5, 5.0, 40.0])
STILL = np.zeros(3)
TICK = 1e-3


@pytest.mark.parametrize("angles", [(0.3, 0.1, -0.08), (-1.2, -0.05, 0.15)])
def test_eq_c1_holds_the_platform_level(angles):
    hull = Rotation.from_euler("ZYX", angles)
    x, _ = wanted(hull.as_quat(scalar_first=True), STILL, STILL, MIDDLE, np.zeros(3), (TICK, 2.0, 9.0))
    held = hull.as_matrix() @ attitude(x)
    np.testing.assert_allclose(held[:, 2], [0.0, 0.0, 1.0], atol=1e-12)
    np.testing.assert_allclose(x[:3], 0.0, atol=1e-12)


def test_eq_c1_rate_is_the_derivative_of_the_pose():
    # A hull that heaves and rolls; the pose's rate against differences of the pose.
    moved, poses, rates = np.zeros(3), [], []
    for k in range(3000):
        t = k * TICK
        roll, rate = 0.1 * np.sin(1.5 * t), np.array([0.15 * np.cos(1.5 * t), 0.0, 0.0])
        quat = Rotation.from_euler("x", roll).as_quat(scalar_first=True)
        v = Rotation.from_euler("x", -roll).apply([0.02, -0.03, 0.3 * np.cos(1.2 * t)])
        x, x_rate = wanted(quat, rate, v, MIDDLE, moved, (TICK, 2.0, 0.12))
        poses.append(x)
        rates.append(x_rate)
    measured = np.diff(poses, axis=0) / TICK
    np.testing.assert_allclose(measured[1000:], np.array(rates)[1001:], atol=2e-3)


def test_eq_c1_gives_up_way_and_not_attitude():
    moved = np.array([0.0, 0.3, 0.9])
    quat = Rotation.from_euler("y", 0.1).as_quat(scalar_first=True)
    x, _ = wanted(quat, STILL, STILL, MIDDLE, moved, (TICK, 2.0, 0.12))
    assert np.linalg.norm(x[:3]) == pytest.approx(0.12, rel=1e-3)
    assert x[4] == pytest.approx(-0.1)


@pytest.mark.parametrize("omega", [1.0, 2.0])
def test_eq_c1_cancels_of_a_swing_what_its_fading_leaves(omega):
    # Heave of amplitude A: h behind the fading has the amplitude A ωT/√(1 + ω²T²).
    fade, amplitude, moved, found = 1.5, 0.1, np.zeros(3), []
    for k in range(20_000):
        v = np.array([0.0, 0.0, amplitude * omega * np.cos(omega * k * TICK)])
        x, _ = wanted(np.array([1.0, 0.0, 0.0, 0.0]), STILL, v, MIDDLE, moved, (TICK, fade, 9.0))
        found.append(x[2])
    share = omega * fade / np.sqrt(1.0 + (omega * fade) ** 2)
    assert max(found[10_000:]) == pytest.approx(amplitude * share, rel=0.01)


def led(l_d, speed_d, seconds, l=0.45, speed=0.0):
    track = []
    for k in range(round(seconds / TICK)):
        speed = follow_length(l, speed, l_d(k * TICK), speed_d(k * TICK), LIMITS, TICK)
        l += speed * TICK
        track.append((l, speed))
    return np.array(track)


def test_eq_c2_follows_a_slow_swing():
    track = led(lambda t: 0.45 + 0.05 * np.sin(2.0 * t), lambda t: 0.1 * np.cos(2.0 * t), 6.0)
    t = TICK * np.arange(1, len(track) + 1)
    assert np.abs(track[2000:, 0] - (0.45 + 0.05 * np.sin(2.0 * t[2000:]))).max() < 5e-4


def test_eq_c2_keeps_speed_acceleration_and_stroke():
    track = led(lambda t: 0.9 if t < 1.5 else 0.1, lambda t: 0.0, 3.0)
    assert track[:, 0].max() <= LIMITS[1] + 5e-4
    assert track[:, 0].min() >= LIMITS[0] - 5e-4
    assert np.abs(track[:, 1]).max() <= LIMITS[2] + 1e-9
    assert np.abs(np.diff(track[:, 1])).max() <= LIMITS[3] * TICK + 1e-9
    # It does go to both ends.
    assert track[:, 0].max() > LIMITS[1] - 2e-3
    assert track[:, 0].min() < LIMITS[0] + 2e-3


def test_without_its_limits_it_would_not():
    free = np.array([0.0, 9.0, 1e6, 1e6, 40.0])
    l, speed, fastest = 0.45, 0.0, 0.0
    for _ in range(300):
        speed = follow_length(l, speed, 0.9, 0.0, free, TICK)
        l += speed * TICK
        fastest = max(fastest, speed)
    assert fastest > LIMITS[2]
    assert l > LIMITS[1]
