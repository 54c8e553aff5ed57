"""Descriptions of arms: reads MJCF and URDF files into MuJoCo specs and hangs the tool on the end effector."""

import xml.etree.ElementTree as ET
from importlib.resources import files
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.errors import ModelError
from armland.scenario.arm import Tool

ASSETS = Path(str(files("armland") / "assets"))
"""Folder of the arm and UAV descriptions that come with armland."""

EE_SITE = "armland_ee"
"""Site that marks the controlled point: the end effector frame, or the tool's tip where a tool is attached."""


def resolve(file: str) -> Path:
    """The file itself, or the description of that name that comes with armland."""
    return ASSETS / file if (ASSETS / file).is_file() else Path(file)


def read_spec(path: str | Path, what: str = "arm file") -> mujoco.MjSpec:
    """Read an arm, or what else `what` says, from an MJCF or URDF file.

    Fixed frames of a URDF are kept (an end effector usually is one). Its meshes are dropped: they are not needed for
    dynamics and are seldom where the file says.

    Raises:
        ModelError: the file is missing, cannot be parsed, or is not a description of an arm.
    """
    path = Path(path)
    if not path.is_file():
        raise ModelError(f"{what} {str(path)!r} does not exist; give an MJCF (.xml) or URDF (.urdf) file")
    try:
        root = ET.parse(path).getroot()
    except (ET.ParseError, UnicodeDecodeError) as e:
        raise ModelError(f"{what} {str(path)!r} is not well-formed XML: {e}") from e
    try:
        if root.tag == "robot":
            return _urdf_spec(root)
        if root.tag == "mujoco":
            return mujoco.MjSpec.from_file(str(path))
    except (ValueError, mujoco.FatalError) as e:
        raise ModelError(f"{what} {str(path)!r} cannot be read: {' '.join(str(e).split())}") from e
    raise ModelError(f"{what} {str(path)!r} has the root element <{root.tag}>; known are <robot> (URDF) and <mujoco>")


def _urdf_spec(root: ET.Element) -> mujoco.MjSpec:
    for link in root.iter("link"):
        for tag in ("visual", "collision"):
            for element in link.findall(tag):
                link.remove(element)
    for joint in root.findall("joint"):
        # MuJoCo knows no mimic or calibration elements; they carry no dynamics.
        for tag in ("mimic", "calibration", "safety_controller"):
            for element in joint.findall(tag):
                joint.remove(element)
    spec = mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    spec.compiler.fusestatic = False
    return spec


def frame_names(spec: mujoco.MjSpec) -> list[str]:
    """Names that can serve as an end effector: sites and bodies."""
    return [s.name for s in spec.sites if s.name] + [b.name for b in spec.bodies if b.name and b.name != "world"]


def mark_end_effector(spec: mujoco.MjSpec, frame: str, tool: Tool | None) -> None:
    """Put the site `EE_SITE` at `frame` (a site or body of `spec`), or at the tip of `tool` mounted there.

    Raises:
        ModelError: there is no such frame; the message names those there are.
    """
    site = next((s for s in spec.sites if s.name == frame), None)
    body = next((b for b in spec.bodies if b.name == frame), None)
    if site is None and body is None:
        known = ", ".join(frame_names(spec)) or "none"
        raise ModelError(f"the arm has no frame {frame!r}; its frames are: {known}")
    parent = site.parent if site is not None else body
    assert parent is not None
    pos = site.pos.copy() if site is not None else np.zeros(3)
    quat = site.quat.copy() if site is not None else np.array([1.0, 0.0, 0.0, 0.0])
    marked = parent.add_site(name=EE_SITE, pos=pos, quat=quat) if tool is None else _mount(parent, pos, quat, tool)
    if site is not None:
        # A file may also give the orientation as Euler angles or axes: only the compiler turns those into a quaternion.
        marked.alt = site.alt


def _mount(parent: mujoco.MjsBody, pos: NDArray, quat: NDArray, tool: Tool) -> mujoco.MjsBody:
    beyond = tool.length_m - tool.sensor_length_m
    sensor = parent.add_body(name="armland_sensor", pos=pos, quat=quat)
    _solid(sensor, tool.sensor_mass_kg, 0.5 * tool.sensor_length_m)
    _draw(sensor, tool.sensor_length_m, 0.04, [0.75, 0.77, 0.8, 1])
    body = sensor.add_body(name="armland_tool", pos=[0, 0, tool.sensor_length_m])
    _solid(body, tool.tool_mass_kg, tool.tool_com_m)
    _draw(body, beyond - 0.012, 0.028, [0.2, 0.22, 0.25, 1])
    # The force-torque sensor's origin: what the tool body puts on its parent is measured here.
    body.add_site(name="armland_fts")
    body.add_site(name=EE_SITE, pos=[0, 0, beyond])
    return sensor


def _solid(body: mujoco.MjsBody, mass: float, com: float) -> None:
    # A compact solid of 3 cm radius of gyration: small against the joints' reflected inertia.
    body.mass = mass
    body.ipos = [0, 0, com]
    body.inertia = [mass * 0.03**2] * 3
    body.explicitinertial = True


def _draw(body: mujoco.MjsBody, length: float, radius: float, colour: list[float]) -> None:
    # A cylinder along z that is seen and neither weighs nor touches.
    look = {"type": mujoco.mjtGeom.mjGEOM_CYLINDER, "mass": 0, "contype": 0, "conaffinity": 0, "group": 2}
    body.add_geom(fromto=[0, 0, 0, 0, 0, length], size=[radius, 0, 0], rgba=colour, **look)


def without_shapes(spec: mujoco.MjSpec) -> mujoco.MjSpec:
    """A copy without the shapes of bodies whose inertia is stated: what only computes dynamics need not place them in each tick."""
    bare = spec.copy()
    for body in bare.bodies:
        if body.explicitinertial:
            for geom in list(body.geoms):
                bare.delete(geom)
    if not bare.geoms:
        for mesh in list(bare.meshes):
            bare.delete(mesh)
    return bare


def compile_spec(spec: mujoco.MjSpec, what: str) -> mujoco.MjModel:
    """The model that a spec describes; `what` names it in messages.

    Raises:
        ModelError: what MuJoCo complains of.
    """
    try:
        return spec.compile()
    except (ValueError, mujoco.FatalError) as e:
        raise ModelError(f"{what} is not a valid model: {' '.join(str(e).split())}") from e
