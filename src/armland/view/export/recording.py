"""A run as a Rerun recording: the scene in 3D, every field as curves, phases and faults as text, with named entities.

| entity | holds |
|---|---|
| `world/BODY` | attitude and place in W of a body, at `SHOWN_HZ`; its shapes below it |
| `world/paths/uav`, `world/paths/arm` | the ways of pivot and end effector |
| `plots/MESSAGE/FIELD` | the numbers of a field at every tick, named with unit |
| `events/phase`, `events/fault` | when one begins |

Timelines: `time` since the start in nanoseconds, and `tick`.
"""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.records import MESSAGES, Records
from armland.runtime.log import Log
from armland.view.film.stage import Stage, poses, stage_of

NEEDS_RERUN = "Rerun recordings need the Rerun SDK: pip install 'armland[export]'"

SHOWN_HZ = 100
"""How often a body's place is written."""

G = mujoco.mjtGeom
UNSEEN = (int(G.mjGEOM_PLANE), int(G.mjGEOM_HFIELD))
"""Shapes that are left out: the floor and the water, which have no end."""


def write_recording(log: Log, path: Path) -> Path:
    """Write the recording into the file `path`; returns it.

    Raises:
        ConfigurationError: the Rerun SDK is not installed.
        LogError: a log whose scene cannot be composed.
    """
    try:
        import rerun as rr
        import rerun.blueprint as rrb
    except ImportError as e:
        raise ConfigurationError(NEEDS_RERUN) from e
    stage = stage_of(log, 16 / 9)
    of_run = f"{log.metadata.get('experiment') or log.metadata['mission']}-{log.metadata['seed']}"
    with rr.RecordingStream("armland", recording_id=of_run, send_properties=False) as recording:
        recording.save(path, default_blueprint=_layout(rrb))
        recording.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        recording.log("about", rr.TextDocument(_about(log), media_type=rr.MediaType.MARKDOWN), static=True)
        _bodies(rr, recording, log, stage)
        _paths(rr, recording, log.messages["truth"])
        _curves(rr, recording, log)
        _events(rr, recording, log)
        recording.flush()
    return path


def _layout(rrb: Any) -> Any:
    scene = rrb.Spatial3DView(origin="/world", name="scene")
    curves = rrb.Vertical(
        rrb.TimeSeriesView(origin="/plots/truth/hinge_force", name="hinge force [N]"),
        rrb.TimeSeriesView(origin="/plots/truth/rotor_thrust", name="rotor thrust [N]"),
        rrb.TimeSeriesView(origin="/plots/proof", name="V₂ [J] and its rate [W]"),
        rrb.TimeSeriesView(origin="/plots/health/torque_ratio", name="joint torque over limit"),
    )
    events = rrb.TextLogView(origin="/events", name="phases and faults")
    return rrb.Blueprint(rrb.Horizontal(rrb.Vertical(scene, events, row_shares=[3, 1]), curves, column_shares=[3, 2]))


def _about(log: Log) -> str:
    shown = ("mission", "experiment", "law", "seed", "title", "arm", "version")
    return "\n".join(f"- {key}: {log.metadata[key]}" for key in shown if log.metadata.get(key))


def timelines(rr: Any, log: Log, rows: NDArray[np.intp]) -> list[Any]:
    """Time and tick of the rows (k,) of a log, as Rerun takes them."""
    tick = log.messages["measurement"]["tick"][rows]
    time = (tick * int(log.metadata["period_ns"])).astype("timedelta64[ns]")
    return [rr.TimeColumn("time", duration=time), rr.TimeColumn("tick", sequence=tick)]


def entity(model: mujoco.MjModel, body: int) -> str:
    """Path of a body, of letters that need no escape."""
    name = model.body(body).name or f"body_{body}"
    return "world/" + "".join(c if c.isalnum() or c in "_-/" else "_" for c in name)


def _bodies(rr: Any, recording: Any, log: Log, stage: Stage) -> None:
    model, truth = stage.model, log.messages["truth"]
    data, every = mujoco.MjData(model), max(round(1e9 / int(log.metadata["period_ns"]) / SHOWN_HZ), 1)
    rows = np.arange(0, len(truth), every)
    seen = [b for b in range(model.nbody) if any(_shown(model, g) for g in _geoms(model, b))]
    places, turns = np.zeros((len(seen), len(rows), 3)), np.zeros((len(seen), len(rows), 4))
    for k, q in enumerate(poses(stage.scene, truth[rows])):
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        places[:, k], turns[:, k] = data.xpos[seen], data.xquat[seen]
    times = timelines(rr, log, rows)
    for i, body in enumerate(seen):
        where = entity(model, body)
        # Rerun has the scalar last.
        moved = rr.Transform3D.columns(translation=places[i], quaternion=turns[i][:, [1, 2, 3, 0]])
        rr.send_columns(where, times, moved, recording=recording)
        for geom in _geoms(model, body):
            if _shown(model, geom):
                recording.log(f"{where}/shape_{geom}", _shape(rr, model, geom), static=True)


def _geoms(model: mujoco.MjModel, body: int) -> range:
    first = int(model.body_geomadr[body])
    return range(first, first + int(model.body_geomnum[body]))


def _shown(model: mujoco.MjModel, geom: int) -> bool:
    return bool(model.geom_group[geom] <= 2 and int(model.geom_type[geom]) not in UNSEEN)


def _shape(rr: Any, model: mujoco.MjModel, geom: int) -> Any:
    kind, size, material = int(model.geom_type[geom]), model.geom_size[geom], int(model.geom_matid[geom])
    color = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    quat = [model.geom_quat[geom][[1, 2, 3, 0]]]
    look = {"colors": [np.rint(255 * color).astype(np.uint8)], "fill_mode": "solid"}
    at = [model.geom_pos[geom]]
    if kind == int(G.mjGEOM_MESH):
        return _mesh(rr, model, geom, look["colors"][0])
    if kind == int(G.mjGEOM_BOX):
        return rr.Boxes3D(half_sizes=[size], centers=at, quaternions=quat, **look)
    if kind == int(G.mjGEOM_CYLINDER):
        return rr.Cylinders3D(lengths=[2 * size[1]], radii=[size[0]], centers=at, quaternions=quat, **look)
    if kind == int(G.mjGEOM_CAPSULE):
        # Rerun's begins at one end, MuJoCo's has its origin in the middle.
        axis = np.zeros(3)
        mujoco.mju_rotVecQuat(axis, np.array([0.0, 0.0, size[1]]), model.geom_quat[geom])
        return rr.Capsules3D(
            lengths=[2 * size[1]], radii=[size[0]], translations=[at[0] - axis], quaternions=quat, **look
        )
    radii = [size[0]] * 3 if kind == int(G.mjGEOM_SPHERE) else size
    return rr.Ellipsoids3D(half_sizes=[radii], centers=at, quaternions=quat, **look)


def _mesh(rr: Any, model: mujoco.MjModel, geom: int, color: NDArray[np.uint8]) -> Any:
    mesh = int(model.geom_dataid[geom])
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    faces = model.mesh_face[int(model.mesh_faceadr[mesh]) :][: int(model.mesh_facenum[mesh])]
    R = np.zeros(9)
    mujoco.mju_quat2Mat(R, model.geom_quat[geom])
    points = model.mesh_vert[first : first + count] @ R.reshape(3, 3).T + model.geom_pos[geom]
    return rr.Mesh3D(vertex_positions=points, triangle_indices=faces, albedo_factor=color)


def _paths(rr: Any, recording: Any, truth: Records) -> None:
    for name, field, color in (("uav", "r", (0, 114, 178)), ("arm", "ee", (213, 94, 0))):
        line = rr.LineStrips3D([truth[field][::10]], colors=[color], radii=[0.0015])
        recording.log(f"world/paths/{name}", line, static=True)


def _curves(rr: Any, recording: Any, log: Log) -> None:
    times = timelines(rr, log, np.arange(len(log.messages["truth"])))
    for message, fields in MESSAGES.items():
        for field in fields:
            if field.name == "tick":
                continue
            values = log.messages[message][field.name].astype(float)
            flat = values.reshape(len(values), -1)
            where, number = f"plots/{message}/{field.name}", flat.shape[1]
            ends = [""] if values.ndim == 1 else [f" {i}" for i in range(number)]
            names = [f"{field.name}{end} [{field.unit}]" for end in ends]
            recording.log(where, rr.SeriesLines(names=names), static=True)
            columns = rr.Scalars.columns(scalars=flat.ravel())
            rr.send_columns(
                where, times, columns if number == 1 else columns.partition([number] * len(flat)), recording=recording
            )


def _events(rr: Any, recording: Any, log: Log) -> None:
    for what, names, level in (("phase", "phases", "INFO"), ("fault", "faults", "ERROR")):
        numbers, words = log.messages["mission"][what], log.names(names)
        rows = np.flatnonzero(np.diff(numbers, prepend=numbers[:1] if what == "fault" else -1))
        if len(rows):
            texts = [words[int(n)] if 0 <= n < len(words) else str(n) for n in numbers[rows]]
            columns = rr.TextLog.columns(text=texts, level=[level] * len(texts))
            rr.send_columns(f"events/{what}", timelines(rr, log, rows), columns, recording=recording)
