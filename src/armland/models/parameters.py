"""From a scenario's sections to the models that controller and plant take."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.errors import ModelError
from armland.models.arm import ArmModel
from armland.models.description import Tool, mark_end_effector, read_spec, resolve
from armland.models.uav import mixer
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
    """The controller's own arm model, tool included, with the scenario's deliberate error in mass and inertia.

    Raises:
        ModelError: a file that cannot be used.
    """
    return ArmModel(arm_spec(scenario), f"arm file {scenario.arm.file!r}", scenario.control.model_inertia_scale)


def tool_of(scenario: Scenario) -> Tool:
    """The tool on the flange."""
    t = scenario.tool
    return Tool(t.sensor_mass_kg, t.sensor_length_m, t.tool_mass_kg, t.tool_com_m, t.length_m)


def apply_default_armature(spec: mujoco.MjSpec, armature: float) -> None:
    """Give each joint without reflected motor inertia the default one, kg·m².

    Link inertias alone leave a wrist of about 1e-3 kg·m², on which the published orientation gains are unstable at 1 kHz.
    """
    for joint in spec.joints:
        if np.all(joint.armature == 0.0):
            joint.armature = armature


def rotor_mixer(scenario: Scenario) -> NDArray[np.float64]:
    """Allocation matrix (4, 4) of `models.uav.mixer` for the UAV's file: rotors about the centre of mass.

    Raises:
        ModelError: the file cannot be used or lacks a rotor's site or the centre of mass.
    """
    spec = read_spec(resolve(scenario.uav.file))
    sites = {s.name: s.pos.copy() for s in spec.sites}
    needed = ["cm", *(f"rotor_{i + 1}" for i in range(4))]
    missing = [n for n in needed if n not in sites]
    if missing:
        raise ModelError(f"UAV file {scenario.uav.file!r} lacks the sites {', '.join(missing)}")
    return mixer(np.array([sites[n] for n in needed[1:]]) - sites["cm"], scenario.rotors.drag_torque_m)
