"""From a landing's scenario to its controller: poses, parameters, and the refusals before anything moves."""

from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.control.balance import balance_gains, fall_rate
from armland.control.exact import UavParameters
from armland.control.gains import Wanted, exact_gains
from armland.errors import ConfigurationError, WorkspaceError
from armland.estimation.contact import Contact, Switching, contact_parameters
from armland.estimation.plate import PoseFilter, pose_filter_parameters
from armland.estimation.wrench import Wrench, wrench_parameters
from armland.mission.bounds import thresholds, tuned
from armland.mission.landing_procedure import LANDING
from armland.mission.landing_scenario import Landing, LandingScenario
from armland.mission.landing_state import parameters_layout
from armland.mission.phases import Phase, Table, compile_table
from armland.mission.takeoff_procedure import TAKEOFF
from armland.models.arm import ArmModel
from armland.models.parameters import arm_model
from armland.models.workspace import check_path
from armland.rotations import Array, rotation_error

GRAVITY = 9.81

UPRIGHT = np.eye(3)
"""End effector's orientation: pointing up, its x axis along the world's, so that the camera looks beside the UAV's nose."""

POSITION = Wanted(30.0, 1.0)
"""Poles of the held UAV's position."""


class Setup(NamedTuple):
    """What a mission's controller is made of."""

    scenario: LandingScenario
    mission: Literal["landing", "takeoff"]
    arm: ArmModel
    home: Array  # (n,) rad
    phases: tuple[Phase, ...]
    table: Table
    parameters: NDArray[np.void]
    filter: NDArray[np.void]
    wrench: NDArray[np.void]
    contact: NDArray[np.void]


def set_up(scenario: LandingScenario, mission: Literal["landing", "takeoff"] = "landing") -> Setup:
    """Everything that a controller needs, checked.

    Raises:
        ConfigurationError: contradictory thresholds, a UAV too heavy for magnet, arm or rotors.
        WorkspaceError: a place out of the arm's reach.
    """
    landing, demonstrator = scenario.landing, scenario.demonstrator
    arm = arm_model(demonstrator)
    if len(landing.place.home_deg) != arm.joints:
        raise ConfigurationError(
            f"place.home_deg has {len(landing.place.home_deg)} values; the arm has {arm.joints} joints"
        )
    mass = demonstrator.uav.mass_kg + landing.plate_mass_kg + landing.extra_mass_kg
    _check_weight(scenario, mass * GRAVITY)
    phases = tuned(LANDING if mission == "landing" else TAKEOFF, landing, mass * GRAVITY)
    tick_s = 1.0 / demonstrator.run.rate_hz
    table = compile_table(phases, thresholds(landing), tick_s)
    home = _survey(arm, scenario, mission, mass * GRAVITY)
    eye = landing.eye
    seen = PoseFilter(
        mass=mass,
        marker_offset=eye.marker_m,
        plate_offset=demonstrator.uav.lever_m,
        sigma_attitude=demonstrator.sensors.attitude_rad,
        sigma_rate=demonstrator.sensors.rate_rad_s,
    )
    tool, sensors = demonstrator.tool, demonstrator.sensors
    gain = 1.0 - np.exp(-2.0 * np.pi * sensors.force_filter_hz * tick_s)
    sigma = (max(sensors.force_n, 1e-3), max(sensors.torque_nm, 1e-4))
    wrench = Wrench(tool.tool_mass_kg, (0.0, 0.0, tool.tool_com_m), rate=(5.0, 0.2), sigma=sigma, filter_gain=gain)
    contact = Contact(weight_n=mass * GRAVITY, contact_n=Switching(1.2, 0.6, 0.004, 0.10))
    return Setup(
        scenario,
        mission,
        arm,
        home,
        phases,
        table,
        _parameters(scenario, arm, mission, phases, mass),
        pose_filter_parameters(seen, tick_s),
        wrench_parameters(wrench, tick_s),
        contact_parameters(contact, tick_s),
    )


def _check_weight(scenario: LandingScenario, weight: float) -> None:
    landing, rotors = scenario.landing, scenario.demonstrator.rotors
    held = landing.envelope.hinge_force_share * landing.magnet_rating_n
    if weight > held:
        raise ConfigurationError(
            f"the UAV weighs {weight:.1f} N; the magnet may be loaded with {held:.1f} N, "
            f"{landing.envelope.hinge_force_share:g} of its rating of {landing.magnet_rating_n:g} N: "
            f"at most {held / GRAVITY:.2f} kg can be held"
        )
    lift = 0.9 * 4.0 * rotors.max_thrust_n
    if weight > lift:
        raise ConfigurationError(
            f"the UAV weighs {weight:.2f} N; its rotors give {4.0 * rotors.max_thrust_n:.2f} N, of which {lift:.2f} N may go "
            f"into hovering: at most {lift / GRAVITY:.3f} kg can fly"
        )


def way_points(landing: Landing, mission: str) -> list[Array]:
    """End effector positions (3,) m that a mission visits, in order."""
    place = landing.place
    catch, down = np.array(place.catch_m), np.array(place.put_down_m)
    e = np.array([0.0, 0.0, 1.0])
    wait, above = catch - place.wait_below_m * e, down + place.above_m * e
    if mission == "takeoff":
        return [down - place.withdraw_m * e, down, above, catch, catch - place.withdraw_m * e]
    return [wait, catch, above, down, down - place.withdraw_m * e]


def _survey(arm: ArmModel, scenario: LandingScenario, mission: str, weight: float) -> Array:
    """Joint positions (n,) at the mission's first way point.

    Raises:
        WorkspaceError: a way point out of reach.
        ConfigurationError: joint torques beyond their limits.
    """
    landing = scenario.landing
    points = way_points(landing, mission)
    near = np.deg2rad(landing.place.home_deg)
    # From the pose that is known the arm is led to the first way point: no other branch of the kinematics comes in.
    arm.update(near, np.zeros(arm.joints))
    lead = np.linspace(arm.position.copy(), points[0], 25)
    q = near
    for point in lead:
        q = _solve(arm, q, point)
    fine = np.concatenate([np.linspace(a, b, 20) for a, b in pairwise(points)])
    try:
        check_path(arm, q, UPRIGHT, fine, np.arange(len(fine), dtype=float))
    except WorkspaceError as refusal:
        text = str(refusal).replace(
            "the trajectory leaves the workspace at t =", "the way of the landing leaves it at point"
        )
        raise WorkspaceError(
            f"{text} (place.catch_m = {landing.place.catch_m}, put_down_m = {landing.place.put_down_m})"
        ) from refusal
    _check_torque(arm, q, fine, weight)
    return q


def _check_torque(arm: ArmModel, q: Array, points: Array, weight: float) -> None:
    for point in points[::4]:
        q = _solve(arm, q, point)
        # Half again as much as at rest, for what it takes to move it.
        needed = np.abs(arm.gravity + 1.5 * weight * arm.jacobian[2])
        worst = int((needed / arm.tau_max).argmax())
        if needed[worst] > 0.9 * arm.tau_max[worst]:
            raise ConfigurationError(
                f"joint {arm.joint_names[worst]} would need {needed[worst]:.0f} N·m to carry a UAV of {weight:.1f} N at "
                f"({', '.join(f'{x:.2f}' for x in point)}) m; 0.9 of its limit is {0.9 * arm.tau_max[worst]:.0f} N·m"
            )


def _solve(arm: ArmModel, q: Array, point: Array) -> Array:
    for _ in range(30):
        arm.update(q, np.zeros(arm.joints))
        e = np.concatenate([point - arm.position, rotation_error(arm.rotation.copy(), UPRIGHT)])
        if np.abs(e).max() < 1e-8:
            break
        J = arm.jacobian
        q = np.clip(q + J.T @ np.linalg.solve(J @ J.T + 1e-8 * np.eye(6), e), arm.q_min, arm.q_max)
    return q


def _targets(landing: Landing, phases: tuple[Phase, ...]) -> Array:
    place, up = landing.place, np.array([0.0, 0.0, 1.0])
    catch, down = np.array(place.catch_m), np.array(place.put_down_m)
    known = {
        "carry": down + place.above_m * up,
        # A little further than the rails, so that it arrives there with speed.
        "set_down": down - 0.004 * up,
        "reach": down - 0.02 * up,
        # A little further than the plate's face, so that all pads touch.
        "touch": down + 0.001 * up,
        "lift": down + place.above_m * up,
        "carry_up": catch,
    }
    return np.array([known.get(p.name, catch) for p in phases])


def _parameters(
    scenario: LandingScenario, arm: ArmModel, mission: str, phases: tuple[Phase, ...], mass: float
) -> NDArray[np.void]:
    landing, d = scenario.landing, scenario.demonstrator
    p = np.zeros(1, parameters_layout(arm.joints, len(phases)))
    rate = d.run.rate_hz
    p["tick_s"], p["mass"], p["body_mass"] = 1.0 / rate, mass, mass - landing.plate_mass_kg
    p["inertia"], p["lever"], p["weight"] = d.uav.inertia_kgm2, d.uav.lever_m, mass * GRAVITY
    p["station"], p["heading"] = landing.place.catch_m, 0.0
    if mission == "takeoff":
        # It flies off upwards, out of the arm's way.
        p["station"][0, 2] += landing.place.start_above_m
    p["uplink"] = round(d.link.uplink_delay_ms * rate / 1000)
    p["rotor_gain"] = 1.0 - np.exp(-1.0 / (rate * d.rotors.time_constant_s))
    p["thrust_rate"], p["force_slack"] = 3.0, 1.5
    p["thrust_min"], p["thrust_max"] = 4.0 * d.rotors.min_thrust_n + 0.1, 0.94 * 4.0 * d.rotors.max_thrust_n
    p["station_period"] = rate // 200
    p["k_free"], p["d_free"] = 25.0**2, 2.0 * 25.0
    uav = UavParameters(mass - landing.plate_mass_kg, np.array(d.uav.inertia_kgm2), np.array(d.uav.lever_m))
    gains = exact_gains(POSITION, np.array(landing.onboard_kp_nm), np.array(landing.onboard_kd_nms), uav)
    p["k1"], p["k2"], p["k3"], p["k3_attitude"] = gains.k1, gains.k2, gains.k3_position, gains.k3_attitude
    p["observer"], p["force_limit"] = 8.0, 6.0
    c = d.control
    p["orientation_kp"], p["orientation_kd"], p["R_d"] = c.orientation_kp, c.orientation_kd, UPRIGHT
    p["elbow"], p["elbow_force"], p["null_damping"] = arm.joints // 2, c.elbow_force_n, c.null_space_damping_nms
    p["range_margin"], p["range_stiffness"] = c.range_margin_rad, c.range_stiffness_nm
    p["q_min"], p["q_max"], p["tau_max"] = arm.q_min, arm.q_max, arm.tau_max
    p["qd_max"] = np.resize(landing.envelope.joint_speed_rad_s, arm.joints)
    p["standoff"], p["beyond"] = landing.place.standoff_m, 0.006
    p["depth"] = landing.place.withdraw_m
    p["targets"] = _targets(landing, phases)
    p["track"], p["track_a"], p["coast"] = 12.0, 3.0, 0.06
    p["admittance"], p["admittance_max"] = 3e-3, 4e-3
    p["camera"] = landing.eye.camera_m
    _balance(p, scenario, arm, uav, rate)
    _supervisor(p, landing, rate)
    return p


def _balance(p: NDArray[np.void], scenario: LandingScenario, arm: ArmModel, uav: UavParameters, rate: int) -> None:
    rate_of_fall, place = fall_rate(uav), scenario.landing.place
    p["fall_rate"], p["balance"] = rate_of_fall, balance_gains(rate_of_fall)
    v = scenario.landing.envelope
    p["push_max"], p["sway_max"], p["capture_max"] = v.balance_push_mps2, v.balance_reach_m, np.deg2rad(v.capture_deg)
    # The last joint but one tilts the tool: where it sits is the wrist. At this share the pivot may be fastest: 0.9 to 1.1 m/s
    # across the corners of its reach, against 0.6 m/s of the wrist alone and 0.3 m/s of the arm without it.
    p["swing"], p["wrist"] = 0.75, np.linalg.norm(arm.position - arm.anchor[-2])
    p["attitude_age"], p["lost"] = round(0.05 * rate), v.balance_reach_m * rate_of_fall**2 / GRAVITY
    p["down"], p["settle"], p["near"] = place.put_down_m[2], 0.025, 0.010


def _supervisor(p: NDArray[np.void], landing: Landing, rate: int) -> None:
    v = landing.envelope
    p["torque_rate"], p["speed_share"], p["joint_margin"] = v.torque_rate_nm_s, v.joint_speed_share, v.joint_margin_rad
    p["sigma_min"], p["uav_age"], p["camera_age"] = (
        v.sigma_min,
        round(v.uav_age_ms * rate / 1000),
        1e-3 * v.camera_age_ms,
    )
    p["arm_age"], p["wrench_age"] = round(v.arm_age_ms * rate / 1000), round(v.wrench_age_ms * rate / 1000)
    p["hinge_max"] = v.hinge_force_share * landing.magnet_rating_n
    p["tilt_max"], p["slip"] = np.deg2rad(v.tilt_deg), 0.02
    p["rated"], p["magnet_share"], p["free_tolerance"] = landing.magnet_rating_n, 0.9, 2.5
