"""What only the eye needs: the views have what they shall show in frame, and nothing of it weighs or touches."""

import mujoco
import numpy as np
import pytest

from armland.plant.scene.composition import build_scene
from armland.plant.scene.surroundings import VIEWS


@pytest.mark.parametrize(("view", "bodies"), [("overview", ["armland_tool"]), ("landing", ["armland_tool", "cradle"])])
def test_view_has_its_subject_in_frame(landing, view, bodies):
    scene = build_scene(landing(), "free")
    data = mujoco.MjData(scene.model)
    data.qpos[scene.joint_qpos] = np.deg2rad([-3.0, -83.0, -6.0, -49.0, 11.0, 35.0, -11.0])
    mujoco.mj_forward(scene.model, data)
    camera = data.cam(view)
    for body in bodies:
        x, y, z = camera.xmat.reshape(3, 3).T @ (data.body(body).xpos - camera.xpos)
        assert z < 0.0
        assert max(abs(x), abs(y)) < -z * np.tan(np.deg2rad(0.5 * VIEWS[view][2]))
        # Level: its x axis has no height.
        assert camera.xmat.reshape(3, 3)[2, 0] == pytest.approx(0.0, abs=1e-12)


def test_floor_weighs_nothing_and_is_seen(paper):
    model = build_scene(paper(), "hinged").model
    assert model.body_mass[0] == 0.0
    assert model.geom("floor").group[0] == 2
