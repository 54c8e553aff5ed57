"""From a scenario's sections to the models that controller and plant take."""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.models.airframe.file import foreign_of, uav_file
from armland.models.airframe.rotor_set import RotorSet, alternating, check_rotors, effect_of
from armland.models.arm import ArmModel
from armland.models.arm_file.reading import ArmFile, read_arm
from armland.models.arm_file.table import Asked
from armland.models.description import compile_spec, mark_end_effector, resolve
from armland.models.uav import UavParameters
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


STEEL_KGM3 = 7850.0

STRAIGHT = 1e-9
"""A rotor's axis that leans by less, rad, stands upright."""


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


def rotor_set(scenario: Scenario) -> RotorSet:
    """The rotors about the centre of mass: what the section `rotors` says, else the sites `rotor_1`, `rotor_2` ... of the UAV's file.

    Raises:
        ModelError: the file cannot be used, or its rotors cannot hold the attitude.
    """
    r, model = scenario.rotors, compile_spec(uav_file(scenario), f"UAV file {scenario.uav.file!r}")
    cm, sites = model.site("cm").pos, _rotor_sites(model)
    place = np.array(r.place_m) if r.place_m is not None else np.array([model.site(s).pos - cm for s in sites])
    if r.axis is not None:
        axis = np.array([np.array(a) / np.linalg.norm(a) for a in r.axis])
    elif r.place_m is not None:
        axis = np.tile([0.0, 0.0, 1.0], (len(place), 1))
    else:
        axis = np.array([matrix(model.site(s).quat)[:, 2] for s in sites])
    axis[np.hypot(axis[:, 0], axis[:, 1]) < STRAIGHT] = [0.0, 0.0, 1.0]
    for name, given in (("axis", r.axis), ("spin", r.spin)):
        if given is not None and len(given) != len(place):
            raise ModelError(f"rotors.{name} has {len(given)} entries; the UAV has {len(place)} rotors")
    spin = np.array(r.spin, float) if r.spin is not None else _spin_of(scenario, place)
    found = RotorSet(place, axis, spin)
    check_rotors(found, r.drag_torque_m, scenario.uav.file)
    return found


def rotor_effect(scenario: Scenario) -> Array:
    """Thrust, torque and lateral force (6, n) of each rotor's thrust, of `airframe.rotor_set.effect_of`; errors as for `rotor_set`."""
    return effect_of(rotor_set(scenario), scenario.rotors.drag_torque_m)


def rotor_count(scenario: Scenario) -> int:
    """Number of rotors; errors as for `rotor_set`."""
    return rotor_set(scenario).number


def _spin_of(scenario: Scenario, place: Array) -> Array:
    told = foreign_of(scenario)
    known = told is not None and told.spin is not None and scenario.rotors.place_m is None
    return np.array(told.spin) if told is not None and known else alternating(place)


def _rotor_sites(model: mujoco.MjModel) -> list[str]:
    names = {model.site(i).name for i in range(model.nsite)}
    count = next(i for i in range(model.nsite + 1) if f"rotor_{i + 1}" not in names)
    return [f"rotor_{i + 1}" for i in range(count)]


def _frame(scenario: Scenario) -> _Frame:
    model = compile_spec(uav_file(scenario), f"UAV file {scenario.uav.file!r}")
    body, cm = model.body("uav"), model.site("cm").pos
    R = matrix(body.iquat)
    return _Frame(float(body.mass[0]), R @ np.diag(body.inertia) @ R.T, model.site("pivot").pos - cm)
