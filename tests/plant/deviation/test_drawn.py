"""What a seed draws of a range: repeatable, along the range, and from a stream that moves no other row's number."""

import numpy as np
import pytest

from armland.plant.deviation.drawn import direction, drawn
from armland.scenario import load_scenario
from armland.scenario.deviation import ranges, rows

ROWS = list(rows())
JOINTS = 7


@pytest.fixture(scope="module")
def published():
    return load_scenario("landing", {"deviation": {"level": "published"}})


@pytest.fixture(scope="module")
def numbers(published):
    return drawn(published, JOINTS)


def row_of(scenario, path, written):
    device, entry = path.split(".")
    return scenario.replaced({"deviation": {device: {entry: written}}})


def test_nominal_draws_nothing():
    assert drawn(load_scenario("landing"), JOINTS) == {}


def test_same_seed_gives_the_same_and_another_another(published, numbers):
    again, other = drawn(published, JOINTS), drawn(published.with_seed(7), JOINTS)
    assert set(numbers) == set(again) == set(other) == {row.path for row in ROWS}
    for path, value in numbers.items():
        np.testing.assert_array_equal(value, again[path])
        assert (value != other[path]).all(), path


def test_each_part_draws_its_own_number_within_the_range(published, numbers):
    spreads = ranges(published.deviation)
    for row in ROWS:
        value, spread = numbers[row.path], spreads[row.path]
        assert value.shape == (JOINTS if row.told.size == "n" else int(row.told.size),)
        assert len(np.unique(value)) == value.size
        assert ((spread.low <= value) & (value <= spread.high)).all(), row.path


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.path)
def test_range_of_a_row_moves_no_other_rows_number_and_twice_the_range_is_twice_the_number(published, numbers, row):
    """Of a range about zero or from zero on; a quarter of it, which lies within every bound."""
    quarter = drawn(row_of(published, row.path, [0.25 * row.told.low, 0.25 * row.told.high]), JOINTS)
    np.testing.assert_allclose(4.0 * quarter[row.path], numbers[row.path], rtol=1e-12)
    for path, value in numbers.items():
        if path != row.path:
            np.testing.assert_array_equal(quarter[path], value)


@pytest.mark.parametrize("x", [0.3, -0.2])
def test_pair_of_equal_numbers_is_that_number(x):
    found = drawn(row_of(load_scenario("landing"), "uav.cm_m", [0.1 * x, 0.1 * x]), JOINTS)
    np.testing.assert_array_equal(found["uav.cm_m"], 0.1 * x)


@pytest.mark.parametrize(("normal", "variance"), [(False, 1.0 / 3.0), (True, 0.25)])
def test_uniform_and_normal_fill_the_range_as_they_say(normal, variance):
    """Of a half range of 1: 1/3 where uniform; (1/2)² where normal, of which the cut at two deviations takes 8 % (below)."""
    scenario = load_scenario("landing")
    written = {"low": 0.0, "high": 0.2, "normal": normal}
    scenarios = (row_of(scenario.with_seed(seed), "uav.rotor", written) for seed in range(250))
    x = (np.concatenate([drawn(s, JOINTS)["uav.rotor"] for s in scenarios]) - 0.1) / 0.1
    if normal:
        # Clipped at z = 2: E min(z², 4) = 0.9205 by parts, ∫z²φ = 1 − 2(Q(2) + 2φ(2)), plus 4·2 Q(2).
        variance *= 1.0 - 2.0 * (0.02275 + 2.0 * 0.05399) + 8.0 * 0.02275
    # 1000 numbers: within five standard deviations of mean and variance.
    assert abs(x.mean()) < 5.0 * np.sqrt(variance / x.size)
    assert x.var() == pytest.approx(variance, abs=5.0 * np.sqrt(2.0 / x.size) * variance)
    assert np.abs(x).max() <= 1.0 + 1e-12
    assert (np.abs(x) > 1.0 - 1e-12).any() == normal


def test_wind_blows_from_anywhere_in_the_plane():
    ways = np.array([direction(seed) for seed in range(200)])
    np.testing.assert_allclose(np.linalg.norm(ways, axis=1), 1.0)
    np.testing.assert_array_equal(ways[:, 2], 0.0)
    assert np.abs(ways.mean(axis=0)).max() < 5.0 * np.sqrt(0.5 / 200)


def test_parts_of_a_smaller_uav_err_by_less_unless_the_user_says_how_much(published, numbers):
    small = load_scenario("landing", {"airframe": "crazyflie", "deviation": {"level": "published"}})
    reach = 0.03253 * np.sqrt(2.0) / (0.127 * np.sqrt(2.0))
    made = drawn(small, JOINTS)
    np.testing.assert_allclose(made["uav.cm_m"], reach * numbers["uav.cm_m"])
    np.testing.assert_allclose(made["hinge.stiffness_nm"], 0.0379 / 0.48 * numbers["hinge.stiffness_nm"])
    np.testing.assert_array_equal(made["uav.tilt_deg"], numbers["uav.tilt_deg"])
    own = row_of(small, "uav.cm_m", {"low": -0.003, "high": 0.003})
    np.testing.assert_allclose(drawn(own, JOINTS)["uav.cm_m"], numbers["uav.cm_m"])
    # A larger one's err as the AR.Drone's.
    large = load_scenario("landing", {"airframe": "hexa10", "deviation": {"level": "published"}})
    np.testing.assert_array_equal(drawn(large, JOINTS)["uav.cm_m"], numbers["uav.cm_m"])
