"""From a scenario's sections to the models that controller and plant take."""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.models.arm import ArmModel
from armland.models.description import Tool, compile_spec, mark_end_effector, read_spec, resolve
from armland.models.uav import UavParameters, mixer
from armland.rotations import Array, matrix
from armland.scenario import Scenario


def arm_spec(scenario: Scenario) -> mujoco.MjSpec:
    """The arm of a scenario with its tool and end effector marked, not yet compiled.

    Raises:
        ModelError: missing or malformed file, unknown frame.
    """
    spec = read_spec(resolve(scenario.arm.file))
    mark_end_effector(spec, scenario.arm.ee, tool_of(scenario))
    apply_default_armature(spec, scenario.arm.default_armature_kgm2)
    return spec


def arm_model(scenario: Scenario) -> ArmModel:
    """The arm model of a scenario, tool included; the controller's own is made from what it believes.

    Raises:
        ModelError: a file that cannot be used.
    """
    gravity = scenario.environment.gravity_mps2
    return ArmModel(arm_spec(scenario), f"arm file {scenario.arm.file!r}", scenario.arm.inertia_scale, gravity)


def tool_of(scenario: Scenario) -> Tool:
    """Masses and lengths of force-torque sensor and magnet as the arm's description takes them."""
    t = scenario.tool
    return Tool(t.sensor_mass_kg, t.sensor_length_m, t.tool_mass_kg, t.tool_com_m, t.length_m)


def apply_default_armature(spec: mujoco.MjSpec, armature: float) -> None:
    """Give each joint without reflected motor inertia the default one, `armature` kg·m².

    Link inertias alone leave a wrist of about 1e-3 kg·m², on which the published orientation gains are unstable at 1 kHz.
    """
    for joint in spec.joints:
        if np.all(joint.armature == 0.0):
            joint.armature = armature


class _Frame(NamedTuple):
    """What a UAV's file says, positions from its centre of mass, body axes."""

    mass: float
    inertia: Array
    pivot: Array
    rotors: Array


STEEL_KGM3 = 7850.0


def uav_parameters(scenario: Scenario) -> UavParameters:
    """The body that the hinge carries: what the section `uav` says, else what its file says, and the extra mass; no plate.

    Raises:
        ModelError: the file cannot be used or lacks the body `uav` or a site.
    """
    u, frame = scenario.uav, _frame(scenario)
    mass = frame.mass if u.mass_kg is None else u.mass_kg
    inertia = frame.inertia if u.inertia_kgm2 is None else np.array(u.inertia_kgm2)
    lever = frame.pivot if u.lever_m is None else np.array(u.lever_m)
    return UavParameters(mass + u.extra_mass_kg, inertia, lever)


def plate_mass(scenario: Scenario) -> float:
    """Mass of the hinge plate, kg: as given, or that of a steel disc of its size."""
    plate = scenario.plate
    if plate.mass_kg is not None:
        return plate.mass_kg
    return float(np.pi * plate.radius_m**2 * plate.thickness_m * STEEL_KGM3)


def rotor_mixer(scenario: Scenario) -> Array:
    """Allocation matrix (4, 4) of `models.uav.mixer` for the UAV's file: rotors about the centre of mass.

    Raises:
        ModelError: the file cannot be used or lacks the body `uav` or a site.
    """
    return mixer(_frame(scenario).rotors, scenario.rotors.drag_torque_m)


def _frame(scenario: Scenario) -> _Frame:
    spec = read_spec(resolve(scenario.uav.file), "UAV file")
    what, sites = f"UAV file {scenario.uav.file!r}", ["cm", "pivot", *(f"rotor_{i + 1}" for i in range(4))]
    names = {s.name for s in spec.sites} | ({"uav"} if any(b.name == "uav" for b in spec.bodies) else set())
    missing = [n for n in ("uav", *sites) if n not in names]
    if missing:
        raise ModelError(f"{what} lacks {', '.join(missing)}; it needs a body 'uav' and the sites {', '.join(sites)}")
    model = compile_spec(spec, what)
    body, cm = model.body("uav"), model.site("cm").pos
    R, places = matrix(body.iquat), np.array([model.site(n).pos - cm for n in sites[1:]])
    return _Frame(float(body.mass[0]), R @ np.diag(body.inertia) @ R.T, places[0], places[1:])
