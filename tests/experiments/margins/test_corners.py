"""Ranges at their ends: what a seed draws of them, bounds, and which rows a pattern means."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.experiments.margins.corners import COMPANIONS, at, chosen, ends, largest, nested
from armland.plant.deviation.drawn import drawn
from armland.scenario.deviation import rows

ROWS = {row.path: row for row in rows()}


def values(scenario, path, factor, seed):
    changed = scenario.replaced({**nested([at(ROWS[path], factor, seed)]), "run": {"seed": seed}})
    return drawn(changed, 7)[path]


def test_one_number_of_two_signs_goes_to_one_end_with_even_seeds_and_to_the_other_with_odd_ones(landing_scenario):
    assert [values(landing_scenario, "uav.mass", 2.0, seed)[0] for seed in (1, 2, 3, 4)] == [-0.14, 0.14, -0.14, 0.14]
    assert [values(landing_scenario, "camera.exposure", 0.5, seed)[0] for seed in (1, 2)] == [-0.25, 0.5]


def test_one_sign_is_at_its_largest_with_every_seed(landing_scenario):
    assert {values(landing_scenario, "air.wind_mps", 1.5, seed)[0] for seed in range(6)} == {1.5}
    assert values(landing_scenario, "camera.outlier_m", 2.0, 3)[0] == 0.04


@pytest.mark.parametrize(
    ("path", "size", "end"), [("uav.rotor", 8, 0.04), ("wrench.cross", 12, 0.01), ("arm.torque", 7, 0.005)]
)
def test_several_numbers_are_at_ends_of_both_signs_and_keep_them_at_every_factor(landing_scenario, path, size, end):
    once, thrice = (np.array([values(landing_scenario, path, k, seed) for seed in range(20)]) for k in (1.0, 3.0))
    assert once.shape == (20, size)
    np.testing.assert_allclose(np.abs(once), end)
    np.testing.assert_allclose(thrice, 3.0 * once)
    assert (once > 0.0).any(axis=0).all()
    assert (once < 0.0).any(axis=0).all()


def test_without_ends_numbers_lie_inside(landing_scenario):
    changed = landing_scenario.replaced({"deviation": {"arm": {"torque": {"low": -0.005, "high": 0.005}}}})
    assert (np.abs(drawn(changed, 7)["arm.torque"]) < 0.005).all()


@pytest.mark.parametrize("path", ROWS)
def test_every_row_may_go_to_its_bound_and_not_beyond(landing_scenario, path):
    row, k = ROWS[path], largest(ROWS[path])
    assert k >= 1.0
    for seed in (1, 2):
        landing_scenario.replaced(nested([at(row, k, seed)]))
    low, high = ends(row, 2.0 * k)
    assert row.told.least <= low <= high <= row.told.most
    assert low == row.told.least or high == row.told.most


def test_normal_and_ends_exclude_each_other(landing_scenario):
    with pytest.raises(ConfigurationError, match="normal and ends"):
        landing_scenario.replaced(
            {"deviation": {"uav": {"mass": {"low": 0.0, "high": 0.1, "normal": True, "ends": True}}}}
        )


def test_later_change_of_a_row_counts():
    assert nested([{"uav.mass": 1}, {"link.loss": 2, "uav.mass": 3}]) == {
        "deviation": {"uav": {"mass": 3}, "link": {"loss": 2}}
    }


def test_companions_are_rows():
    assert {*COMPANIONS, *COMPANIONS.values()} <= ROWS.keys()


def test_patterns_choose_rows_in_the_order_of_the_table():
    assert [r.path for r in chosen("link.loss, uav.m*")] == ["uav.mass", "link.loss"]
    assert [r.path for r in chosen(None)] == list(ROWS)


@pytest.mark.parametrize(
    ("patterns", "words"),
    [
        ("uav.mas", "'uav.mas'.*near: uav.mass"),
        ("uav.mass,loss", "'loss'.*near: link.loss"),
        ("hinge.zzz", "there are hinge.friction_nm"),
        ("qqq", r"there are uav.\*, link.\*"),
        (",", "no such deviation"),
    ],
)
def test_unknown_row_is_refused_with_near_ones(patterns, words):
    with pytest.raises(ConfigurationError, match=words):
        chosen(patterns)
