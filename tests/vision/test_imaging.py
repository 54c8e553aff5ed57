"""Every imperfection against a picture for which it can be worked out by hand."""

import numpy as np
import pytest

from armland.rotations import from_rotation_vector, multiply
from armland.vision.fiducial import Intrinsics, project
from armland.vision.imaging import (
    IDEAL,
    Calibration,
    Imaging,
    Motion,
    blur_px,
    draw_unit,
    photographed,
    smear_px,
)
from armland.vision.study import FACING

cv2 = pytest.importorskip("cv2")

K = Intrinsics(200.0, 200.0, 79.5, 59.5)
STILL = Motion(np.array([0.0, 0.0, 0.25]), FACING, np.zeros(3), np.zeros(3))
RNG = np.random.default_rng(0)


def step() -> np.ndarray:
    picture = np.full((120, 160), 60, np.uint8)
    picture[:, 80:] = 180
    return picture


def width_px(image: np.ndarray) -> float:
    """Standard deviation of the step's derivative, px."""
    line = image[40:80].astype(float).mean(axis=0)
    weight, x = np.clip(np.diff(line), 0.0, None), np.arange(len(line) - 1)
    mean = weight @ x / weight.sum()
    return float(np.sqrt(weight @ (x - mean) ** 2 / weight.sum()))


def test_ideal_camera_changes_nothing() -> None:
    np.testing.assert_array_equal(photographed(step(), K, STILL, IDEAL, RNG), step())


def test_blur_is_that_of_lens_and_defocus() -> None:
    # In focus the lens alone; at twice the focus f·A/(4·2·z_f) = 200 · 4 mm/2 / (8 · 0.25 m) = 0.2 px of standard deviation.
    imaging = Imaging(f_number=2.0)
    assert blur_px(imaging, 200.0, 0.25) == pytest.approx(0.6)
    assert blur_px(imaging, 200.0, 0.50) == pytest.approx(np.hypot(0.6, 0.2))
    image = photographed(step(), K, STILL, IDEAL._replace(lens_px=2.0), RNG)
    assert width_px(image) == pytest.approx(2.0, rel=0.03)


def test_smear_is_as_wide_as_the_marker_moves() -> None:
    # 0.5 m/s at 0.25 m and 200 px for 20 ms: 8 px, a box of 8/√12 px of standard deviation.
    moving = STILL._replace(velocity=np.array([0.5, 0.0, 0.0]))
    imaging = IDEAL._replace(exposure_s=0.02, substeps=40)
    assert smear_px(imaging, K, moving) == pytest.approx(8.0)
    image = photographed(step(), K, moving, imaging, RNG)
    assert width_px(image) == pytest.approx(8.0 / np.sqrt(12.0), rel=0.04)
    assert width_px(photographed(step(), K, STILL, imaging, RNG)) < 0.6


def test_smear_moves_the_markers_plane_as_the_pose_does() -> None:
    """A point of the marker, seen at the end of a long exposure, is where its pose puts it."""
    motion = Motion(
        np.array([0.01, -0.02, 0.3]),
        multiply(from_rotation_vector(np.array([0.3, -0.2, 0.4])), FACING),
        np.array([0.2, -0.1, 0.3]),
        np.array([0.5, 1.0, -2.0]),
    )
    from armland.rotations import matrix
    from armland.vision.imaging import _plane

    K3, corner, t = np.array([[K.fx, 0, K.cx], [0, K.fy, K.cy], [0, 0, 1.0]]), np.array([0.03, 0.02, 0.0]), 0.01
    H = K3 @ _plane(motion, t) @ np.linalg.inv(K3 @ _plane(motion, 0.0))
    start = project(motion.position + matrix(motion.quat) @ corner, K)
    turned = matrix(from_rotation_vector(motion.omega * t)) @ matrix(motion.quat) @ corner
    expected = project(motion.position + t * motion.velocity + turned, K)
    moved = H @ [*start, 1.0]
    np.testing.assert_allclose(moved[:2] / moved[2], expected, atol=1e-9)


def test_noise_is_that_of_reading_and_of_electrons() -> None:
    flat = np.full((200, 200), 100, np.uint8)
    imaging = IDEAL._replace(read_noise=1.2, full_well_e=5000.0)
    image = photographed(flat, K, STILL, imaging, RNG).astype(float)
    # 100/255 of 5000 electrons are 1961 ± 44, which is 100 ± 2.26; rounding to 8 bits adds 1/12.
    assert image.std() == pytest.approx(np.sqrt(1.2**2 + 2.26**2 + 1.0 / 12.0), rel=0.02)
    assert image.mean() == pytest.approx(100.0, abs=0.1)


def test_light_falls_to_the_corners_and_along_the_picture() -> None:
    flat, imaging = np.full((120, 160), 200, np.uint8), IDEAL._replace(gradient=0.3)
    image = photographed(flat, K, STILL, imaging, np.random.default_rng(1)).astype(float)
    corners = [image[i, j] for i in (0, -1) for j in (0, -1)]
    # The gradient cancels over opposite corners: what is left is cos⁴ of atan(|(79.5, 59.5)|/200).
    tangent = np.hypot(79.5, 59.5) / 200.0
    assert np.mean(corners) == pytest.approx(200.0 / (1.0 + tangent**2) ** 2, rel=0.01)
    assert np.ptp(corners) > 5.0
    dim = photographed(flat, K, STILL, IDEAL._replace(dimmest=0.4), np.random.default_rng(1))
    assert 0.4 * 200.0 - 1.0 <= dim[60, 80] < 200.0


def test_distortion_moves_the_edges_as_the_radial_law_says() -> None:
    wide = np.full((120, 160), 60, np.uint8)
    wide[:, 140:] = 180
    image = photographed(wide, K, STILL, IDEAL, RNG, k1=0.1).astype(float)
    edge = 160.0 - (image[60] - 60.0).sum() / 120.0 - 0.5
    x = (139.5 - K.cx) / K.fx
    assert edge == pytest.approx(K.cx + K.fx * x * (1.0 + 0.1 * x * x), abs=0.1)
    assert edge - 139.5 > 0.4


def test_units_scatter_as_the_calibration_says() -> None:
    units = [draw_unit(K, Calibration(), RNG) for _ in range(4000)]
    focal, cx = np.array([u.believed.fx for u in units]), np.array([u.believed.cx for u in units])
    assert focal.std() / K.fx == pytest.approx(np.hypot(1.5e-3, 1.5e-4), rel=0.05)
    assert cx.std() == pytest.approx(0.4, rel=0.05)
    corner = np.hypot(K.cx / K.fx, K.cy / K.fy)
    assert np.std([u.k1 for u in units]) * K.fx * corner**3 == pytest.approx(0.3, rel=0.05)
