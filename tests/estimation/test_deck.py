"""What the controller makes of the motion reference: the environment of now from a late sample, and the UAV against the deck."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.estimation.deck import as_sent, kept_layout, know_deck, turn_into_deck
from armland.estimation.deck import told as told_of
from armland.models.environment import on_land
from armland.records import layout
from armland.scenario import load_scenario

DOWN = np.array([0.0, 0.0, -9.81])


def attitude(t, pace=1.0):
    t = pace * t
    return Rotation.from_euler("ZYX", [0.02 * np.sin(0.7 * t), 0.07 * np.sin(1.3 * t + 0.4), 0.1 * np.sin(2.0 * t)])


def rates(t, pace=1.0, h=1e-5):
    return (attitude(t - h, pace).inv() * attitude(t + h, pace)).as_rotvec() / (2.0 * h)


def place(t):
    return np.array([0.1 * np.sin(2.0 * t), 0.05 * np.cos(3.0 * t), 0.2 * np.sin(1.5 * t)])


def along(t, pace=1.0, h=1e-4):
    """Velocity and acceleration of the deck's origin in its own axes, by differences."""
    R = attitude(t, pace).inv()
    return R.apply((place(t + h) - place(t - h)) / (2.0 * h)), R.apply(
        (place(t + h) - 2.0 * place(t) + place(t - h)) / h**2
    )


@pytest.fixture
def told():
    """Feed samples, 10 ms apart and 10 ms late, and look at the environment after `seconds`."""

    p = told_of(load_scenario("landing"))

    def feed(seconds=2.0, known=1, pace=1.0):
        m, s, e = np.zeros(1, layout("measurement", 7)), np.zeros(1, kept_layout()), on_land()
        for k in range(round(1000 * seconds)):
            taken = max(k - 10, 0) // 10 * 10
            t = taken / 1000.0
            m["tick"], m["deck_tick"], m["deck_known"] = k, taken, known
            m["deck_quat"] = attitude(t, pace).as_quat(scalar_first=True)
            m["deck_rate"], (m["deck_v"], m["deck_a"]) = rates(t, pace), along(t, pace)
            know_deck(m[0], DOWN, 1e-3, p[0], s[0], e[0])
        return m, e, (round(1000 * seconds) - 1) / 1000.0

    return feed


def test_environment_is_that_of_now(told):
    m, e, now = told()
    turned = Rotation.from_quat(e["base_quat"][0], scalar_first=True)
    late = Rotation.from_quat(m["deck_quat"][0], scalar_first=True)
    # The sample alone would be 14 ms late: at 0.2 rad/s that is 3 mrad.
    assert (late.inv() * attitude(now)).magnitude() > 1e-3
    assert (turned.inv() * attitude(now)).magnitude() < 5e-5
    np.testing.assert_allclose(e["base_omega"][0], rates(now), atol=2e-4)
    np.testing.assert_allclose(e["gravity"][0], attitude(now).inv().apply(DOWN), atol=1e-3)
    v, a = along(now)
    np.testing.assert_allclose(e["base_v"][0], v, atol=3e-4)
    np.testing.assert_allclose(e["base_a"][0], a, atol=4e-3)
    # As it came, 19 ms old, each would be further off.
    assert np.abs(m["deck_v"][0] - v).max() > 3e-3
    assert np.abs(m["deck_a"][0] - a).max() > 1e-2
    alpha = (rates(now + 1e-3) - rates(now - 1e-3)) / 2e-3
    np.testing.assert_allclose(e["base_alpha"][0], alpha, atol=0.01)


def test_platform_that_rolls_twice_a_second_has_its_angular_acceleration(told):
    """Five times as fast, up to 10 rad/s²: within a sixth, where differences behind a low pass of 30 ms were wrong by half."""
    worst = [0.0, 0.0]
    for seconds in np.arange(2.0, 2.6, 0.05):
        _, e, now = told(seconds, pace=5.0)
        alpha = (rates(now + 1e-3, 5.0) - rates(now - 1e-3, 5.0)) / 2e-3
        worst = np.maximum(worst, [np.abs(e["base_alpha"][0] - alpha).max(), np.abs(alpha).max()])
    assert worst[0] < worst[1] / 6.0


def test_without_motion_reference_nothing_is_known(told):
    _, e, _ = told(0.1, known=0)
    assert e.tobytes() == on_land(tuple(DOWN)).tobytes()


def test_uav_is_turned_into_the_deck_at_the_tick_of_its_sample(told):
    """q_DB = q_b⁻¹ q_WB, both 25 ms ago; rates less the deck's. A level UAV at rest seems to turn against the deck."""
    m, e, now = told()
    then, uav = now - 0.025, Rotation.from_euler("ZYX", [0.3, 0.02, -0.05])
    m["uav_tick"], m["uav_quat"] = round(1000 * then), uav.as_quat(scalar_first=True)
    turn_into_deck(m[0], e[0], 1e-3)
    expected = attitude(then).inv() * uav
    found = Rotation.from_quat(m["uav_quat"][0], scalar_first=True)
    assert (expected.inv() * found).magnitude() < 5e-5
    np.testing.assert_allclose(m["uav_rate"][0], -expected.inv().apply(rates(then)), atol=2e-3)


def test_sample_is_turned_once(told):
    """The measurement keeps what was turned; before the next tick it is put back, unless a new sample has come."""
    m, e, _ = told(0.5)
    good = m.copy()
    raw = Rotation.from_euler("ZYX", [0.3, 0.0, 0.1]).as_quat(scalar_first=True)
    m["uav_tick"], m["uav_quat"], good["uav_tick"], good["uav_quat"], good["tick"] = 480, raw, 480, raw, 500
    for _ in range(3):
        as_sent(m[0], good[0])
        np.testing.assert_array_equal(m["uav_quat"][0], raw)
        turn_into_deck(m[0], e[0], 1e-3)
        assert not np.allclose(m["uav_quat"][0], raw)
    m["uav_tick"], m["uav_quat"] = 490, [0.0, 1.0, 0.0, 0.0]
    as_sent(m[0], good[0])
    np.testing.assert_array_equal(m["uav_quat"][0], [0.0, 1.0, 0.0, 0.0])
