"""What a UAV above a moving deck follows (K.2): the slow part of the station's motion, whatever the deck's velocity is biased by."""

import numpy as np
import pytest
from scipy.signal import lsim
from scipy.spatial.transform import Rotation

from armland.mission.reference.riding import deck_ahead, kept_layout, ride
from armland.models.environment import on_land

RATE, TICK_S, STATION = 8.0, 1e-3, np.array([0.6, 0.1, 0.9])


def ridden(omega, seconds, bias=0.0, heave=0.1, roll=0.0, late=0.0, ahead=1.0):
    """Ride for `seconds` on a deck that heaves by `heave`, m, and rolls by `roll`, rad, at `omega`, rad/s; all of it by tick.

    The UAV answers `late`, s.
    """
    s, e, rows = np.zeros(1, kept_layout()), on_land(), []
    e["moves"] = 1
    for t in np.arange(0.0, seconds, TICK_S):
        swing, rate, push = np.sin(omega * t), omega * np.cos(omega * t), -(omega**2) * np.sin(omega * t)
        R = Rotation.from_rotvec([roll * swing, 0.0, 0.0])
        e["base_quat"], e["gravity"] = R.as_quat(scalar_first=True), R.inv().apply([0.0, 0.0, -9.81])
        e["base_omega"], e["base_alpha"] = [roll * rate, 0.0, 0.0], [roll * push, 0.0, 0.0]
        e["base_v"], e["base_a"] = R.inv().apply([bias, 0.0, heave * rate]), R.inv().apply([0.0, 0.0, heave * push])
        ride(STATION, RATE, np.full(3, late), ahead, TICK_S, e[0], s[0])
        place = R.apply(STATION) + [0.0, 0.0, heave * swing]
        rows.append(
            np.concatenate(
                [place, s["apart"][0], s["aside"][0], s["aside_v"][0], s["aside_a"][0], s["a"][0], s["aside_lead"][0]]
            )
        )
    return np.array(rows)


@pytest.mark.parametrize("omega", [1.0, 20.0])
def test_k2_follows_the_low_pass_of_the_stations_motion(omega):
    """The oracle is scipy's solution of (3λ²s + λ³)/(s + λ)³ on the station's height: slow heave is followed, fast heave is not."""
    rows = ridden(omega, 12.0)
    height, followed = rows[:, 2] - STATION[2], rows[:, 2] - STATION[2] + rows[:, 5]
    t = np.arange(len(height)) * TICK_S
    _, expected, _ = lsim(([3.0 * RATE**2, RATE**3], np.poly([-RATE] * 3)), height, t)
    late = t > 6.0
    # Reckoned by tick it is within what the deck moves in one and a half.
    np.testing.assert_allclose(followed[late], expected[late], atol=1.5 * TICK_S * omega * 0.1)
    left = np.ptp(followed[late]) / np.ptp(height[late])
    assert left > 0.95 if omega < RATE else left < 0.5


def test_without_prediction_the_acceleration_is_that_of_now():
    """Negative control: a UAV that answers 0.2 s late is asked for what the deck will do then, and that is not what it does now."""
    now, ahead = ridden(2.0, 6.0, late=0.2, ahead=0.0), ridden(2.0, 6.0, late=0.2)
    # Upwards, on a deck that only heaves, what is led is ā less the change of what is apparent.
    np.testing.assert_allclose(now[:, 18:21], now[:, 12:15], atol=1e-12)
    assert np.abs(ahead[:, 18:21] - ahead[:, 12:15]).max() > 0.05
    np.testing.assert_array_equal(now[:, :15], ahead[:, :15])


def test_biased_velocity_moves_nothing():
    rows = ridden(1.0, 8.0, bias=0.02, heave=0.0)
    np.testing.assert_allclose(rows[-1, 3:6], 0.0, atol=1e-4)


def test_seen_from_the_deck_the_motion_is_that_of_what_is_followed():
    """ḋ and d̈ against differences of d on a deck that rolls and heaves; the inertial acceleration in K.1, d̈ − γ + g, is Rᵀā."""
    rows = ridden(3.0, 6.0, roll=0.05)
    aside, v, a = rows[3000:, 6:9], rows[3000:, 9:12], rows[3000:, 12:15]
    np.testing.assert_allclose(np.gradient(aside, TICK_S, axis=0)[5:-5], v[5:-5], atol=1e-3)
    np.testing.assert_allclose(np.gradient(v, TICK_S, axis=0)[5:-5], a[5:-5], atol=5e-3)
    assert np.abs(a).max() > 0.05


def test_k3_platform_that_swings_faster_than_the_uav_answers_is_hardly_followed():
    """λ = λ₀/(1 + (ω τ)²): at 10 rad/s and 0.17 s it is 2.06 rad/s, and what is followed is (K.2)'s share with that λ."""
    omega, late = 10.0, 0.17
    rows, t = ridden(omega, 30.0, heave=0.03, late=late), np.arange(0.0, 30.0, TICK_S)
    rate = RATE / (1.0 + (omega * late) ** 2)
    share = abs((3.0 * rate**2 * 1j * omega + rate**3) / (1j * omega + rate) ** 3)
    followed = rows[:, 2] - STATION[2] + rows[:, 5]
    late_on = t > 25.0
    assert np.ptp(followed[late_on]) / 0.06 == pytest.approx(share, rel=0.1)
    # A hull is followed nearly as closely as by a UAV that is never late.
    apart = [np.abs(ridden(1.5, 12.0, late=by)[8000:, 5]).max() for by in (0.0, late)]
    assert apart[0] < apart[1] < 1.2 * apart[0]


def test_acceleration_that_is_asked_for_is_the_one_of_when_the_uav_answers():
    """ā + τ ā˙ against ā of τ later; without the lead it is further off by more than three times."""
    late, after = 0.1, 100
    rows = ridden(2.0, 10.0, late=late)
    now, then = rows[5000:-after, 17], rows[5000 + after :, 17]
    asked = now + rows[5000:-after, 20] - rows[5000:-after, 14]
    error, without = np.abs(asked - then).max(), np.abs(now - then).max()
    assert error < without / 3.0


def levels(omega, late, roll=0.05, seconds=20.0):
    """Roll of the deck and of the level (K.4), rad, by tick, on a deck that rolls about a mean of 0.03 rad."""
    s, e, rows = np.zeros(1, kept_layout()), on_land(), []
    e["moves"] = 1
    for t in np.arange(0.0, seconds, TICK_S):
        angle, rate, push = (
            0.03 + roll * np.sin(omega * t),
            roll * omega * np.cos(omega * t),
            -roll * omega**2 * np.sin(omega * t),
        )
        R = Rotation.from_rotvec([angle, 0.0, 0.0])
        e["base_quat"], e["gravity"] = R.as_quat(scalar_first=True), R.inv().apply([0.0, 0.0, -9.81])
        e["base_omega"], e["base_alpha"] = [rate, 0.0, 0.0], [push, 0.0, 0.0]
        e["base_v"], e["base_a"] = 0.0, 0.0
        ride(STATION, RATE, np.full(3, late), 1.0, TICK_S, e[0], s[0])
        level = Rotation.from_quat(deck_ahead(late, e[0], s[0]), scalar_first=True).as_rotvec()
        rows.append([angle, level[0]])
    return np.array(rows)


@pytest.mark.parametrize(("omega", "apart", "alone"), [(2.0, 0.25, 0.33), (10.0, 1.2, 1.45)])
def test_k4_uav_that_answers_late_stands_on_the_deck(omega, apart, alone):
    """The UAV has the level `late` later. At 2 rad/s it leans against the deck by less than a quarter of the roll, at 10 rad/s by no
    more than one that does not turn; told the deck's attitude of now, by 2 sin(ωτ/2) of it: by a third, and by half as much again."""
    late, after, roll = 0.17, 170, 0.05
    rows = levels(omega, late)[12000:]
    deck, level = rows[after:, 0], rows[:-after, 1]
    assert np.abs(level - deck).max() < apart * roll
    assert np.abs(rows[:-after, 0] - deck).max() > alone * roll
    # A list is no swing: it is followed. Over whole periods.
    assert np.mean(level[-round(2000.0 * np.pi) :]) == pytest.approx(0.03, abs=2e-3)
