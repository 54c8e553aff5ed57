"""The fitted laws of the detector: losses by smear, and scaling with the marker."""

import numpy as np
import pytest

from armland.plant.devices.camera_numbers import camera_told
from armland.plant.devices.detector_errors import DETECTOR, claim, loss
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
