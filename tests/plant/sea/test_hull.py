"""The hull's response against the surface itself, averaged and fitted point by point under its waterline."""

import numpy as np
import pytest

from armland.plant.sea.hull import GRAVITY, MOTIONS, contour


def surface(r, t, omega, towards, shift=0.0):
    """ζ (k,) m at r (k, 2), the same wave's horizontal shift along its way with `shift` = −i."""
    k = omega**2 / GRAVITY * np.array([np.cos(towards), np.sin(towards)])
    return np.real((shift or 1.0) * np.exp(1j * (omega * t - r @ k)))


@pytest.mark.parametrize("towards", [0.0, np.pi, 0.5 * np.pi, 2.3, -1.1])
@pytest.mark.parametrize("omega", [0.8, 2.0, 3.7])
def test_hull_follows_mean_and_best_plane_of_the_surface(omega, towards):
    """Least squares over the waterline's points; bow down is positive pitch, port up positive roll."""
    length, beam, t = 4.0, 1.6, 0.37
    x, y = np.meshgrid(*(s * ((np.arange(n) + 0.5) / n - 0.5) for s, n in ((length, 200), (beam, 80))))
    r = np.stack([x.ravel(), y.ravel()], axis=1)
    zeta = surface(r, t, omega, towards)
    plane = np.linalg.lstsq(np.column_stack([np.ones(len(r)), r]), zeta, rcond=None)[0]
    along = surface(r, t, omega, towards, shift=-1j)
    aside = np.sin(towards) * along
    yaw = np.linalg.lstsq(np.column_stack([np.ones(len(r)), r]), aside, rcond=None)[0][1]
    expected = [np.cos(towards) * along.mean(), aside.mean(), zeta.mean(), plane[2], -plane[1], yaw]
    H = contour(np.array([omega]), np.array([towards]), length, beam)[0]
    np.testing.assert_allclose(np.real(H * np.exp(1j * omega * t)), expected, atol=2e-4)


def test_water_moves_ahead_on_a_crest():
    """The crest's water runs with the wave: d/dt of surge is positive at ζ = max."""
    H = contour(np.array([1.0]), np.array([0.0]), 0.5, 0.2)[0]
    assert np.real(1j * H[MOTIONS.index("surge")]) > 0.9


def test_hull_of_no_size_is_a_cork_and_long_waves_lift_it_whole():
    H = contour(np.array([0.05]), np.array([np.pi]), 4.0, 1.6)[0]
    assert H[2] == pytest.approx(1.0, abs=1e-4)
    assert abs(H[4]) == pytest.approx(0.05**2 / GRAVITY, rel=1e-3)
