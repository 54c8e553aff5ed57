import numpy as np
import pytest

from armland.view.film.framing import ANGLE_DEG, MARGIN, framed


@pytest.mark.parametrize("aspect", [16 / 9, 1.0, 0.5])
@pytest.mark.parametrize("seed", range(3))
def test_camera_sees_all_spheres_and_is_not_farther_than_need_be(aspect, seed) -> None:
    rng = np.random.default_rng(seed)
    middles, radii = rng.normal(size=(30, 3)) * [0.5, 0.8, 0.3] + [1.0, 2.0, 0.7], rng.uniform(0.01, 0.2, 30)
    camera = framed(middles, radii, aspect)
    x, y = camera.axes[:3], camera.axes[3:]
    back = np.cross(x, y)
    apart = middles - camera.eye
    depth = -(apart @ back)
    tall = np.tan(0.5 * np.deg2rad(ANGLE_DEG))
    across = (np.abs(apart @ x) + radii) / depth / (tall * aspect)
    up = (np.abs(apart @ y) + radii) / depth / tall
    widest = max(across.max(), up.max())
    assert widest == pytest.approx(MARGIN, abs=0.01)
    assert x[2] == pytest.approx(0.0, abs=1e-12)
