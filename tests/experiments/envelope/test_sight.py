"""On a landing the camera sees the whole marker until contact; with the skids nearer it does not."""

import mujoco
import numpy as np

from armland.experiments.envelope.sight import by_distance, glances, hinge_angles, put
from armland.plant.scene.composition import build_scene
from armland.rotations import from_rotation_vector, matrix


def test_scene_is_put_where_the_record_has_it(landed, landing_scenario):
    scene = build_scene(landing_scenario, "free")
    data, truth = mujoco.MjData(scene.model), landed.ticks["truth"][6000]
    put(scene, data, truth)
    mujoco.mj_forward(scene.model, data)
    for name in ("r", "plate_quat"):
        found = data.sensordata[scene.sensor[name] :][: truth[name].size]
        np.testing.assert_allclose(found, truth[name], atol=2e-3)


def test_camera_sees_the_whole_marker_from_the_start_to_the_contact(landed, landing_scenario):
    seen = glances(landed.ticks, tuple(landed.metadata["phases"].split(",")), landing_scenario)
    assert min(g.sight.seen for g in seen) == 1.0
    assert {g.phase for g in seen} >= {"guide", "approach", "align", "close", "capture"}
    bands = by_distance(seen)
    assert bands[0].near_m < 0.135 < 0.4 < bands[-1].far_m
    assert sum(b.exposures for b in bands) == len(seen)


def test_nearer_skids_hide_a_part_of_it(landed, landing_scenario):
    nearer = landing_scenario.replaced({"skids": {"x_m": 0.10}})
    seen = glances(landed.ticks, tuple(landed.metadata["phases"].split(",")), nearer)
    worst = min(seen, key=lambda g: g.sight.seen)
    assert worst.sight.seen < 0.95
    assert any("skid_1" in name for name in worst.sight.hidden_by)


def test_hinge_angles_are_those_of_the_rotations_in_turn():
    y, x, z = 0.3, -0.2, 0.7
    turns = [matrix(from_rotation_vector(a * np.eye(3)[i])) for a, i in ((y, 1), (x, 0), (z, 2))]
    np.testing.assert_allclose(hinge_angles(turns[0] @ turns[1] @ turns[2]), [y, x, z], atol=1e-12)
