import mujoco
import numpy as np
import pytest

from armland.errors import PictureError
from armland.plant.scene.composition import build_scene
from armland.plant.sight import marker_pose
from armland.rotations import from_rotation_vector, matrix, multiply
from armland.scenario import load_scenario
from armland.vision.fiducial import detect
from armland.vision.frames import FrameStream, frames
from armland.vision.scene import EYE, NUMBER, MarkerScene, build_marker_scene
from armland.vision.study import FACING

pytest.importorskip("cv2")

POSITION = np.array([0.02, -0.03, 0.4])
QUAT = multiply(from_rotation_vector(np.array([0.2, -0.3, 1.1])), FACING)


@pytest.fixture(scope="module")
def scene() -> MarkerScene:
    return build_marker_scene()


def drawn(scene: MarkerScene, *poses) -> np.ndarray:
    try:
        return frames(scene.model, [scene.qpos(*pose) for pose in poses], scene.width, scene.height, EYE)
    except PictureError as e:
        pytest.skip(str(e))


def test_uav_hangs_where_the_marker_has_the_pose_asked_for(scene) -> None:
    data = mujoco.MjData(scene.model)
    data.qpos[:] = scene.qpos(POSITION, QUAT)
    mujoco.mj_kinematics(scene.model, data)
    mujoco.mj_camlight(scene.model, data)
    position, quat = marker_pose(scene.model, data)
    np.testing.assert_allclose(position, POSITION, atol=1e-9)
    np.testing.assert_allclose(matrix(quat), matrix(QUAT), atol=1e-9)
    # The hinge plate hangs level whatever the UAV's tilt.
    np.testing.assert_allclose(data.body("uav/plate").xmat.reshape(3, 3)[:, 2], [0.0, 0.0, 1.0], atol=1e-9)


def test_scene_is_the_landings_own_with_the_marker_printed(scene) -> None:
    plant = build_scene(load_scenario("landing"), "free").model
    assert (scene.model.nq, scene.model.ngeom, scene.model.npair) == (plant.nq, plant.ngeom, plant.npair)
    np.testing.assert_array_equal(scene.model.geom_pos, plant.geom_pos)
    np.testing.assert_array_equal(scene.model.body_mass, plant.body_mass)


def test_field_of_view_is_the_cameras(scene) -> None:
    k = scene.intrinsics
    assert np.rad2deg(2.0 * np.arctan(0.5 * scene.height / k.fy)) == pytest.approx(48.0)
    assert np.rad2deg(2.0 * np.arctan(0.5 * scene.width / k.fx)) == pytest.approx(60.0, abs=0.1)


def test_renderer_is_a_pinhole_and_shows_the_print_upright(scene) -> None:
    image = drawn(scene, (POSITION, QUAT))[0]
    assert image.shape == (scene.height, scene.width)
    (found,) = detect(image, scene.size_m, scene.intrinsics)
    assert found.marker == NUMBER
    np.testing.assert_allclose(found.position, POSITION, atol=5e-5)
    np.testing.assert_allclose(matrix(found.quat), matrix(QUAT), atol=1e-3)


def test_stream_draws_what_frames_draws(scene) -> None:
    image = drawn(scene, (POSITION, QUAT))[0]
    with FrameStream(scene.model, scene.width, scene.height, EYE) as stream:
        stream.draw(scene.home)
        np.testing.assert_array_equal(stream.draw(scene.qpos(POSITION, QUAT)), image)


def test_marker_behind_the_hinge_plate_is_not_found() -> None:
    hidden = build_marker_scene(load_scenario("landing", {"camera": {"marker_m": [0.0, 0.0, -0.035]}}))
    image = drawn(hidden, (np.array([0.0, 0.0, 0.4]), FACING))[0]
    assert detect(image, hidden.size_m, hidden.intrinsics) == []
