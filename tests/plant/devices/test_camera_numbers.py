"""What becomes of a scenario's camera: noise laws, mounting errors of the seed, refusals."""

import numpy as np
import pytest

from armland.errors import PlantError
from armland.plant.devices.camera import visible
from armland.plant.devices.camera_numbers import camera_told, drawn_camera, mounting, noise_through, see_all
from armland.scenario.sensing import Camera, Imperfections


def test_noise_law_meets_both_points_and_refuses_what_it_cannot():
    floor, slope = noise_through((0.3, 1.0), (0.9e-3, 3.3e-3), 2)
    assert np.hypot(floor, slope * 0.09) == pytest.approx(0.9e-3)
    assert np.hypot(floor, slope) == pytest.approx(3.3e-3)
    for sigma in ((1e-3, 0.5e-3), (1e-3, 12e-3)):
        with pytest.raises(PlantError, match="must lie in"):
            noise_through((0.3, 1.0), sigma, 2)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"rate_hz": 600}, r"camera\.rate_hz = 600 must lie in \[1, 500\]"),
        ({"delay_ms": (50.0, 500.0)}, r"camera\.delay_ms"),
    ],
)
def test_impossible_cameras_are_refused(wrong, message):
    with pytest.raises(PlantError, match=message):
        camera_told(Camera(**wrong), 500)


def test_mounting_errors_are_drawn_within_their_bounds_and_for_each_seed_anew(landing):
    drawn = np.array([np.concatenate(mounting(landing(run={"seed": seed}))) for seed in range(60)])
    bounds = np.array([5e-4] * 3 + [np.deg2rad(0.1)] * 2 + [3e-3])
    assert (np.abs(drawn) <= bounds).all()
    assert (np.abs(drawn).max(axis=0) > 0.8 * bounds).all()
    np.testing.assert_array_equal(np.concatenate(mounting(landing(run={"seed": 7}))), drawn[7])


def test_exact_camera_is_without_them_and_at_once(bench_in_air):
    exact, real = (bench_in_air(imperfections={"camera": on}).told["camera"][0] for on in (False, True))
    assert not exact["shift"].any()
    assert not exact["slope"].any()
    assert real["shift"].all()
    assert (exact["delay_max"], real["delay_max"]) == (0, 75)
    assert exact["lose"] == 0.0
    assert drawn_camera(Camera(), Imperfections()) == Camera()


def test_camera_that_sees_all_sees_what_the_plain_one_does_not():
    beside, told = np.array([3.0, 0.0, 0.5]), camera_told(Camera(), 1000)
    R = np.diag([1.0, -1.0, -1.0])
    assert not visible(beside, R, told[0])
    see_all(told)
    assert visible(beside, R, told[0])
    assert not visible(-beside, R, told[0])
