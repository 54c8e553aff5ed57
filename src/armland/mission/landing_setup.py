"""From a landing's scenario to its controller: poses, parameters, and the refusals before anything moves."""

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.control.balance import balance_gains, fall_rate
from armland.control.exact import UavParameters
from armland.control.gains import Wanted, exact_gains
from armland.errors import ConfigurationError
from armland.estimation.contact import Contact, Switching, contact_parameters
from armland.estimation.plate import PoseFilter, pose_filter_parameters
from armland.estimation.wrench import Wrench, wrench_parameters
from armland.mission.bounds import thresholds, tuned
from armland.mission.landing_checks import BEYOND_M, check_capture, check_weight
from armland.mission.landing_procedure import LANDING
from armland.mission.landing_scenario import Landing, LandingScenario
from armland.mission.landing_state import parameters_layout
from armland.mission.landing_way import UPRIGHT, survey, targets
from armland.mission.launch import Launch, plan_launch, set_launch, timed
from armland.mission.launch_procedure import gives_speed, takeoff_phases
from armland.mission.phase_table import Table, compile_table
from armland.mission.phases import Phase
from armland.models.arm import ArmModel
from armland.models.parameters import arm_model
from armland.rotations import Array

GRAVITY = 9.81

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


def set_up(scenario: LandingScenario, mission: Literal["landing", "takeoff"] = "landing", trial: bool = False) -> Setup:
    """Everything that a controller needs, checked.

    Args:
        scenario: of `landing_scenario`.
        mission: landing or take-off.
        trial: whether a UAV may be too heavy for its rotors: for a study that wants to see it fall.

    Raises:
        ConfigurationError: contradictory thresholds, a UAV too heavy for magnet, arm or rotors.
        WorkspaceError: a place out of the arm's reach.
    """
    landing, demonstrator = scenario.landing, scenario.demonstrator
    arm = arm_model(demonstrator)
    if landing.place.home_deg is not None and len(landing.place.home_deg) != arm.joints:
        raise ConfigurationError(
            f"place.home_deg has {len(landing.place.home_deg)} values; the arm has {arm.joints} joints"
        )
    mass = demonstrator.uav.mass_kg + landing.plate_mass_kg + landing.extra_mass_kg
    check_weight(scenario, mission, mass * GRAVITY, trial)
    if mission == "landing":
        check_capture(landing, mass)
    phases = tuned(LANDING if mission == "landing" else takeoff_phases(landing), landing, mass * GRAVITY)
    tick_s = 1.0 / demonstrator.run.rate_hz
    table = compile_table(phases, thresholds(landing), tick_s)
    home = survey(arm, scenario, mission, mass * GRAVITY)
    launch: Launch | None = None
    if mission == "takeoff" and gives_speed(landing):
        launch = plan_launch(arm, home, landing, mass)
        phases = timed(phases, launch)
        table = compile_table(phases, thresholds(landing), tick_s)
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
        _parameters(scenario, arm, mission, phases, mass, launch),
        pose_filter_parameters(seen, tick_s),
        wrench_parameters(wrench, tick_s),
        contact_parameters(contact, tick_s),
    )


def _parameters(
    scenario: LandingScenario,
    arm: ArmModel,
    mission: str,
    phases: tuple[Phase, ...],
    mass: float,
    launch: Launch | None,
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
    p["standoff"], p["beyond"] = landing.place.standoff_m, BEYOND_M
    p["depth"] = landing.place.withdraw_m
    p["targets"] = targets(landing, phases)
    p["track"], p["track_a"], p["coast"] = 12.0, 3.0, 0.06
    p["admittance"], p["admittance_max"] = 3e-3, 4e-3
    p["camera"], p["drag"] = landing.eye.camera_m, landing.rotors.drag_nspm
    if launch is not None:
        set_launch(p, launch, landing, d, [phase.name for phase in phases])
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
    # m l a against the on-board attitude loop's stiffness, twice as much where it overshoots.
    p["tip"] = 2.0 * uav.mass * np.linalg.norm(uav.lever) / min(scenario.landing.onboard_kp_nm[:2])
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
    p["tilt_max"], p["slip"] = np.deg2rad(v.tilt_deg), v.slip_m
    p["rated"], p["magnet_share"], p["free_tolerance"] = landing.magnet_rating_n, 0.9, 2.5
    p["clear_z"] = landing.place.put_down_m[2] + 0.01
