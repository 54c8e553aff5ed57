"""Camera and marker in the scene are where the plant and the controller believe them to be, and hit nothing."""

import mujoco
import numpy as np
import pytest

from armland.errors import ModelError
from armland.plant.scene.composition import build_scene
from armland.plant.scene.eye import CAMERA, HOUSING, MARKER
from armland.plant.scene.uav import UAV
from armland.scenario.sensing import Camera

HOME = np.deg2rad([-3.0, -83.0, -6.0, -49.0, 11.0, 35.0, -11.0])
WAITING = np.deg2rad([-4.72, -109.96, -7.94, -71.39, 11.82, 39.34, -7.2])
EYE = Camera()


@pytest.fixture(scope="module")
def scene(landing):
    return build_scene(landing(), "free")


@pytest.fixture
def posed(scene):
    data = mujoco.MjData(scene.model)
    data.qpos[scene.joint_qpos] = HOME
    data.qpos[scene.uav_qpos] = [0.6, 0.1, 1.1, 0.96, 0.1, -0.2, 0.17]
    mujoco.mj_forward(scene.model, data)
    return data


def test_camera_stands_in_the_end_effectors_frame_and_looks_along_its_z(scene, posed):
    ee = posed.sensordata[scene.sensor["ee_pos"] :][:3]
    R = posed.body("armland_tool").xmat.reshape(3, 3)
    np.testing.assert_allclose(R.T @ (posed.cam(CAMERA).xpos - ee), EYE.position_m, atol=1e-12)
    # MuJoCo's camera looks along its -z.
    np.testing.assert_allclose(-posed.cam(CAMERA).xmat.reshape(3, 3)[:, 2], R[:, 2], atol=1e-12)


def test_markers_face_is_where_the_scenario_says_and_looks_down(scene, posed):
    cm, R = posed.site(f"{UAV}cm").xpos, posed.body(f"{UAV}uav").xmat.reshape(3, 3)
    plate, F = posed.geom(MARKER), posed.geom(MARKER).xmat.reshape(3, 3)
    face = plate.xpos + scene.model.geom(MARKER).size[2] * F[:, 2]
    np.testing.assert_allclose(R.T @ (face - cm), EYE.marker_m, atol=1e-12)
    np.testing.assert_allclose(F[:, 2], -R[:, 2], atol=1e-12)


def test_neither_adds_mass(scene):
    assert scene.uav_mass == pytest.approx(0.480 + 0.0478, abs=2e-4)
    assert scene.model.body("armland_tool").mass[0] == pytest.approx(0.30)


def test_housing_may_touch_rails_skids_and_frame(scene):
    model, own = scene.model, scene.model.geom(HOUSING).id
    pairs = zip(model.pair_geom1, model.pair_geom2, strict=True)
    others = {model.geom(int(a + b - own)).name for a, b in pairs if own in (a, b)}
    assert others == {"rail_1", "rail_2", *(f"{UAV}{part}_{i}" for part in ("skid", "frame") for i in (1, 2))}


@pytest.mark.parametrize(("camera", "free"), [(EYE.position_m, True), ((0.0, 0.115, -0.10), False)])
def test_housing_passes_between_the_rails_in_front_of_the_tool_and_not_beside_it(landing, camera, free):
    """From above the cradle to where the arm has withdrawn; beside the tool, the housing would hit a rail."""
    scene = build_scene(landing(camera={"position_m": camera}), "free")
    model, data = scene.model, mujoco.MjData(scene.model)
    # The arm with its end effector as in a landing, and the rails carried past it.
    data.qpos[scene.joint_qpos] = WAITING
    mujoco.mj_forward(model, data)
    cradle, ee = model.body("cradle").pos.copy(), data.sensordata[scene.sensor["ee_pos"] :][:3].copy()
    gaps = []
    for above in np.linspace(0.05, -0.06, 23):
        model.body("cradle").pos[:] = cradle + ee - scene.put_down - [0.0, 0.0, above]
        mujoco.mj_forward(model, data)
        for rail in ("rail_1", "rail_2"):
            own, other = model.geom(HOUSING).id, model.geom(rail).id
            gaps.append(mujoco.mj_geomDistance(model, data, own, other, 1.0, None))
    assert (min(gaps) > 0.07) == free
    assert (min(gaps) > 0.0) == free


def test_camera_inside_the_tool_is_refused(landing):
    with pytest.raises(ModelError, match=r"camera\.position_m = .* is 0\.02 m beside the tool's axis"):
        build_scene(landing(camera={"position_m": (0.02, 0.0, -0.10)}), "free")
