import numpy as np
import pytest

from armland.errors import PictureError
from armland.plant.devices.detector_errors import DETECTOR, loss
from armland.vision.fit import error_laws, fit_detector, logistic, loss_laws
from armland.vision.study import ERROR


def test_power_laws_are_found_again() -> None:
    rng, z = np.random.default_rng(0), np.repeat([0.15, 0.3, 0.6, 1.2], 2000)
    errors = np.zeros(len(z), ERROR)
    errors["distance"], errors["found"] = z, True
    spread = np.stack([1e-4 * z**2, 1e-4 * z**2, 5e-4 * z**1.5], axis=1)
    errors["position"] = spread * rng.standard_normal((len(z), 3))
    errors["rotation"] = np.stack([4e-3 * z, 4e-3 * z, 1e-3 * z**3], axis=1) * rng.standard_normal((len(z), 3))
    # What was not found must not count.
    errors["found"][::2], errors["position"][::2] = False, 1.0
    for law, expected in zip(error_laws(errors), ((1e-4, 2.0), (5e-4, 1.5), (4e-3, 1.0), (1e-3, 3.0)), strict=True):
        assert law == pytest.approx(expected, rel=0.04)


def test_logistic_regression_finds_its_coefficients_again() -> None:
    rng = np.random.default_rng(1)
    X, w = np.column_stack([np.ones(20_000), rng.uniform(0.0, 4.0, 20_000)]), np.array([-3.0, 2.0])
    y = rng.uniform(size=len(X)) < 1.0 / (1.0 + np.exp(-X @ w))
    np.testing.assert_allclose(logistic(X, y), w, rtol=0.06)


def test_pictures_that_part_cleanly_leave_the_bound_between_them() -> None:
    cell = np.geomspace(1.0, 20.0, 200)
    _, (a0, a1) = loss_laws(cell > 2.5, cell, np.zeros(200))
    assert np.exp(-a0 / a1) == pytest.approx(2.5, rel=0.03)


def test_models_range_is_nearer_than_where_cells_become_too_small() -> None:
    a0, a1 = DETECTOR.small
    smallest = np.exp(-a0 / a1)
    # The published 1.1 m for 40 mm, 1.65 m for 60 mm, leaves cells of 1078 px · 60 mm/8 / 1.65 m = 4.9 px.
    assert smallest < 0.5 * 1078.0 * 0.06 / 8.0 / 1.65


@pytest.mark.slow
def test_fit_gives_the_coefficients_in_use() -> None:
    pytest.importorskip("cv2")
    try:
        fitted = fit_detector(per_distance=8, losses=96, seed=5)
    except PictureError as e:
        pytest.skip(str(e))
    for new, old in zip(fitted[:4], DETECTOR[:4], strict=True):
        # Eight pictures tell a standard deviation to 18 %, a few outliers carry much of it; another seed than the coefficients'.
        for z in (0.2, 0.5, 1.0):
            assert 0.4 < (new.at_1m * z**new.power) / (old.at_1m * z**old.power) < 2.5
    for cell in (6.0, 20.0, 60.0):
        half = [-b[0] / (b[1] / cell + b[2]) for b in (np.array(fitted.smeared), np.array(DETECTOR.smeared))]
        assert half[0] == pytest.approx(half[1], rel=0.35)
        assert loss(half[1], cell, np.array(DETECTOR.smeared)) == pytest.approx(0.5, abs=1e-3)
