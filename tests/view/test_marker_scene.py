import mujoco
import numpy as np
import pytest

from armland.errors import PictureError
from armland.estimation.fiducial import detect
from armland.rotations import from_rotation_vector, matrix, multiply
from armland.view.frames import frames
from armland.view.marker_scene import EYE, MARKER, MarkerScene, build_marker_scene
from armland.view.marker_study import FACING

pytest.importorskip("cv2")

POSITION = np.array([0.02, -0.03, 0.4])
QUAT = multiply(from_rotation_vector(np.array([0.2, -0.3, 1.1])), FACING)


@pytest.fixture(scope="module")
def scene() -> MarkerScene:
    return build_marker_scene()


def drawn(scene: MarkerScene, *poses) -> np.ndarray:
    try:
        qpos = [scene.qpos(*pose) for pose in poses]
        return frames(scene.model, qpos, scene.width, scene.height, EYE)
    except PictureError as e:
        pytest.skip(str(e))


def test_camera_stands_where_the_marker_has_the_pose_asked_for(scene) -> None:
    data = mujoco.MjData(scene.model)
    data.qpos[:] = scene.qpos(POSITION, QUAT)
    mujoco.mj_kinematics(scene.model, data)
    mujoco.mj_camlight(scene.model, data)
    # MuJoCo's camera looks along -z, with y up.
    R_wc = data.cam(EYE).xmat.reshape(3, 3) @ np.diag([1.0, -1.0, -1.0])
    geom = data.geom("marker")
    R_wm = geom.xmat.reshape(3, 3)
    face = geom.xpos + scene.model.geom("marker").size[2] * R_wm[:, 2]
    np.testing.assert_allclose(R_wc.T @ (face - data.cam(EYE).xpos), POSITION, atol=1e-9)
    np.testing.assert_allclose(R_wc.T @ R_wm, matrix(QUAT), atol=1e-9)


def test_field_of_view_is_the_cameras(scene) -> None:
    k = scene.intrinsics
    assert np.rad2deg(2.0 * np.arctan(0.5 * scene.height / k.fy)) == pytest.approx(48.0)
    assert np.rad2deg(2.0 * np.arctan(0.5 * scene.width / k.fx)) == pytest.approx(60.0, abs=0.1)


def test_renderer_is_a_pinhole_and_shows_the_print_upright(scene) -> None:
    image = drawn(scene, (POSITION, QUAT))[0]
    assert image.shape == (scene.height, scene.width)
    (found,) = detect(image, scene.size_m, scene.intrinsics)
    assert found.marker == MARKER
    np.testing.assert_allclose(found.position, POSITION, atol=5e-5)
    np.testing.assert_allclose(matrix(found.quat), matrix(QUAT), atol=1e-3)


def test_marker_behind_the_hinge_plate_is_not_found() -> None:
    hidden = build_marker_scene(place=(0.0, 0.0, -0.03))
    assert detect(drawn(hidden, (np.array([0.0, 0.0, 0.4]), FACING))[0], hidden.size_m, hidden.intrinsics) == []
