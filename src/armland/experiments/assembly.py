"""Puts an experiment of a scenario together: plant, controller with its own arm model, path."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.control.backstepping import GRAVITY, BacksteppingGains, UavParameters, check
from armland.control.controller import CoordinatedController
from armland.control.coordinated import parameters_layout
from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.trajectory import Leg, legs, sample
from armland.models.arm import ArmModel
from armland.models.parameters import arm_model
from armland.models.workspace import check_path, home_poses, upright
from armland.plant.demonstrator import Demonstrator
from armland.records import Tick
from armland.rotations import Array
from armland.scenario import Scenario

CHECKED_HZ = 20
"""Rate at which the path is checked against the workspace before anything moves."""

CANDIDATES = 24
"""Home poses that are tried before a path is given up."""


class Workplace(NamedTuple):
    """What all experiments of a scenario share: where the arm starts and the path it follows."""

    home: Array  # (n,) rad
    R_d: Array  # (3, 3) end effector's orientation
    elbow: int
    legs: list[Leg]
    path: Array  # (ticks, 9)
    joint_margin: float  # rad, the smallest along the path


class Assembly(NamedTuple):
    """One experiment, ready to run."""

    plant: Demonstrator
    controller: CoordinatedController
    tick: Tick


def survey(scenario: Scenario) -> Workplace:
    """Find a home pose from which the arm can follow the whole path.

    Raises:
        ConfigurationError: unknown elbow joint, home of the wrong length, path outside the workspace.
    """
    arm = arm_model(scenario)
    elbow = _elbow(scenario, arm)
    near = _near(scenario, arm)
    start = None if scenario.trajectory.start_m is None else np.array(scenario.trajectory.start_m)
    refusal: WorkspaceError | None = None
    for pose in home_poses(arm, start, near, elbow)[:CANDIDATES]:
        try:
            return _workplace(scenario, arm, pose.q, elbow)
        except WorkspaceError as e:
            refusal = refusal or e
    assert refusal is not None
    raise refusal


def _workplace(scenario: Scenario, arm: ArmModel, home: Array, elbow: int) -> Workplace:
    arm.update(home, np.zeros(arm.joints))
    R_d = upright(arm.rotation)
    run = scenario.run
    path = legs(scenario.trajectory, arm.position.copy(), run.settle_s, run.tail_s)
    table = sample(path, run.rate_hz)
    every = max(run.rate_hz // CHECKED_HZ, 1)
    margin = check_path(arm, home, R_d, table[::every, :3], np.arange(0, len(table), every) / run.rate_hz)
    return Workplace(home, R_d, elbow, path, table, margin)


def _elbow(scenario: Scenario, arm: ArmModel) -> int:
    name = scenario.arm.elbow_joint
    if name is None:
        return arm.joints // 2
    if name not in arm.joint_names:
        raise ConfigurationError(
            f"arm.elbow_joint: the arm has no joint {name!r}; its joints are: {', '.join(arm.joint_names)}"
        )
    return arm.joint_names.index(name)


def _near(scenario: Scenario, arm: ArmModel) -> Array | None:
    home = scenario.arm.home_rad
    if home is None:
        return None
    if len(home) != arm.joints:
        raise ConfigurationError(
            f"arm.home_rad has {len(home)} values; the arm has {arm.joints} joints: {', '.join(arm.joint_names)}"
        )
    return np.array(home)


def assemble(scenario: Scenario, experiment: str, workplace: Workplace) -> Assembly:
    """Plant, controller and messages of one experiment of Table II.

    Raises:
        ConfigurationError: gains or UAV parameters for which the proof does not hold.
    """
    arm = arm_model(scenario)
    parameters = controller_parameters(scenario, experiment, arm, workplace)
    controller = CoordinatedController(arm, workplace.path, parameters, scenario.control.coriolis_feedforward)
    plant = Demonstrator(scenario, workplace.home, scenario.control.thrust_n)
    return Assembly(plant, controller, Tick(arm.joints))


def controller_parameters(scenario: Scenario, experiment: str, arm: ArmModel, workplace: Workplace) -> NDArray[np.void]:
    """The controller's parameters (1,) of `parameters_layout` for one row of Table II."""
    c, u, e = scenario.control, scenario.uav, scenario.experiments[experiment]  # type: ignore[index]
    uav = UavParameters(u.mass_kg, np.array(u.inertia_kgm2), np.array(u.lever_m))
    gains = BacksteppingGains(np.array(c.k1), np.array(c.k2), c.k3)
    check(uav, gains)
    p = np.zeros(1, parameters_layout(arm.joints))
    p["mass"], p["inertia"], p["lever"] = uav
    p["k1"], p["k2"], p["k3"] = gains
    p["orientation_kp"], p["orientation_kd"], p["R_d"] = c.orientation_kp, c.orientation_kd, workplace.R_d
    p["elbow"], p["elbow_force"], p["null_damping"] = workplace.elbow, c.elbow_force_n, c.null_space_damping_nms
    p["range_margin"], p["range_stiffness"] = c.range_margin_rad, c.range_stiffness_nm
    p["thrust"] = c.thrust_n
    p["extra_torque"], p["acceleration_feedforward"] = e.extra_torque, e.acceleration_feedforward
    p["measured_support"] = e.measured_support
    p["tool_weight"] = scenario.tool.tool_mass_kg * GRAVITY
    p["tau_max"], p["q_min"], p["q_max"] = arm.tau_max, arm.q_min, arm.q_max
    p["onboard_kp"], p["onboard_kd"] = scenario.onboard.kp_nm, scenario.onboard.kd_nms
    p["watchdog"] = round(scenario.link.watchdog_ms * scenario.run.rate_hz / 1000)
    p["tick_s"] = 1.0 / scenario.run.rate_hz
    return p
