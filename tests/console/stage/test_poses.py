"""Poses: the scene of a log stands where the log's truth says, to rounding."""

import numpy as np
import pytest

from armland.console.stage.poses import Poses, armless_scene_of, forces_from, scene_of, to_world, turn_of
from armland.errors import LogError
from armland.experiments.episode import fly
from armland.plant.scene.eye import CAMERA
from armland.scenario import load_scenario


def check(ticks, metadata, rows) -> None:
    """The end effector, the UAV, its pivot and its plate stand where the truth has them: none of them is set directly but the UAV."""
    poses = Poses(scene_of(metadata))
    scene = poses.scene
    for k in rows:
        truth = ticks["truth"][k]
        poses.set(truth)
        places, turns = poses.bodies
        np.testing.assert_allclose(poses.end_effector, truth["ee"], rtol=0.0, atol=1e-9)
        np.testing.assert_allclose(poses._data.site("uav/pivot").xpos, truth["r"], rtol=0.0, atol=1e-9)
        assert abs(turns[scene.uav_body] @ truth["quat"]) == pytest.approx(1.0, abs=1e-12)
        if scene.plate_body >= 0:
            assert abs(turns[scene.plate_body] @ truth["plate_quat"]) == pytest.approx(1.0, abs=1e-12)
        assert np.isfinite(places).all()


def test_a_landing_stands_where_its_log_says(recording) -> None:
    check(recording.ticks, recording.log.metadata, range(0, len(recording.ticks), 499))


def test_an_experiment_on_the_hinge_too(paper) -> None:
    scenario = paper.replaced({"run": {"duration_s": 3.0}})
    episode = fly(scenario, "E1", 1)
    check(episode.ticks, episode.metadata, range(0, len(episode.ticks), 499))


@pytest.mark.parametrize(("mission", "sea"), [("tether", "calm"), ("hexapod", "ss2")])
def test_a_landing_without_an_arm_stands_on_its_pad(mission, sea) -> None:
    scenario = load_scenario(mission, {"run": {"duration_s": 1.0}, "sea": {"state": sea}})
    episode = fly(scenario, mission, 1)
    check(episode.ticks, episode.metadata, range(0, len(episode.ticks), 99))
    scene = scene_of(episode.metadata)
    assert scene.joints == 0
    assert scene.model.body("pad").id > 0
    assert not [b for b in range(scene.model.nbody) if scene.model.body(b).name.startswith("arm/")]


@pytest.mark.slow
def test_a_plant_that_differs_and_a_deck_that_moves_too(landing_scenario) -> None:
    scenario = landing_scenario.replaced({"sea": {"state": "ss2"}, "deviation": {"level": "published"}})
    episode = fly(scenario, "landing", 3)
    assert np.abs(episode.ticks["truth"]["deck_quat"][:, 1:]).max() > 0.01
    check(episode.ticks, episode.metadata, range(0, len(episode.ticks), 499))


def test_the_camera_looks_at_the_marker_in_flight(recording) -> None:
    poses = Poses(scene_of(recording.log.metadata))
    truth = recording.at(2.0)["truth"]
    poses.set(truth)
    place, quat = poses.camera(CAMERA)
    marker = poses._data.geom("uav/marker").xpos
    along = turn_of(quat) @ [0.0, 0.0, 1.0]
    to_marker = (marker - place) / np.linalg.norm(marker - place)
    assert along @ to_marker > 0.9
    assert poses.camera("none of that name") is None


def test_another_arm_is_refused(recording) -> None:
    from armland.records import tick_layout

    poses = Poses(scene_of(recording.log.metadata))
    with pytest.raises(LogError, match="6 joints, the arm of its scenario 7"):
        poses.set(np.zeros(1, tick_layout(6))["truth"][0])


@pytest.mark.parametrize("time", [0.5, 4.0, 9.0])
def test_without_the_arm_all_that_the_end_effector_carries_stands_as_with_it(recording, time) -> None:
    """The log's own arm is the oracle: the same scene, its joints unknown."""
    truth = recording.at(time)["truth"]
    whole, bare = Poses(recording.scene), Poses(armless_scene_of(recording.log.metadata), armless=True)
    for poses in (whole, bare):
        poses.set(truth)
    assert whole.absent == frozenset()
    assert {bare.model.body(b).name.split("/")[0] for b in bare.absent} == {"arm"}
    for body in range(whole.model.nbody):
        if body not in bare.absent:
            for got, wanted in zip(bare.bodies, whole.bodies, strict=True):
                wanted = wanted[body] * (1.0 if got[body] @ wanted[body] >= 0.0 else -1.0)
                np.testing.assert_allclose(got[body], wanted, atol=1e-9)
    np.testing.assert_allclose(bare.end_effector, truth["ee"], atol=1e-9)
    for got, wanted in zip(bare.camera(CAMERA), whole.camera(CAMERA), strict=True):
        np.testing.assert_allclose(got, wanted, atol=1e-9)


def test_damaged_numbers_are_no_picture_and_no_crash(recording) -> None:
    poses = Poses(scene_of(recording.log.metadata))
    tick = recording.ticks[:1].copy()
    tick["truth"]["quat"], tick["truth"]["plate_quat"] = np.nan, 0.0
    tick["truth"]["hinge_force"] = np.inf
    poses.set(tick["truth"][0])
    assert forces_from(tick["truth"][0]).tolist() == [0.0, 0.0, 0.0]
    np.testing.assert_array_equal(turn_of(np.zeros(4)), np.eye(3))


def test_points_of_the_deck_in_the_world(recording) -> None:
    truth = recording.ticks["truth"][:1].copy()
    points = np.array([[1.0, 0.0, 0.5]])
    np.testing.assert_array_equal(to_world(truth[0], points), points)
    half = np.deg2rad(45.0)
    truth["deck"], truth["deck_quat"] = [0.0, 0.0, 1.0], [np.cos(half), 0.0, 0.0, np.sin(half)]
    np.testing.assert_allclose(to_world(truth[0], points), [[0.0, 1.0, 1.5]], atol=1e-12)


def test_a_log_without_a_scene_is_refused() -> None:
    with pytest.raises(LogError, match="has no 'scenario'"):
        scene_of({"start": "air"})
    with pytest.raises(LogError, match="none of this version"):
        scene_of({"start": "air", "scenario": "{}"})
