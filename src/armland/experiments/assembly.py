"""Puts an experiment of a scenario together: plant, controller with its own arm model, path."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.control.backstepping import GRAVITY, BacksteppingGains, UavParameters, check
from armland.control.coordinated import ACCELERATIONS, EXTRA_TORQUES, LAWS, SUPPORTS, parameters_layout
from armland.control.gains import Design, Wanted, onboard_rule, rule
from armland.control.margins import Delays
from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.controller import CoordinatedController
from armland.mission.trajectory import Leg, legs, sample
from armland.models.arm import ArmModel
from armland.models.parameters import arm_model, rotor_mixer
from armland.models.workspace import check_path, home_poses, upright
from armland.plant.demonstrator import Demonstrator
from armland.plant.devices import DERIVATIVE_LAG_S
from armland.records import Tick
from armland.rotations import Array
from armland.scenario import Onboard, Poles, Scenario

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
    scenario = tuned(scenario, experiment)
    parameters = controller_parameters(scenario, experiment, arm, workplace)
    controller = CoordinatedController(arm, workplace.path, parameters, scenario.control.coriolis_feedforward)
    plant = Demonstrator(scenario, workplace.home, scenario.control.thrust_n)
    return Assembly(plant, controller, Tick(arm.joints))


def controller_parameters(scenario: Scenario, experiment: str, arm: ArmModel, workplace: Workplace) -> NDArray[np.void]:
    """The controller's parameters (1,) of `parameters_layout` for one row of Table II."""
    c, u, e = scenario.control, scenario.uav, scenario.experiments[experiment]
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
    p["law"], p["extra_torque"] = LAWS.index(e.law), EXTRA_TORQUES.index(e.extra_torque)
    p["acceleration"], p["support"] = ACCELERATIONS.index(e.acceleration), SUPPORTS.index(e.support)
    p["k3_attitude"] = c.k3_attitude or c.k3
    p["observer"] = c.observer_rad_s if e.observer else 0.0
    p["force_limit"], p["moment_limit"] = c.observer_limit_n, c.observer_limit_nm
    p["limited"], p["takeover_limit"] = e.limits, c.takeover_limit_n
    p["mixer_inverse"] = np.linalg.inv(rotor_mixer(scenario))
    p["rotor_min"], p["rotor_max"] = scenario.rotors.min_thrust_n, scenario.rotors.max_thrust_n
    p["torque_limit"] = scenario.link.torque_limit_nm
    p["preview"] = _preview(scenario)
    p["tool_weight"] = scenario.tool.tool_mass_kg * GRAVITY
    p["tau_max"], p["q_min"], p["q_max"] = arm.tau_max, arm.q_min, arm.q_max
    p["onboard_kp"], p["onboard_kd"] = scenario.onboard.kp_nm, scenario.onboard.kd_nms
    p["watchdog"] = round(scenario.link.watchdog_ms * scenario.run.rate_hz / 1000)
    p["tick_s"] = 1.0 / scenario.run.rate_hz
    return p


def tuned(scenario: Scenario, experiment: str) -> Scenario:
    """The scenario with the experiment's own attitude controller and, where it asks for the rule, the rule's gains.

    Raises:
        ConfigurationError: poles that the delays do not allow; the message says what they allow.
    """
    e = scenario.experiments[experiment]
    onboard, control = e.onboard or scenario.onboard, scenario.control
    if e.rule is not None:
        design = designed(scenario, e.rule, True, onboard)
        gains = design.gains
        onboard = onboard.model_copy(update={"kp_nm": tuple(design.kp), "kd_nms": tuple(design.kd)})
        update = {
            "k1": tuple(gains.k1),
            "k2": tuple(gains.k2),
            "k3": gains.k3_position,
            "k3_attitude": gains.k3_attitude,
        }
        control = control.model_copy(update=update)
    return scenario.model_copy(update={"onboard": onboard, "control": control})


def designed(scenario: Scenario, poles: Poles, on_board: bool = True, onboard: Onboard | None = None) -> Design:
    """Gains by rule with their margins: attitude feedback on board beside a feed-forward (X.6), or all of it over the link.

    Raises:
        ConfigurationError: poles that the delays do not allow.
    """
    u, link = scenario.uav, scenario.link
    onboard = onboard or Onboard(controller="cascade", lead_s=scenario.rotors.time_constant_s)
    uav = UavParameters(u.mass_kg, np.array(u.inertia_kgm2), np.array(u.lever_m))
    position = Wanted(poles.position_rad_s, poles.position_damping)
    attitude = Wanted(poles.attitude_rad_s, poles.attitude_damping)
    lag, arm_s, travel_s = scenario.rotors.time_constant_s, 1.5 / scenario.run.rate_hz, 1e-3 * link.uplink_delay_ms
    travel_s += 1e-3 * link.downlink_delay_ms + 0.5 / link.rate_hz
    if not on_board:
        return rule(position, attitude, uav, Delays(travel_s + 0.5 / onboard.rate_hz, arm_s, lag))
    if onboard.controller == "cascade":
        # The derivative makes up for the lag; what is left of it is the derivative's own low pass.
        lag = max(lag - onboard.lead_s, 0.0) + DERIVATIVE_LAG_S
    return onboard_rule(position, attitude, uav, Delays(1.0 / onboard.rate_hz, arm_s, lag), travel_s)


def _preview(scenario: Scenario) -> int:
    # A fed-forward torque is late by the uplink, half a cycle on board, and the rotors' lag.
    late_s = 1e-3 * scenario.link.uplink_delay_ms + 0.5 / scenario.onboard.rate_hz + scenario.rotors.time_constant_s
    return round(late_s * scenario.run.rate_hz)
