import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from armland.vision.square import refined

CELLS = 8
SIDE_PX = 90.0
FINE = 8
# On the fine grid, so that edges along it are exact, too.
CENTRE = np.array([80.25, 79.625])


def corners_of(turn: float, side: float = SIDE_PX, stretch: float = 1.0) -> np.ndarray:
    """A parallelogram about `CENTRE`, clockwise as seen."""
    square = 0.5 * side * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) * [stretch, 1.0]
    c, s = np.cos(turn), np.sin(turn)
    return square @ np.array([[c, s], [-s, c]]) + CENTRE


def picture_of(corners: np.ndarray, blur: float = 0.0, noise: float = 0.0, shade: float = 0.0) -> np.ndarray:
    """Dark square on light ground (160, 160): each pixel the mean of the points in it that lie within all four edges."""
    u = (np.arange(160 * FINE) + 0.5) / FINE - 0.5
    x, y = np.meshgrid(u, u)
    inside = np.ones(x.shape, bool)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        inside &= (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0.0
    share = inside.reshape(160, FINE, 160, FINE).mean(axis=(1, 3))
    light = 180.0 * (1.0 + shade * (np.arange(160) / 80.0 - 1.0))
    grey = share * 30.0 + (1.0 - share) * light
    if blur:
        grey = gaussian_filter(grey, blur)
    grey += noise * np.random.default_rng(1).standard_normal(grey.shape)
    return np.clip(np.rint(grey), 0, 255).astype(np.uint8)


@pytest.mark.parametrize("turn", [0.0, 0.1, 0.7])
@pytest.mark.parametrize("blur", [0.0, 0.7, 1.2])
def test_corners_are_found_to_hundredths_of_a_pixel(turn: float, blur: float) -> None:
    truth = corners_of(turn, stretch=0.8)
    start = truth + [[0.9, -0.6], [-0.8, 0.7], [0.5, 0.8], [-0.9, -0.9]]
    found = refined(picture_of(truth, blur), start, CELLS)
    np.testing.assert_allclose(found, truth, atol=0.02)


def test_light_that_halves_across_the_picture_hardly_matters() -> None:
    truth = corners_of(0.3)
    # It rises by 0.56 levels per pixel: over L = 5 px, half of that over a step of 150 levels is 0.05 px.
    np.testing.assert_allclose(refined(picture_of(truth, 0.7, shade=0.25), truth, CELLS), truth, atol=0.08)


def test_noise_averages_out_along_the_edges() -> None:
    truth = corners_of(0.4)
    np.testing.assert_allclose(refined(picture_of(truth, 0.7, noise=3.0), truth, CELLS), truth, atol=0.06)


def test_something_small_over_an_edge_does_not_turn_it() -> None:
    truth = corners_of(0.0)
    image = picture_of(truth, 0.7)
    image[20:60, 70:76] = 90
    np.testing.assert_allclose(refined(image, truth, CELLS), truth, atol=0.03)


def test_blur_rounds_the_corner_but_not_the_edges() -> None:
    # Negative control: what looks at the corner only is pulled into the square.
    cv2 = pytest.importorskip("cv2")
    truth = corners_of(0.4)
    image = picture_of(truth, 0.7)
    at_corner = truth.astype(np.float32)[:, None].copy()
    cv2.cornerSubPix(image, at_corner, (3, 3), (-1, -1), (3, 50, 1e-3))
    inward = (truth.mean(axis=0) - truth) / np.linalg.norm(truth.mean(axis=0) - truth, axis=1)[:, None]
    assert np.sum((at_corner[:, 0] - truth) * inward, axis=1).min() > 0.1
    assert np.abs(np.sum((refined(image, truth, CELLS) - truth) * inward, axis=1)).max() < 0.02


def test_no_square_gives_none() -> None:
    truth = corners_of(0.2)
    assert refined(np.full((160, 160), 128, np.uint8), truth, CELLS) is None
    assert refined(255 - picture_of(truth), truth, CELLS) is None
    assert refined(picture_of(truth), corners_of(0.2, 5.0), CELLS) is None
    noise = np.random.default_rng(2).integers(0, 255, (160, 160)).astype(np.uint8)
    found = refined(noise, truth, CELLS)
    assert found is None or np.isfinite(found).all()
