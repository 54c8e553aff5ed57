"""The fitted laws of the detector: losses by smear, and scaling with the marker."""

import numpy as np
import pytest

from armland.plant.devices.camera_numbers import camera_told
from armland.plant.devices.detector_errors import DETECTOR, claim, loss, second_pose
from armland.rotations import from_rotation_vector, matrix, multiply
from armland.scenario.sensing import Camera


def test_probability_of_loss_is_zero_at_rest_and_one_half_where_the_fit_says():
    b = np.array(DETECTOR.smeared)
    assert loss(0.0, 10.0, b) == 0.0
    half = -b[0] / (b[1] / 10.0 + b[2])
    assert loss(half, 10.0, b) == pytest.approx(0.5, abs=1e-4)
    assert loss(3.0 * half, 10.0, b) > 0.99


def test_claim_is_the_larger_of_published_and_fitted():
    """By hand at 1 m and 8 cm: σ_xy = 0.7 mm and σ_z = 3.3 mm are published, tilt 2σ_z/s, yaw √2 σ_xy/s."""
    sigma = np.zeros(6)
    claim(1.0, camera_told(Camera(marker_size_m=0.08), 1000)[0], sigma)
    tilt, yaw = 2.0 * 3.3e-3 / 0.08, np.sqrt(2.0) * 0.7e-3 / 0.08
    np.testing.assert_allclose(sigma, [0.7e-3, 0.7e-3, 3.3e-3, tilt, tilt, yaw])


def test_smaller_marker_is_the_same_picture_at_another_scale():
    """A marker of half the size at half the distance: half the error of position, the same of angle."""
    found = {}
    for share in (1.0, 0.5):
        p, sigma = camera_told(Camera(marker_size_m=0.06 * share), 1000), np.zeros(6)
        # Nothing is published: what is left is the fit.
        p["lateral"] = p["depth"] = 0.0
        claim(1.2 * share, p[0], sigma)
        found[share] = sigma
    np.testing.assert_allclose(found[0.5], found[1.0] * [0.5, 0.5, 0.5, 1.0, 1.0, 1.0])
    # Twice as far, each grows by its own power.
    far = np.zeros(6)
    p = camera_told(Camera(marker_size_m=0.06), 1000)
    p["lateral"] = p["depth"] = 0.0
    claim(2.4, p[0], far)
    np.testing.assert_allclose(np.log2(far / found[1.0]), [2.38, 2.38, 1.91, 1.56, 1.56, 1.64])


def test_smaller_cells_of_the_marker_are_smeared_sooner():
    b = np.array(DETECTOR.smeared)
    assert loss(8.0, 5.0, b) > loss(8.0, 10.0, b) > loss(8.0, 20.0, b)
    assert loss(9.0, 10.0, b) > loss(8.0, 10.0, b)


@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.4), (0.1, -0.05, 0.4), (-0.2, 0.1, 1.0)])
def test_second_pose_makes_the_same_picture_from_afar_and_mirrors_the_normal(offset):
    """Oracle: the corners projected along the line of sight, as a camera far away sees them."""
    offset = np.array(offset)
    quat = multiply(from_rotation_vector(np.array([0.2, -0.1, 0.4])), np.array([0.0, 1.0, 0.0, 0.0]))
    first, second = matrix(quat), matrix(second_pose(offset, quat))
    sight = offset / np.linalg.norm(offset)
    seen = np.eye(3) - np.outer(sight, sight)
    corners = 0.03 * np.array([[1, 1, 0], [1, -1, 0], [-1, -1, 0], [-1, 1, 0]]).T
    np.testing.assert_allclose(seen @ second @ corners, seen @ first @ corners, atol=1e-15)
    np.testing.assert_allclose(second[:, 2], 2.0 * sight * (sight @ first[:, 2]) - first[:, 2], atol=1e-14)
    np.testing.assert_allclose(second @ second.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(second) == pytest.approx(1.0)
    # Turned the other way about the line of sight, the picture is another one.
    assert (
        np.abs(seen @ (2.0 * np.outer(sight, sight) - np.eye(3)) @ first @ corners - seen @ first @ corners).max()
        > 0.03
    )
    np.testing.assert_allclose(matrix(second_pose(offset, second_pose(offset, quat))), first, atol=1e-14)
