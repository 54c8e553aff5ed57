"""The air: a steady wind pushes by the drag, gusts keep their size whatever the step, rotors near the ground give more."""

from itertools import pairwise

import numpy as np
import pytest
from numba import njit
from scipy.signal import welch

from armland.plant.devices.air import (
    BELOW_RADII,
    OVER_RAILS,
    blow,
    gain,
    kept_layout,
    told_layout,
    wash,
)
from armland.plant.faults import table as faults
from armland.records import layout

R = 0.1


@pytest.fixture
def air(landing):
    """What the air is told and keeps, what fails, and the truth; still as yet."""
    fails = np.zeros(1, faults.kept_layout(7))
    told, kept, truth = np.zeros(1, told_layout(7)), np.zeros(1, kept_layout(7)), np.zeros(1, layout("truth", 7))
    told["moves"], told["radius"], told["rails"] = 1, R, -np.inf
    return told, kept, fails, truth


def step(air, noise=0.0):
    told, kept, fails, truth = air
    given = np.broadcast_to(np.float64(noise), 3).copy(), np.zeros(5), np.zeros(3)
    blow(told[0], kept[0], fails[0], given, truth[0])
    return kept


def test_steady_wind_pushes_a_uav_at_rest_by_its_drag(bench):
    """F = c v̄, horizontally; what the wind does upwards the rotors feel and not the hull."""
    b = bench(uav={"drag_nspm": 0.3})
    still = b.act(0)
    b.told["air"]["moves"], b.told["air"]["mean"] = 1, [2.0, -1.0, 0.0]
    np.testing.assert_allclose((b.act(1) - still)[:2], [0.6, -0.3], rtol=1e-9)


def test_uav_that_drifts_with_the_wind_feels_none(bench):
    b = bench(uav={"drag_nspm": 0.3})
    b.told["air"]["moves"], b.told["air"]["mean"], b.t["v_cm"] = 1, [2.0, -1.0, 0.0], [2.0, -1.0, 0.0]
    np.testing.assert_allclose(b.act(0)[:2], 0.0, atol=1e-12)


def test_still_air_leaves_everything_as_it_was(air):
    air[0]["moves"], air[0]["mean"], air[0]["sigma"], air[0]["ground"] = 0, 3.0, 2.0, 1.0
    kept = step(air, 1.0)
    np.testing.assert_array_equal(kept["velocity"], 0.0)
    assert kept["lift"] == 1.0


def test_wind_of_a_fault_comes_on_top(air):
    air[0]["mean"], air[2]["wind"] = [1.0, 0.0, 0.0], [0.0, 5.0, 0.0]
    np.testing.assert_array_equal(step(air)["velocity"][0], [1.0, 5.0, 0.0])
    air[0]["moves"] = 0
    np.testing.assert_array_equal(step(air)["velocity"][0], [0.0, 5.0, 0.0])


@pytest.mark.parametrize("rate_hz", [1000, 250, 20])
def test_gusts_have_their_variance_from_the_first_tick_on_whatever_the_step(air, rate_hz):
    """Linear in the noise: the variance is the sum of the squares of the answers to each tick's unit noise alone."""
    told, kept, ticks = air[0], air[1], 40
    told["sigma"], told["hold"] = [0.4, 0.4, 0.2], np.exp(-1.0 / rate_hz)
    answers = np.zeros((ticks, ticks, 3))
    for of in range(ticks):
        kept[:] = np.zeros_like(kept)
        for k in range(ticks):
            answers[of, k] = step(air, 1.0 if k == of else 0.0)["gust"][0]
    np.testing.assert_allclose((answers**2).sum(axis=0), np.tile([0.16, 0.16, 0.04], (ticks, 1)), rtol=1e-9)
    # Correlated by e^(−t/T) with T = 1 s.
    together = (answers[:, 0] * answers[:, -1]).sum(axis=0)
    np.testing.assert_allclose(together, np.array([0.16, 0.16, 0.04]) * np.exp(-(ticks - 1) / rate_hz), rtol=1e-9)


WIND = {"wind_mps": 8.0, "turbulence": "by_wind", "towards_deg": 0.0}
"""At the catch: 4.8 m/s; at 10 ft and below L = 23.05, 23.05, 3.048 m, σ = 1.570, 1.570, 0.8 m/s by hand from MIL-F-8785C."""

V, LENGTHS, SIGMA = 4.80, np.array([23.05, 23.05, 3.048]), np.array([1.570, 1.570, 0.8])


@pytest.fixture
def windy(air, landing, waiting):
    """What the air is told of a section `[air]` at a base rate, and all that `air` has; without mean wind of its own if `calm`."""
    from armland.plant.devices.air import tell

    def build(rate_hz=1000, calm=True, **keys):
        slow = {"rate_hz": 100}
        s = landing(air=WIND | keys, run={"rate_hz": rate_hz}, onboard=slow, link=slow, control={"station": slow})
        told = air[0]
        tell(told, s, waiting().sim.scene)
        if calm:
            told["speed"] = 0.0
        air[1][:] = np.zeros_like(air[1])
        air[3]["r_cm"] = [0.6, 0.0, 0.86]
        return air

    return build


def blown(air, fresh, known=(0.0, 0.0, 0.0)):
    """Velocities (k, 3) for the numbers `fresh` (k, 5)."""
    told, kept, fails, truth = air
    out = np.empty((len(fresh), 3))
    _blown(told, kept, fails, np.array(known), truth, fresh, out)
    return out


@njit
def _blown(told, kept, fails, known, truth, fresh, out):
    calm = np.zeros(3)
    for k in range(len(fresh)):
        blow(told[0], kept[0], fails[0], (calm, fresh[k], known), truth[0])
        out[k] = kept[0].velocity


def answers(air, ticks):
    """Of each tick to each of all numbers before it: (5 ticks, ticks, 3), linear in them."""
    out = np.zeros((5 * ticks, ticks, 3))
    for of, one in enumerate(out):
        fresh = np.zeros((ticks, 5))
        fresh.flat[of] = 1.0
        air[1][:] = np.zeros_like(air[1])
        one[:] = blown(air, fresh)
    return out


@pytest.mark.parametrize("rate_hz", [1000, 500, 200])
def test_turbulence_has_its_variance_and_correlation_from_the_first_tick_on_whatever_the_step(windy, rate_hz):
    """σ² at each tick; σ² e^(−Vτ/L) along the wind, σ² e^(−Vτ/L)(1 − Vτ/2L) across it and upwards (Batchelor's longitudinal and
    transverse functions). The variance is the sum of the squares of the answers to each number alone."""
    ticks = 60
    found = answers(windy(rate_hz), ticks)
    np.testing.assert_allclose((found**2).sum(axis=0), np.tile(SIGMA**2, (ticks, 1)), rtol=2e-3)
    np.testing.assert_allclose((found**2).sum(axis=0), np.tile((found[:, 0] ** 2).sum(axis=0), (ticks, 1)), rtol=1e-9)
    x = V * (ticks - 1) / rate_hz / LENGTHS
    correlation = np.exp(-x) * (1.0 - np.array([0.0, 0.5, 0.5]) * x)
    np.testing.assert_allclose((found[:, 0] * found[:, -1]).sum(axis=0) / SIGMA**2, correlation, atol=2e-3)
    # The components know nothing of one another.
    together = np.einsum("nki,nkj->kij", found, found)[-1]
    np.testing.assert_allclose(together - np.diag(np.diag(together)), 0.0, atol=1e-12)


def test_without_its_stationary_start_turbulence_would_be_calm_for_the_first_second(windy):
    """Negative control: states that begin at zero have after 0.2 s less than half of the variance along the wind."""
    air = windy(200)
    found = np.zeros((5 * 40, 3))
    for of in range(len(found)):
        fresh = np.zeros((40, 5))
        fresh.flat[of] = 1.0
        air[1][:] = np.zeros_like(air[1])
        air[1]["begun"] = 1
        found[of] = blown(air, fresh)[-1]
    assert ((found**2).sum(axis=0)[:2] < 0.5 * SIGMA[:2] ** 2).all()


def published_spectrum(frequency):
    """One-sided spectra (k, 3), (m/s)²/Hz, of MIL-F-8785C at `frequency` (k,), Hz, as a field at V sees them pass."""
    x = (2.0 * np.pi * frequency[:, None] * LENGTHS / V) ** 2
    shape = (1.0 + np.array([0.0, 3.0, 3.0]) * x) / (1.0 + x) ** np.array([1.0, 2.0, 2.0])
    return 4.0 * np.array([1.0, 0.5, 0.5]) * SIGMA**2 * LENGTHS / V * shape


def test_spectrum_is_the_published_one(windy):
    """Welch's estimate of 12 hours, in six bands from 0.05 to 6 Hz, within 3 % for each component."""
    rate, hours, power = 200, 12, 0.0
    air, generator = windy(rate), np.random.default_rng(1)
    for _ in range(hours):
        wind = blown(air, generator.standard_normal((3600 * rate, 5)))
        frequency, found = welch(wind, rate, nperseg=100 * rate, axis=0, detrend=False)
        power = power + found / hours
    edges = (0.05, 0.2, 0.4, 0.8, 1.6, 3.2, 6.0)
    for low, high in pairwise(edges):
        band = (frequency >= low) & (frequency < high)
        ratio = power[band] / published_spectrum(frequency[band])
        np.testing.assert_allclose(ratio.mean(axis=0), 1.0, atol=0.03)


def test_variance_over_seeds_in_the_first_second_is_that_of_theory(windy):
    """20 000 seeds, mean square over the first second within 3 % for each component."""
    air, generator, power = windy(200), np.random.default_rng(2), np.zeros(3)
    seeds = 20_000
    for _ in range(seeds):
        air[1][:] = np.zeros_like(air[1])
        power += (blown(air, generator.standard_normal((200, 5))) ** 2).mean(axis=0) / seeds
    np.testing.assert_allclose(power, SIGMA**2, rtol=0.03)


@pytest.mark.parametrize("towards", [0.0, 90.0, 37.0])
def test_axes_of_turbulence_are_the_mean_winds_and_not_the_bodys(windy, towards):
    c, s = np.cos(np.deg2rad(towards)), np.sin(np.deg2rad(towards))
    fresh = np.random.default_rng(3).standard_normal((20, 5))
    own = blown(windy(calm=False), fresh)
    air = windy(calm=False, towards_deg=towards)
    air[3]["quat"] = [0.5, 0.5, 0.5, 0.5]
    turned = blown(air, fresh)
    np.testing.assert_allclose(turned, own @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]), atol=1e-12)


def test_mean_wind_follows_the_uavs_height_and_turbulence_does_not(windy):
    """At 20 ft W20; at the catch ln(0.86/z₀)/ln(6.096/z₀) of it."""
    air, still = windy(calm=False, turbulence="none"), np.zeros((1, 5))
    at_catch = blown(air, still)[0]
    np.testing.assert_allclose(at_catch, [8.0 * np.log(0.86 / 0.04572) / np.log(6.096 / 0.04572), 0.0, 0.0], rtol=1e-6)
    air[3]["r_cm"] = [0.6, 0.0, 6.096]
    np.testing.assert_allclose(blown(air, still)[0], [8.0, 0.0, 0.0], rtol=1e-9)
    air, fresh = windy(), np.random.default_rng(4).standard_normal((1, 5))
    low = blown(air, fresh)
    air[1][:] = np.zeros_like(air[1])
    air[3]["r_cm"] = [0.6, 0.0, 6.096]
    np.testing.assert_array_equal(blown(air, fresh), low)


def test_strength_follows_the_wind_at_20_feet_or_its_name(windy):
    """Wind of 8 m/s at 2 m is one of 10.36 m/s at 20 ft; moderate is W20 = 30 kt whatever the wind."""
    w20 = 8.0 * np.log(6.096 / 0.04572) / np.log(2.0 / 0.04572)
    assert windy(reference_m=2.0)[0]["strength"][0, 2] == pytest.approx(0.1 * w20, rel=1e-9)
    assert windy(turbulence="moderate")[0]["strength"][0, 2] == pytest.approx(0.1 * 30.0 * 0.514444, rel=1e-6)


def test_known_wind_and_that_of_a_deviation_come_on_top(windy):
    air = windy(turbulence="none")
    air[0]["mean"] = [1.0, 2.0, 0.0]
    np.testing.assert_allclose(blown(air, np.zeros((2, 5)), known=(0.1, 0.2, 0.3)), [[1.1, 2.2, 0.3]] * 2)


@pytest.mark.parametrize(
    ("radii", "ratio"), [(1.0, 16.0 / 15.0), (2.0, 64.0 / 63.0), (0.5, 4.0 / 3.0), (0.1, 4.0 / 3.0)]
)
def test_thrust_near_the_ground_is_cheeseman_and_bennetts(radii, ratio):
    """1/(1 − (R/4z)²): 1.067 at one radius; below half a radius, where it no longer holds, no more than there."""
    assert 1.0 + gain(radii * R, R) == pytest.approx(ratio, rel=1e-12)


def test_gain_far_from_the_ground_is_none():
    assert gain(100.0 * R, R) < 1e-5


@pytest.mark.parametrize(
    ("share", "rails", "over"), [(1.0, -np.inf, 0.0), (0.5, -np.inf, 0.0), (1.0, 0.3, OVER_RAILS), (1.0, 0.3, 1.0)]
)
def test_ground_and_what_stands_on_it_lift_by_their_shares(air, share, rails, over):
    """Of rails a share of the discs counts, of a pad the whole."""
    told, height = air[0], 0.3 + R
    told["ground"], told["rails"], told["over"], air[3]["r_cm"] = share, rails, over, [0.0, 0.0, height]
    wanted = 1.0 + share * (gain(height, R) + over / 15.0)
    assert step(air)["lift"][0] == pytest.approx(wanted, rel=1e-12)


def test_rotors_near_the_ground_really_give_more(bench):
    b = bench()
    b.told["rotors"]["inflow"], b.t["r_cm"] = 0, [0.0, 0.0, R]
    free = b.act(0)[2]
    b.told["air"]["moves"], b.told["air"]["ground"], b.told["air"]["radius"], b.told["air"]["rails"] = (
        1,
        1.0,
        R,
        -np.inf,
    )
    assert b.act(1)[2] / free == pytest.approx(16.0 / 15.0, rel=1e-6)


HUB = 0.12


@pytest.mark.parametrize(
    ("beside", "below", "share"),
    [
        (0.0, 2.0 * R, 1.0),
        (HUB - 0.51 * R, 2.0 * R, 1.0),
        (HUB, 2.0 * R, 0.5),
        (HUB + 0.51 * R, 2.0 * R, 0.0),
        (0.0, BELOW_RADII * R, 0.5),
        (0.0, (BELOW_RADII + 0.51) * R, 0.0),
        (0.0, -0.01, 0.0),
    ],
)
def test_downwash_presses_on_a_tool_below_the_rotors_and_nowhere_else(air, beside, below, share):
    assert pressed(air, beside, below) == pytest.approx(0.15 * share, abs=1e-12)


def test_a_uav_that_drifts_changes_its_downwash_by_no_step(air):
    """A step would be taken for one of the force sensor's scale."""
    for across in (lambda x: (x, 2.0 * R), lambda x: (0.0, x)):
        forces = [pressed(air, *across(x)) for x in np.arange(0.0, 0.8, 1e-3)]
        assert max(forces) == pytest.approx(0.15)
        assert min(forces) == pytest.approx(0.0, abs=1e-12)
        assert np.abs(np.diff(forces)).max() < 0.011 * 0.15


def pressed(air, beside, below):
    """Force on the tool, N, downwards."""
    told, _, _, truth = air
    told["wash"], told["beside"], applied = 0.03, HUB, np.ones(6)
    truth["r_cm"], truth["ee"] = [0.6, 0.0, 1.0], [0.6 + 0.6 * beside, 0.8 * beside, 1.0 - below]
    wash(told[0], 5.0, truth[0], applied)
    np.testing.assert_array_equal(applied[[0, 1, 3, 4, 5]], 1.0)
    return 1.0 - applied[2]
