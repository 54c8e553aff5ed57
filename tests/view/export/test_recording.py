"""The Rerun recording, read back chunk by chunk, holds the log's places, turns, curves and phases."""

import sys
from collections import defaultdict

import mujoco
import numpy as np
import pytest
from rerun.chunk import RrdReader
from scipy.spatial.transform import Rotation

from armland.errors import ConfigurationError
from armland.plant.scene.uav import UAV
from armland.records import MESSAGES
from armland.view.export.recording import entity, write_recording
from armland.view.film.stage import stage_of


@pytest.fixture(scope="module")
def chunks(sea_log, tmp_path_factory) -> dict[str, dict[str, list]]:
    """Entity -> component -> values, in the order of time."""
    path = write_recording(sea_log, tmp_path_factory.mktemp("rerun") / "run.rrd")
    found: dict[str, dict[str, list]] = defaultdict(lambda: defaultdict(list))
    for chunk in RrdReader(str(path)).stream():
        batch = chunk.to_record_batch()
        for name in batch.schema.names[1:]:
            found[chunk.entity_path][name] += batch.column(name).to_pylist()
    return found


def test_uav_moves_as_it_did(chunks, sea_log) -> None:
    stage = stage_of(sea_log, 1.0)
    uav = chunks[f"/{entity(stage.model, stage.scene.uav_body)}"]
    ticks = np.array(uav["tick"])
    truth = sea_log.messages["truth"][ticks]
    turn = Rotation.from_quat(np.array(uav["Transform3D:quaternion"]).reshape(-1, 4))
    place = np.array(uav["Transform3D:translation"]).reshape(-1, 3)
    pivot = place + turn.apply(stage.model.site(f"{UAV}pivot").pos)
    np.testing.assert_allclose(pivot, truth["r"], atol=1e-6)
    apart = turn * Rotation.from_quat(truth["quat"], scalar_first=True).inv()
    assert apart.magnitude().max() < 1e-5
    assert np.diff(ticks).tolist() == [10] * (len(ticks) - 1)


def test_every_field_is_a_curve_at_every_tick(chunks, sea_log) -> None:
    for message, fields in MESSAGES.items():
        for field in fields:
            if field.name == "tick":
                continue
            curve = chunks[f"/plots/{message}/{field.name}"]
            values = sea_log.messages[message][field.name].astype(float).reshape(len(sea_log.ticks), -1)
            np.testing.assert_array_equal(np.array(curve["Scalars:scalars"]).reshape(values.shape), values)
    names = chunks["/plots/truth/hinge_force"]["SeriesLines:names"][0]
    assert names == ["hinge_force 0 [N]", "hinge_force 1 [N]", "hinge_force 2 [N]"]
    time = chunks["/plots/truth/hinge_force"]["time"]
    assert time[7].total_seconds() == pytest.approx(0.007)


def test_phases_stand_as_events(chunks, sea_log) -> None:
    events = chunks["/events/phase"]
    phase, names = sea_log.messages["mission"]["phase"], sea_log.names("phases")
    rows = [0, *(np.flatnonzero(np.diff(phase)) + 1)]
    assert events["tick"] == rows
    assert [t[0] for t in events["TextLog:text"]] == [names[phase[k]] for k in rows]


def test_shapes_are_those_of_the_scene(chunks, sea_log) -> None:
    model = stage_of(sea_log, 1.0).model
    rail = model.geom("rail_1")
    body = entity(model, int(rail.bodyid[0]))
    shape = chunks[f"/{body}/shape_{rail.id}"]
    assert shape["Capsules3D:lengths"][0][0] == pytest.approx(2 * rail.size[1])
    half = Rotation.from_quat(shape["Capsules3D:quaternions"][0][0]).apply([0.0, 0.0, rail.size[1]])
    np.testing.assert_allclose(np.array(shape["Capsules3D:translations"][0][0]) + half, rail.pos, atol=1e-6)
    drawn = {c.rpartition("_")[2] for c in chunks if "/shape_" in c}
    planes = {int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD)}
    visible = {g for g in range(model.ngeom) if model.geom_group[g] <= 2 and model.geom_type[g] not in planes}
    assert {int(d) for d in drawn} == visible


def test_missing_package_says_how_to_get_it(sea_log, tmp_path, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "rerun", None)
    with pytest.raises(ConfigurationError, match=r"pip install 'armland\[export\]'"):
        write_recording(sea_log, tmp_path / "run.rrd")
    assert list(tmp_path.iterdir()) == []
