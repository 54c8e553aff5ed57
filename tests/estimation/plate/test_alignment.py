"""Alignment of the UAV's idea of the world with the arm's, against scipy's rotations and statistics."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from armland.estimation.plate.alignment import ALIGNMENT, begin, correct, covariance, residual

H = 1e-3


def quat(R):
    return R.as_quat(scalar_first=True)


def test_begins_with_the_heading_seen_and_the_tilt_reported():
    rng = np.random.default_rng(0)
    for _ in range(20):
        tilt, heading = (
            Rotation.from_euler("xy", 0.2 * rng.normal(size=2)),
            Rotation.from_euler("z", rng.uniform(-3.0, 3.0)),
        )
        a = np.zeros(1, ALIGNMENT)
        begin(a[0], 7, quat(heading * tilt), quat(tilt), 0.03, 0.01)
        found = Rotation.from_quat(a["quat"][0], scalar_first=True)
        assert (found * heading.inv()).magnitude() < 1e-12
        np.testing.assert_allclose(np.sqrt(np.diag(a["P"][0])), [0.03, 0.03, 0.01])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_residual_is_the_missing_rotation_in_world_axes(sign):
    missing, believed = np.array([0.01, -0.02, 0.015]), Rotation.from_rotvec([0.3, 0.5, -1.0])
    seen = sign * quat(Rotation.from_rotvec(missing) * believed)
    np.testing.assert_allclose(residual(seen, quat(believed)), missing, rtol=2e-4)


def drift(runs, honesty, samples=60, walk=2e-3, sigma=(0.04, 0.04, 0.008)):
    """Normalised squared errors and distances of `runs` with a drifting alignment."""
    rng, errors, distances = np.random.default_rng(1), [], []
    for _ in range(runs):
        a, P0 = np.zeros(1, ALIGNMENT), np.array([0.03, 0.03, 0.008])
        truth = Rotation.from_rotvec(rng.normal(size=3) * P0)
        begin(a[0], 0, quat(Rotation.identity()), quat(Rotation.identity()), P0[0], P0[2])
        for k in range(1, samples + 1):
            truth = Rotation.from_rotvec(rng.normal(size=3) * walk * np.sqrt(33 * H)) * truth
            reported = Rotation.from_euler("xyz", 0.1 * rng.normal(size=3))
            seen = Rotation.from_rotvec(honesty * rng.normal(size=3) * sigma) * truth * reported
            believed = Rotation.from_quat(a["quat"][0], scalar_first=True) * reported
            theta = residual(quat(seen), quat(believed))
            distances.append(correct(a[0], 33 * k, theta, np.diag(np.square(sigma)), walk, np.inf, H))
        error = (truth * Rotation.from_quat(a["quat"][0], scalar_first=True).inv()).as_rotvec()
        errors.append(error @ np.linalg.solve(a["P"][0], error))
    return np.array(errors), np.array(distances)


@pytest.mark.parametrize("honesty", [1.0, 1.3])
def test_errors_are_as_large_as_the_covariance_says(honesty):
    errors, distances = drift(60, honesty)
    consistent = [chi2(3 * len(e)).cdf(np.sum(e)) for e in (errors, distances)]
    assert (min(consistent) > 0.001 and max(consistent) < 0.999) == (honesty == 1.0)


def test_far_off_attitude_changes_nothing_and_waiting_costs_certainty():
    a = np.zeros(1, ALIGNMENT)
    begin(a[0], 0, quat(Rotation.identity()), quat(Rotation.identity()), 0.03, 0.01)
    before = a.copy()
    assert correct(a[0], 10, np.array([0.5, 0.0, 0.0]), 1e-4 * np.eye(3), 1e-3, 16.0, H) > 16.0
    assert a == before
    np.testing.assert_allclose(np.diag(covariance(a[0], 4.0, 1e-3) - a["P"][0]), 4e-6)
