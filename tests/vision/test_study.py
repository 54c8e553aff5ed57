import numpy as np
import pytest

from armland.errors import PictureError
from armland.plant.noise import stream
from armland.vision.imaging import IDEAL, Calibration, Imaging
from armland.vision.study import (
    ERROR,
    SPEED_MPS,
    SWEEP_RAD_S,
    Camera,
    Row,
    Study,
    draw_motion,
    errors_of,
    marker_study,
    model_errors,
    rows,
)

pytest.importorskip("cv2")

CAMERA = Camera(marker_size_m=0.06)


@pytest.fixture(scope="module")
def study() -> Study:
    try:
        return marker_study(distances=(0.2, 0.8), per_distance=3)
    except PictureError as e:
        pytest.skip(str(e))


@pytest.fixture(scope="module")
def table(study) -> list[Row]:
    return rows(study, draws=20)


def test_marker_is_found_in_all_pictures(study) -> None:
    for errors in (study.ideal, study.honest, study.grain):
        assert errors["found"].all()
        np.testing.assert_allclose(errors["distance"], [0.2] * 3 + [0.8] * 3)


def test_each_imperfection_that_is_put_on_makes_it_worse(table) -> None:
    for row in table:
        # Several times: a frame or a pixel convention that is wrong would spoil the ideal pictures, too.
        assert 3.0 * row.ideal.lateral_m < row.honest.lateral_m < row.model.lateral_m
        assert row.ideal.depth_m < row.honest.depth_m < row.model.depth_m
        assert row.honest.tilt_rad < row.model.tilt_rad
        assert row.honest.yaw_rad < row.model.yaw_rad


def test_calibration_is_a_bias_that_grows_with_distance(study) -> None:
    near, far = (np.abs(study.honest[i : i + 3]["position"] - study.grain[i : i + 3]["position"]) for i in (0, 3))
    # A principal point that is 0.4 px off shifts by 0.4/1078 of the depth, a focal length by 0.15 % of it.
    assert near.max() < 5.0 * 0.2 * 1.5e-3
    assert far.max() < 5.0 * 0.8 * 1.5e-3
    assert far.mean() > near.mean()


def test_noise_alone_may_be_put_on() -> None:
    try:
        plain = marker_study((0.6,), 2, imaging=IDEAL, calibration=Calibration(0.0, 0.0, 0.0, 0.0))
    except PictureError as e:
        pytest.skip(str(e))
    np.testing.assert_allclose(plain.honest["position"], plain.ideal["position"], atol=1e-9)


def test_image_of_noise_holds_no_marker() -> None:
    try:
        errors = marker_study(distances=(0.6,), per_distance=1, imaging=Imaging(read_noise=150.0)).honest
    except PictureError as e:
        pytest.skip(str(e))
    row = errors_of(errors)
    assert row.found == 0.0
    assert np.isnan(row[1:]).all()


def test_marker_that_does_not_fit_into_the_picture_is_refused() -> None:
    with pytest.raises(PictureError, match=r"at 0\.05 m the marker does not fit .* from about 0\.13 m on"):
        marker_study(distances=(0.05,), per_distance=1)


def test_motion_is_no_faster_than_stated() -> None:
    rng = stream(0, "test motions")
    near, far = (np.array([draw_motion(z, CAMERA, rng).velocity for _ in range(400)]) for z in (0.2, 1.0))
    assert near.std() == pytest.approx(SWEEP_RAD_S * 0.2, rel=0.1)
    assert far.std() == pytest.approx(SPEED_MPS, rel=0.1)


def test_errors_are_the_root_mean_square_of_each_axis() -> None:
    errors = np.zeros(3, ERROR)
    errors["found"] = [True, True, False]
    errors["position"] = [[3.0, 4.0, 1.0], [0.0, 0.0, 7.0], [9.0, 9.0, 9.0]]
    errors["rotation"] = [[1.0, 1.0, 2.0], [1.0, 1.0, 2.0], [9.0, 9.0, 9.0]]
    assert errors_of(errors) == pytest.approx((2 / 3, 2.5, 5.0, 1.0, 2.0))


def test_models_errors_are_its_claims_and_its_mounting() -> None:
    rng = stream(1, "test motions")
    still = [draw_motion(0.5, CAMERA, rng)._replace(velocity=np.zeros(3)) for _ in range(30)]
    errors = model_errors(still, CAMERA, 100)
    found = errors_of(errors)
    # 3.8 % of the images are lost at rest: 0.02/(1 + 0.02 - 0.5).
    assert found.found == pytest.approx(1.0 - 0.02 / 0.52, abs=0.015)
    noise, mount, angle, scale = 0.49e-3, 0.5e-3, np.deg2rad(0.1) * 0.5, 3e-3 * 0.5
    assert found.lateral_m == pytest.approx(np.sqrt(noise**2 + (mount**2 + angle**2) / 3.0), rel=0.06)
    assert found.depth_m == pytest.approx(np.sqrt(1.17e-3**2 + (mount**2 + scale**2) / 3.0), rel=0.06)
