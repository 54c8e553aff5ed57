"""A UAV on the pad: carried, slid and tipped as contact mechanics has it, worked by hand."""

import mujoco
import numpy as np
import pytest

from armland.mission.unaided.plan import places
from armland.plant.scene.pad import build_pad_scene
from armland.scenario import load_scenario

G = 9.81


@pytest.fixture(scope="module")
def pad_scene():
    kept = {}

    def made(**pad):
        key = tuple(sorted(pad.items()))
        if key not in kept:
            kept[key] = build_pad_scene(load_scenario("unassisted", {"pad": pad}))
        return kept[key]

    return made


def stood(scene, tilt_deg=0.0, seconds=0.6, about="y"):
    """The UAV put on the pad, gravity tilted by `tilt_deg` about x or y; data after `seconds`."""
    model, data = scene.model, mujoco.MjData(scene.model)
    t = np.deg2rad(tilt_deg)
    before = model.opt.gravity.copy()
    model.opt.gravity = G * np.array([np.sin(t), 0.0, -np.cos(t)] if about == "y" else [0.0, np.sin(t), -np.cos(t)])
    data.qpos[scene.uav_qpos[:3]] = scene.put_down - scene.lever
    data.qpos[scene.uav_qpos[3]] = 1.0
    for _ in range(round(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    model.opt.gravity = before
    return data


def momentum(scene, data):
    mujoco.mj_subtreeVel(scene.model, data)
    return scene.uav_mass * data.subtree_linvel[scene.uav_body][0]


def tilt_of(scene, data):
    return np.rad2deg(np.arccos(data.xmat[scene.uav_body].reshape(3, 3)[2, 2]))


def test_pad_carries_the_weight(pad_scene):
    scene = pad_scene()
    data = stood(scene)
    force = data.sensordata[scene.sensor["cradle_force"] :][:3]
    np.testing.assert_allclose(force, [0.0, 0.0, scene.uav_mass * G], atol=2e-3)
    assert np.linalg.norm(data.qvel[scene.uav_dof]) < 1e-3


def test_uav_stands_where_the_plan_says(pad_scene):
    scene = pad_scene()
    data = stood(scene)
    pivot = data.site("uav/pivot").xpos
    np.testing.assert_allclose(pivot, scene.put_down, atol=2e-4)
    stand, _ = places(load_scenario("unassisted"), scene.lever)
    np.testing.assert_allclose(stand, scene.put_down)


def test_skids_hold_below_the_angle_of_friction(pad_scene):
    # MuJoCo's friction creeps in the last degrees before it.
    scene = pad_scene(friction=0.4)
    held = stood(scene, np.rad2deg(np.arctan(0.4)) - 8.0)
    assert np.linalg.norm(held.qvel[scene.uav_dof[:3]]) < 1e-3


@pytest.mark.parametrize(("friction", "tilt"), [(0.2, 20.0), (0.3, 25.0)])
def test_beyond_it_they_slide_as_coulomb_has_it(pad_scene, friction, tilt):
    scene = pad_scene(friction=friction)
    t, begin, end = np.deg2rad(tilt), 0.1, 0.3
    # Of all that flies: the plate swings on its hinge meanwhile.
    first, second = (momentum(scene, stood(scene, tilt, s)) / scene.uav_mass for s in (begin, end))
    expected = G * (np.sin(t) - friction * np.cos(t))
    assert (second - first) / (end - begin) == pytest.approx(expected, rel=0.08)


@pytest.mark.parametrize(("about", "edge"), [("y", 0.156), ("x", 0.196)])
def test_uav_tips_over_its_skids_when_its_weight_points_beyond_them(pad_scene, about, edge):
    # Rough enough not to slide. The centre of mass stands 0.101 m high; the plate below it moves it by less than a degree.
    scene = pad_scene(friction=2.0)
    limit = np.rad2deg(np.arctan(edge / 0.101))
    assert tilt_of(scene, stood(scene, limit - 2.0, 0.4, about)) < 1.0
    assert tilt_of(scene, stood(scene, limit + 2.0, 0.4, about)) > 5.0


def test_a_drop_loses_its_energy(pad_scene):
    scene = pad_scene()
    model, data = scene.model, mujoco.MjData(scene.model)
    data.qpos[scene.uav_qpos[:3]] = scene.put_down - scene.lever + [0.0, 0.0, 0.02]
    data.qpos[scene.uav_qpos[3]] = 1.0
    heights = []
    for _ in range(600):
        mujoco.mj_step(model, data)
        heights.append(data.qpos[scene.uav_qpos[2]] - (scene.put_down - scene.lever)[2])
    # It falls 20 mm in 64 ms and then does not come back up by a tenth of that.
    assert min(heights) > -1e-3
    assert max(heights[100:]) < 2e-3


def test_camera_looks_up_at_the_marker(pad_scene):
    scene, s = pad_scene(), load_scenario("unassisted")
    data = stood(scene, seconds=0.01)
    eye, marker = data.cam("eye"), data.geom("uav/marker").xpos
    offset = marker - eye.xpos
    np.testing.assert_allclose(offset[:2], 0.0, atol=1e-3)
    assert s.camera.depth_min_m < offset[2] < 0.5
    ee = data.site("armland_ee").xpos + np.array(s.camera.position_m)
    np.testing.assert_allclose(ee, eye.xpos, atol=1e-9)


def test_there_is_no_arm_and_the_uav_is_the_same(pad_scene, landing):
    from armland.plant.scene.composition import build_scene

    scene, other = pad_scene(), build_scene(landing(), "free")
    assert scene.joints == 0
    assert scene.model.nu == 0
    assert scene.uav_mass == pytest.approx(other.uav_mass)
    np.testing.assert_allclose(scene.model.body_inertia[scene.uav_body], other.model.body_inertia[other.uav_body])


def test_at_sea_the_pad_moves_with_the_deck():
    scene = build_pad_scene(load_scenario("unassisted", {"sea": {"state": "ss2"}}))
    data = mujoco.MjData(scene.model)
    data.qpos[scene.uav_qpos[3]] = 1.0
    mujoco.mj_kinematics(scene.model, data)
    at_rest = data.body("pad").xpos.copy()
    data.qpos[scene.deck_qpos + 2] = 0.3
    mujoco.mj_kinematics(scene.model, data)
    np.testing.assert_allclose(data.body("pad").xpos - at_rest, [0.0, 0.0, 0.3], atol=1e-12)
