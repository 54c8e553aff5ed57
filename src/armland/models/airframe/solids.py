"""The solids that a planner measures beside an arm's own shapes, added to its spec: links without shapes, tool, UAV, cradle."""

import mujoco
import numpy as np

from armland.models.airframe.body import add_skids, drawn
from armland.models.airframe.file import uav_file
from armland.models.airframe.rotor_set import beams
from armland.models.arm_file.spec import SHAPE
from armland.models.description import compile_spec
from armland.models.parameters import rotor_set
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.gear import Cradle

LINK_RADIUS_M, TOOL_RADIUS_M, BEAM_RADIUS_M = 0.06, 0.03, 0.015
"""Of the capsules along the links, around the tool, and of the beams that carry the rotors."""

MARKER_EDGE, MARKER_M = 10.0 / 8.0, 5e-4
"""Edge of the marker's plate over that of its black square, with a margin of one of eight cells, and half its thickness."""

OWN = ("tool", "sensor")
"""Names of what armland mounts on the arm."""


def add_links(spec: mujoco.MjSpec, model: mujoco.MjModel) -> list[str]:
    """Capsules from joint to joint along an arm's outer half, and along links without shapes; their names. `model` is of `spec`."""
    data, names = mujoco.MjData(model), []
    mujoco.mj_kinematics(model, data)
    shaped = {int(model.geom_bodyid[i]) for i in range(model.ngeom) if model.geom(i).name.startswith(SHAPE)}
    for i in range(model.njnt - 1):
        body = int(model.jnt_bodyid[i])
        if i < model.njnt // 2 and body in shaped:
            continue
        ends = (data.xanchor[[i, i + 1]] - data.xpos[body]) @ data.xmat[body].reshape(3, 3)
        if np.linalg.norm(ends[1] - ends[0]) < 2.0 * LINK_RADIUS_M:
            ends = ends.mean(axis=0) + np.array([[0.0, 0.0, -1e-4], [0.0, 0.0, 1e-4]])
        names.append(f"along_{i + 1}")
        _add_capsule(spec.joint(model.joint(i).name).parent, ends, LINK_RADIUS_M, names[-1])
    return names


def add_tool(spec: mujoco.MjSpec, scenario: Scenario) -> tuple[str, ...]:
    """The tool and its sensor; their names."""
    t = scenario.tool
    top = t.length_m - t.sensor_length_m - scenario.plate.drop_m - TOOL_RADIUS_M
    ends = np.array([[0.0, 0.0, -t.sensor_length_m], [0.0, 0.0, top]])
    tool, sensor = OWN
    _add_capsule(spec.body("armland_tool"), ends, TOOL_RADIUS_M, tool)
    spec.body("armland_sensor").geoms[0].name = sensor
    return OWN


def add_uav(spec: mujoco.MjSpec, scenario: Scenario) -> list[str]:
    """The UAV as the mocap body `uav`, its origin the centre of mass; names of its shapes."""
    body, model = spec.worldbody.add_body(name="uav", mocap=True), compile_spec(uav_file(scenario), "the UAV")
    cm = model.site("cm").pos
    for i, ends in enumerate(beams(rotor_set(scenario).place)):
        _add_capsule(body, np.array(ends), BEAM_RADIUS_M, f"beam_{i}")
    for g in drawn(model, model.body("uav").id):
        kind, at = mujoco.mjtGeom(int(model.geom_type[g])), {"pos": model.geom_pos[g] - cm, "quat": model.geom_quat[g]}
        body.add_geom(type=kind, size=model.geom_size[g], mass=0, contype=0, conaffinity=0, **at)
    add_skids(body, scenario.skids)
    c, kind = scenario.camera, mujoco.mjtGeom.mjGEOM_BOX
    size = [*(2 * [0.5 * MARKER_EDGE * c.marker_size_m]), MARKER_M]
    body.add_geom(
        type=kind, pos=np.array(c.marker_m) + [0.0, 0.0, MARKER_M], size=size, mass=0, contype=0, conaffinity=0
    )
    for i, geom in enumerate(body.geoms):
        geom.name, geom.contype, geom.conaffinity = f"uav_{i}", 0, 0
    return [geom.name for geom in body.geoms]


def add_cradle(spec: mujoco.MjSpec, scenario: Scenario) -> list[str]:
    """The cradle as the mocap body `cradle`, its origin the middle of the slot at the rails' upper edge; names of its shapes.

    Its legs are as for a height of 1 m above the floor: `stand_legs` gives them another.
    """
    c, body, names = scenario.cradle, spec.worldbody.add_body(name="cradle", mocap=True), []
    x, across, z = 0.5 * c.length_m, 0.5 * c.gap_m + c.radius_m, -c.radius_m
    for side in (-1.0, 1.0):
        y = side * across
        names += [f"rail{side:+.0f}", f"leg{side:+.0f}a", f"leg{side:+.0f}b"]
        _add_capsule(body, np.array([[-x, y, z], [x, y, z]]), c.radius_m, names[-3])
        for name, leg in zip(names[-2:], _legs(x, y, z, 1.0), strict=True):
            _add_capsule(body, leg, 0.7 * c.radius_m, name)
    return names


def stand_legs(model: mujoco.MjModel, cradle: Cradle, height: float) -> None:
    """Let the legs of a compiled `add_cradle` end on the floor, `height` m below the cradle's origin."""
    x, across, z = 0.5 * cradle.length_m, 0.5 * cradle.gap_m + cradle.radius_m, -cradle.radius_m
    for side in (-1.0, 1.0):
        for name, leg in zip("ab", _legs(x, side * across, z, height), strict=True):
            geom, way = model.geom(f"leg{side:+.0f}{name}").id, leg[1] - leg[0]
            length = float(np.linalg.norm(way))
            model.geom_pos[geom] = leg.mean(axis=0)
            mujoco.mju_quatZ2Vec(model.geom_quat[geom], way / length)
            model.geom_size[geom, 1] = 0.5 * length
            model.geom_rbound[geom] = model.geom_size[geom, 0] + 0.5 * length


def _legs(x: float, y: float, z: float, height: float) -> list[Array]:
    # Of the rail at y: upper and lower end of each, leaning outwards as far whatever their height.
    return [np.array([[foot, y, z], [foot, 1.5 * y, -height]]) for foot in (-0.3 * x, 0.8 * x)]


def _add_capsule(body: mujoco.MjsBody, ends: Array, radius: float, name: str) -> None:
    kind = mujoco.mjtGeom.mjGEOM_CAPSULE
    body.add_geom(name=name, type=kind, fromto=ends.ravel(), size=[radius, 0, 0], mass=0, contype=0, conaffinity=0)
