"""From a scenario's sections to the models that controller and plant take."""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.models.arm import ArmModel
from armland.models.arm_file.reading import ArmFile, read_arm
from armland.models.arm_file.table import Asked
from armland.models.description import compile_spec, mark_end_effector, read_spec, resolve
from armland.models.uav import UavParameters, mixer
from armland.rotations import Array, matrix
from armland.scenario import Scenario


def arm_file(scenario: Scenario) -> ArmFile:
    """What is taken for true of a scenario's arm: its chain, and a value with its source for each limit.

    Raises:
        ModelError: a file that cannot be used.
        ConfigurationError: another number of limits than the arm has joints.
    """
    a = scenario.arm
    lock = tuple(sorted(a.lock.items()))
    asked = Asked(a.ee, lock, a.torque_limits_nm, a.joint_speed_rad_s, a.torque_rate_nm_s, a.default_armature_kgm2)
    return read_arm(resolve(a.file), asked)


def arm_spec(scenario: Scenario) -> mujoco.MjSpec:
    """The arm of a scenario with its tool and end effector marked, not yet compiled; errors as for `arm_file`."""
    file = arm_file(scenario)
    spec = file.spec()
    mark_end_effector(spec, file.frame, scenario.tool)
    return spec


def arm_model(scenario: Scenario) -> ArmModel:
    """The arm model of a scenario, tool included; the controller's own is made from what it believes.

    Raises:
        ModelError: a file that cannot be used.
    """
    gravity = scenario.environment.gravity_mps2
    what, scale = f"arm file {scenario.arm.file!r}", scenario.arm.inertia_scale
    return ArmModel(arm_spec(scenario), what, scale, gravity, arm_file(scenario).rows)


class _Frame(NamedTuple):
    """What a UAV's file says, positions from its centre of mass, body axes."""

    mass: float
    inertia: Array
    pivot: Array
    rotors: Array


STEEL_KGM3 = 7850.0

ROTORS = 4

ROTOR_SITES = tuple(f"rotor_{i + 1}" for i in range(ROTORS))
"""Where the rotors are in a UAV's file."""


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


def uav_file(scenario: Scenario) -> mujoco.MjSpec:
    """The UAV's file: its body `uav`, the sites `cm` and `pivot` and one site for each rotor, all of which it has.

    Raises:
        ModelError: a file that cannot be used; the message names what it lacks.
    """
    spec, names = read_spec(resolve(scenario.uav.file), "UAV file"), ("uav", "cm", "pivot", *ROTOR_SITES)
    known = {s.name for s in spec.sites} | ({"uav"} & {b.name for b in spec.bodies})
    missing = [name for name in names if name not in known]
    if missing:
        raise ModelError(
            f"UAV file {scenario.uav.file!r} lacks {', '.join(missing)}; it needs a body 'uav' and the sites {', '.join(names[1:])}"
        )
    return spec


def _frame(scenario: Scenario) -> _Frame:
    model = compile_spec(uav_file(scenario), f"UAV file {scenario.uav.file!r}")
    body, cm = model.body("uav"), model.site("cm").pos
    R, places = matrix(body.iquat), np.array([model.site(name).pos - cm for name in ("pivot", *ROTOR_SITES)])
    return _Frame(float(body.mass[0]), R @ np.diag(body.inertia) @ R.T, places[0], places[1:])
