"""The air: a steady wind pushes by the drag, gusts keep their size whatever the step, rotors near the ground give more."""

import numpy as np
import pytest

from armland.plant.devices.air import BELOW_M, BESIDE_M, OVER_RAILS, blow, gain, kept_layout, told_layout, wash
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
    blow(told[0], kept[0], fails[0], np.broadcast_to(np.float64(noise), 3).copy(), truth[0])
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


@pytest.mark.parametrize(
    ("radii", "ratio"), [(1.0, 16.0 / 15.0), (2.0, 64.0 / 63.0), (0.5, 4.0 / 3.0), (0.1, 4.0 / 3.0)]
)
def test_thrust_near_the_ground_is_cheeseman_and_bennetts(radii, ratio):
    """1/(1 − (R/4z)²): 1.067 at one radius; below half a radius, where it no longer holds, no more than there."""
    assert 1.0 + gain(radii * R, R) == pytest.approx(ratio, rel=1e-12)


def test_gain_far_from_the_ground_is_none():
    assert gain(100.0 * R, R) < 1e-5


@pytest.mark.parametrize(("share", "rails"), [(1.0, -np.inf), (0.5, -np.inf), (1.0, 0.3)])
def test_ground_and_rails_lift_by_their_shares(air, share, rails):
    air[0]["ground"], air[0]["rails"], air[3]["r_cm"] = share, rails, [0.0, 0.0, 0.3 + R]
    wanted = 1.0 + share * (gain(0.3 + R, R) + (OVER_RAILS / 15.0 if np.isfinite(rails) else 0.0))
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


@pytest.mark.parametrize(
    ("beside", "below", "pressed"),
    [
        (0.0, 0.1, True),
        (0.99 * BESIDE_M, 0.1, True),
        (1.01 * BESIDE_M, 0.1, False),
        (0.0, 1.01 * BELOW_M, False),
        (0.0, -0.1, False),
    ],
)
def test_downwash_presses_on_a_tool_below_the_uav_and_nowhere_else(air, beside, below, pressed):
    told, _, _, truth = air
    told["wash"], applied = 0.03, np.ones(6)
    truth["r_cm"], truth["ee"] = [0.6, 0.0, 1.0], [0.6 + 0.6 * beside, 0.8 * beside, 1.0 - below]
    wash(told[0], 5.0, truth[0], applied)
    np.testing.assert_allclose(applied, [1.0, 1.0, 1.0 - (0.15 if pressed else 0.0), 1.0, 1.0, 1.0])
