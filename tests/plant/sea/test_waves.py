"""The deck in waves: published-size motions of small hulls, the spectrum that goes in, and how waves spread and meet the hull."""

import numpy as np
import pytest
from scipy.signal import welch

from armland.plant.sea.hull import contour
from armland.plant.sea.spectra import bretschneider
from armland.plant.sea.waves import drawn_waves, spreading, wave_motion

# Significant single amplitudes of heave m, heave speed m/s, pitch and pitch speed in degrees; head sea, long-crested.
TABLE = {
    (2.0, "ss2"): (0.15, 0.20, 2.1, 5.6),
    (2.0, "ss3"): (0.44, 0.49, 4.7, 11.8),
    (2.0, "ss4"): (0.94, 0.91, 7.7, 18.5),
    (4.0, "ss2"): (0.14, 0.18, 1.8, 3.8),
    (4.0, "ss3"): (0.43, 0.47, 4.1, 8.0),
    (4.0, "ss4"): (0.93, 0.88, 6.8, 12.7),
    (8.0, "ss2"): (0.14, 0.16, 1.4, 2.4),
    (8.0, "ss3"): (0.41, 0.43, 3.3, 5.3),
    (8.0, "ss4"): (0.91, 0.82, 5.7, 8.5),
}


def head_sea(landing, **sea):
    return wave_motion(landing(sea={"state": "ss3", "crests": "long", "towards_deg": 180.0, **sea}))


def faster(motion):
    return motion._replace(amplitude=1j * motion.omega[:, None] * motion.amplitude)


@pytest.mark.parametrize(("hull", "state"), TABLE)
def test_small_hulls_move_as_the_table_says(landing, hull, state):
    motion = head_sea(landing, state=state, hull_m=hull)
    size, speed = motion.significant(), faster(motion).significant()
    found = (size[2], speed[2], *np.rad2deg([size[4], speed[4]]))
    # As exact as the table's figures; half a unit of the last one.
    np.testing.assert_allclose(found, TABLE[hull, state], atol=0.07, rtol=0.02)
    assert found[0] == pytest.approx(TABLE[hull, state][0], abs=0.007)
    assert size[[1, 3, 5]] == pytest.approx(0.0, abs=1e-12)


def test_spectrum_of_the_deck_is_that_of_the_sea_through_the_hull(landing):
    """Welch's estimate over twelve seas against S |H|² at the peak and beyond it: within 10 %, the scatter of so many bands."""
    rate, powers = 4.0, []
    for seed in range(12):
        scenario = landing(sea={"state": "ss3", "crests": "long", "towards_deg": 180.0}).with_seed(seed)
        q = wave_motion(scenario).sampled(rate, 0, 20000)
        f, p = welch(q[:, [2, 4]], fs=rate, nperseg=512, axis=0)
        powers.append(p)
    omega, power = 2.0 * np.pi * f[1:], np.mean(powers, axis=0)[1:] / (2.0 * np.pi)
    H = contour(omega, np.full_like(omega, np.pi), 4.0, 1.6)[:, [2, 4]]
    theory = bretschneider(omega, 0.88, 7.5)[:, None] * np.abs(H) ** 2
    for low, high in ((0.65, 0.8), (0.8, 1.0), (1.0, 1.4), (1.4, 2.0), (2.0, 3.0)):
        band = (omega >= low) & (omega < high)
        np.testing.assert_allclose(power[band].sum(axis=0), theory[band].sum(axis=0), rtol=0.1)


def test_each_sea_has_the_height_that_was_asked_for(landing):
    """A hull that is a cork heaves as the sea does: 2 √m₀ = H_s/2."""
    for crests in ("long", "short"):
        motion = wave_motion(landing(sea={"height_m": 0.5, "period_s": 5.0, "hull_m": 0.5, "crests": crests}))
        assert motion.significant()[2] == pytest.approx(0.25, rel=0.01)


def test_waves_spread_as_cos_squared():
    """Mean of cos²θ over D is 3/4, of sin²θ 1/4, and both sides are alike."""
    theta = spreading(np.random.default_rng(1))
    assert [np.mean(np.cos(theta) ** 2), np.mean(np.sin(theta) ** 2), np.mean(np.sin(theta))] == pytest.approx(
        [0.75, 0.25, 0.0], abs=0.01
    )


def test_short_crested_head_sea_rolls_the_hull_too(landing):
    long, short = head_sea(landing), head_sea(landing, crests="short")
    assert long.significant()[3] < 1e-12
    assert 0.4 < short.significant()[3] / short.significant()[4] < 1.5
    assert short.significant()[4] < long.significant()[4]


def test_hull_meets_a_head_sea_faster_and_a_following_one_slower(landing):
    """ω_e = ω − k U cos χ: at 2 m/s against waves of 1 rad/s 1.204, with them 0.796."""
    still = head_sea(landing)
    near = int(np.argmin(np.abs(still.omega - 1.0)))
    for towards, way in ((180.0, 1.0), (0.0, -1.0)):
        omega = head_sea(landing, towards_deg=towards, speed_mps=2.0).omega
        assert omega[near] == pytest.approx(still.omega[near] + way * 2.0 * still.omega[near] ** 2 / 9.81)
    assert still.omega[near] == pytest.approx(1.0, abs=0.01)


def test_seed_draws_phases_and_direction_and_nothing_else_does(landing):
    one, other = (landing(sea={"state": "ss2"}).with_seed(seed) for seed in (1, 2))
    np.testing.assert_array_equal(wave_motion(one).amplitude, wave_motion(one).amplitude)
    assert not np.allclose(wave_motion(one).amplitude, wave_motion(other).amplitude)
    noisy = wave_motion(one.replaced({"deviation": {"level": "harsh"}}))
    np.testing.assert_array_equal(noisy.amplitude, wave_motion(one).amplitude)


@pytest.mark.parametrize("seed", [1, 2])
def test_hull_follows_the_water_that_is_drawn(landing, seed):
    """Heave and pitch of a contour hull are mean and slope of the water over its waterline, put together here from points."""
    scenario = landing(sea={"state": "ss3"}).with_seed(seed)
    waves, motion = drawn_waves(scenario), wave_motion(scenario)
    x, y = (np.linspace(-h, h, 41) for h in (2.0, 0.8))
    for t in (0.0, 3.7):
        water, q = waves.elevation(t, x, y), motion.at(np.array([t]))[0]
        assert water.mean() == pytest.approx(q[2], abs=2e-3)
        # Bow down is positive pitch.
        assert -np.polyfit(x, water.mean(axis=1), 1)[0] == pytest.approx(q[4], abs=3e-3)
    assert abs(waves.elevation(0.0, x, y).mean() - motion.at(np.array([3.7]))[0, 2]) > 2e-3
