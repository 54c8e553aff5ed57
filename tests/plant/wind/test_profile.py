"""Mean wind over height, and where it blows to."""

import numpy as np
import pytest

from armland.plant.wind.dryden import SLOWEST_MPS
from armland.plant.wind.profile import W20_AT_M, height_of_catch, passing_speed, speed_at, towards


def test_logarithmic_wind_is_that_of_the_source_for_landing(landing):
    """MIL-F-8785C with z₀ = 0.15 ft: at 3 ft ln 20/ln 133.3 = 0.612 of the wind at 20 ft, which is W20; none at z₀."""
    s = landing(air={"wind_mps": 8.0})
    assert speed_at(s, 20.0 * 0.3048) == pytest.approx(8.0, rel=1e-12)
    assert speed_at(s, 3.0 * 0.3048) == pytest.approx(8.0 * 0.6122, rel=1e-3)
    assert speed_at(s, 0.0457) == pytest.approx(0.0, abs=1e-2)
    assert speed_at(s, 0.01) == speed_at(s, 0.0) == speed_at(s, -1.0) == 0.0


def test_power_law_and_even_wind(landing):
    s = landing(air={"wind_mps": 8.0, "profile": "power", "exponent": 1.0 / 7.0, "reference_m": 12.8})
    assert [speed_at(s, h) for h in (12.8, 0.1, 0.0)] == pytest.approx([8.0, 4.0, 0.0])
    even = landing(air={"wind_mps": 8.0, "profile": "even"})
    assert speed_at(even, 0.01) == speed_at(even, 100.0) == 8.0


def test_wind_given_at_another_height_than_20_feet_is_a_stronger_one_there(landing):
    """8 m/s at 2 m are 8 ln 133.3/ln 43.7 at 20 ft."""
    s = landing(air={"wind_mps": 8.0, "reference_m": 2.0})
    assert speed_at(s, W20_AT_M) == pytest.approx(8.0 * np.log(133.333) / np.log(2.0 / 0.04572), rel=1e-5)


def test_the_worlds_floor_may_stand_above_the_sea(landing):
    low, high = (landing(air={"wind_mps": 8.0, "floor_m": f}) for f in (0.0, 3.0))
    assert height_of_catch(high) == height_of_catch(low) + 3.0
    assert passing_speed(high) == pytest.approx(speed_at(low, height_of_catch(low) + 3.0))


@pytest.mark.parametrize("wind", [0.0, 0.5])
def test_field_that_hardly_moves_passes_at_the_least_speed(landing, wind):
    s = landing(air={"wind_mps": wind, "turbulence": "light"})
    assert passing_speed(s) == SLOWEST_MPS
    assert passing_speed(landing(air={"wind_mps": 8.0})) == pytest.approx(4.8, abs=0.1)


def test_wind_blows_to_where_it_is_said_and_else_to_where_the_seed_draws(landing):
    np.testing.assert_allclose(
        towards(landing(air={"wind_mps": 1.0, "towards_deg": 90.0})), [0.0, 1.0, 0.0], atol=1e-15
    )
    drawn = landing(air={"wind_mps": 1.0})
    ways = np.array([towards(drawn.with_seed(seed)) for seed in range(200)])
    np.testing.assert_allclose(np.linalg.norm(ways, axis=1), 1.0)
    np.testing.assert_array_equal(ways[:, 2], 0.0)
    # All around: the mean of 200 unit vectors is within 3/√200 of nothing.
    assert np.linalg.norm(ways.mean(axis=0)) < 0.21
    np.testing.assert_array_equal(towards(drawn.with_seed(3)), ways[3])
