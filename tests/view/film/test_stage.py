"""A film shows what was: places that MuJoCo finds in its scene are those of the log's truth, and all of it is in the picture."""

import mujoco
import numpy as np
import pytest

from armland.errors import LogError
from armland.experiments.episode import fly, prepare
from armland.plant.scene.uav import PLATE, UAV
from armland.runtime.log import Log, read_log
from armland.scenario import load_scenario
from armland.view.film.stage import CAMERA, SCENERY, extent, poses, stage_of


def shown(log: Log, every: int = 200) -> list[tuple[np.void, mujoco.MjData, object]]:
    """Truth and MuJoCo's places in the film, at some ticks."""
    stage, found = stage_of(log, 16 / 9), []
    truth = log.messages["truth"][::every]
    for row, q in zip(truth, poses(stage.scene, truth), strict=True):
        data = mujoco.MjData(stage.model)
        data.qpos[:] = q
        mujoco.mj_forward(stage.model, data)
        found.append((row, data, stage.scene))
    return found


def same_attitude(quat: np.ndarray, xmat: np.ndarray, atol: float) -> None:
    R = np.zeros(9)
    mujoco.mju_quat2Mat(R, quat)
    np.testing.assert_allclose(R, xmat, atol=atol)


@pytest.mark.parametrize("sea", ["calm", "ss2"])
def test_pictures_of_a_landing_without_an_arm_show_pad_and_truth(tmp_path, sea) -> None:
    scenario = load_scenario("hexapod", {"run": {"duration_s": 1.0}, "sea": {"state": sea}})
    fly(scenario, "hexapod", log=tmp_path / "a.mcap")
    log = read_log(tmp_path / "a.mcap")
    assert log.messages["truth"]["q"].shape[1] == 0
    found = shown(log)
    assert len(found) == 5
    for row, data, scene in found:
        np.testing.assert_allclose(data.site(f"{UAV}pivot").xpos, row["r"], atol=1e-9)
        same_attitude(row["quat"], data.site(f"{UAV}pivot").xmat, 1e-9)
        assert (mujoco.mj_name2id(scene.model, mujoco.mjtObj.mjOBJ_BODY, "platform") >= 0) == (sea != "calm")
        assert scene.model.body("pad").id > 0


@pytest.mark.parametrize("which", ["landing_log", "sea_log"])
def test_pictures_show_the_truth(which, request) -> None:
    found = shown(request.getfixturevalue(which))
    assert len(found) >= 5
    for row, data, _ in found:
        np.testing.assert_allclose(data.site(f"{UAV}pivot").xpos, row["r"], atol=1e-9)
        same_attitude(row["quat"], data.site(f"{UAV}pivot").xmat, 1e-9)
        same_attitude(row["plate_quat"], data.body(PLATE).xmat, 1e-6)
        np.testing.assert_allclose(data.site("armland_ee").xpos, row["ee"], atol=1e-9)
        same_attitude(row["ee_quat"], data.site("armland_ee").xmat, 1e-6)


def test_deck_is_where_it_was(sea_log) -> None:
    found = shown(sea_log)
    for row, data, _ in found:
        np.testing.assert_allclose(data.body("deck").xpos, row["deck"], atol=1e-9)
        same_attitude(row["deck_quat"], data.body("deck").xmat, 1e-9)
    # It moves, and the water with it.
    assert np.ptp([row["deck"][2] for row, *_ in found]) > 0.02


def test_hinged_uav_is_shown_on_the_arm(log_of) -> None:
    log = log_of(fly(load_scenario("paper", {"run": {"duration_s": 1.5}}), "E1"))
    for row, data, _ in shown(log):
        np.testing.assert_allclose(data.site(f"{UAV}pivot").xpos, row["r"], atol=1e-6)
        same_attitude(row["quat"], data.site(f"{UAV}pivot").xmat, 1e-6)


def test_cradle_stands_where_the_deviations_put_it(sea_log) -> None:
    scenario = load_scenario("landing", {"sea": {"state": "ss3"}, "deviation": {"level": "published"}})
    flown = prepare(scenario, "landing", seed=5).simulator.scene.model.body("cradle").pos
    told = prepare(load_scenario("landing"), "landing", seed=5).simulator.scene.model.body("cradle").pos
    np.testing.assert_allclose(stage_of(sea_log, 1.0).model.body("cradle").pos, flown, atol=1e-12)
    assert np.abs(flown - told).max() > 1e-4


@pytest.mark.parametrize("aspect", [16 / 9, 1.0])
def test_all_of_the_run_is_in_the_picture(landing_log, aspect) -> None:
    stage = stage_of(landing_log, aspect)
    qpos = poses(stage.scene, landing_log.messages["truth"][::500])
    middles, _ = extent(stage.scene, qpos)
    data = mujoco.MjData(stage.model)
    mujoco.mj_forward(stage.model, data)
    eye = data.cam(CAMERA)
    seen = (middles - eye.xpos) @ eye.xmat.reshape(3, 3)
    half = np.tan(0.5 * np.deg2rad(stage.model.cam_fovy[stage.model.camera(CAMERA).id]))
    assert (seen[:, 2] < 0.0).all()
    across, up = seen[:, 0] / -seen[:, 2] / (half * aspect), seen[:, 1] / -seen[:, 2] / half
    assert max(np.abs(across).max(), np.abs(up).max()) < 1.0
    # It fills the picture in one direction.
    assert max(np.ptp(across), np.ptp(up)) > 1.5


def test_floor_does_not_count_and_turning_blades_are_not_drawn(landing_log) -> None:
    model = stage_of(landing_log, 1.0).model
    assert "floor" in SCENERY
    materials = {model.mat(i).name for i in model.geom_matid if i >= 0}
    assert f"{UAV}disc" in materials
    assert f"{UAV}blade" not in materials


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"scenario": "{}"}, "does not know the log's scenario"),
        ({"scenario": None}, "holds no scenario"),
    ],
)
def test_log_without_a_scene_is_refused(landing_log, change, says) -> None:
    metadata = {k: v for k, v in {**landing_log.metadata, **change}.items() if v is not None}
    if change["scenario"] == "{}":
        metadata["scenario"] = '{"arm": 7}'
    with pytest.raises(LogError, match=says):
        stage_of(Log(landing_log.ticks, metadata, {}, True), 1.0)


def test_empty_and_damaged_logs_are_refused(landing_log) -> None:
    with pytest.raises(LogError, match="no tick"):
        stage_of(Log(landing_log.ticks[:0], landing_log.metadata, {}, True), 1.0)
    spoilt = landing_log.ticks[:3].copy()
    spoilt["truth"]["r"][1] = np.nan
    stage = stage_of(landing_log, 1.0)
    with pytest.raises(LogError, match="not finite"):
        poses(stage.scene, spoilt["truth"])
