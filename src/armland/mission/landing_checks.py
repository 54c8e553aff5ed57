"""What a landing refuses before anything moves, by closed forms: a UAV that is too heavy, thresholds at which no capture holds."""

import numpy as np

from armland.errors import ConfigurationError
from armland.mission.landing_procedure import LANDING
from armland.mission.landing_scenario import Landing, LandingScenario
from armland.mission.launch import rotors_of
from armland.models.capture import GATE_M, Grip, covered_offset, lateral_speed_bound
from armland.models.inflow import sustained
from armland.models.uav import GRAVITY

BEYOND_M = 0.006
"""How far beyond the plate's face the arm would close."""

CLOSE_S = next(p.duration_s for p in LANDING if p.name == "close")


def check_weight(scenario: LandingScenario, mission: str, weight: float, trial: bool) -> None:
    """Refuse a UAV of `weight` N that the magnet cannot hold or the rotors cannot carry.

    Args:
        scenario: magnet and rotors.
        mission: `landing` or `takeoff`.
        weight: of all that flies, N.
        trial: whether a take-off with speed may be tried that momentum theory excludes.

    Raises:
        ConfigurationError: all that is too weak, each with the number and the bound.
    """
    landing, rotors = scenario.landing, scenario.demonstrator.rotors
    held = landing.envelope.hinge_force_share * landing.magnet_rating_n
    problems = []
    if weight > held:
        problems.append(
            f"the UAV weighs {weight:.1f} N; the magnet may be loaded with {held:.1f} N, "
            f"{landing.envelope.hinge_force_share:g} of its rating of {landing.magnet_rating_n:g} N: "
            f"at most {held / GRAVITY:.2f} kg can be held"
        )
    if mission == "takeoff" and landing.place.fly_on:
        speed = float(np.hypot(*landing.place.takeoff_velocity_mps[:2]))
        lift = sustained(rotors_of(landing, scenario.demonstrator), speed, landing.rotors.drag_nspm)
        if weight > lift and not trial:
            raise ConfigurationError(
                f"the UAV weighs {weight:.3f} N; at {speed:.2f} m/s its rotors carry {lift:.3f} N: at most "
                f"{lift / GRAVITY:.4f} kg can fly on at that speed"
            )
        return
    lift = 0.9 * 4.0 * rotors.max_thrust_n
    if weight > lift:
        problems.append(
            f"the UAV weighs {weight:.2f} N; its rotors give {4.0 * rotors.max_thrust_n:.2f} N, of which {lift:.2f} N may go "
            f"into hovering: at most {lift / GRAVITY:.3f} kg can fly"
        )
    if problems:
        raise ConfigurationError("\n  ".join(problems))


def check_capture(landing: Landing, mass: float) -> None:
    """Refuse thresholds at which the closed forms exclude a capture of a UAV of `mass` kg whatever else is ideal.

    Raises:
        ConfigurationError: the magnet would not be covered, or the supervisor would have given up.
    """
    b, grip = landing.bounds, Grip(rated_force=landing.magnet_rating_n)
    covered = covered_offset(grip)
    if b.align_offset_m >= covered:
        raise ConfigurationError(
            f"bounds.align_offset_m = {b.align_offset_m:g} m lets the arm close where the plate does not cover the magnet; "
            f"it must be below {covered:g} m, the plate's radius less that of the circle of pads"
        )
    # No approach of the mission is faster than the peak of its move: 35/16 of way over time.
    fastest = 35.0 / 16.0 * (landing.place.standoff_m + BEYOND_M) / CLOSE_S + b.align_speed_mps
    across = lateral_speed_bound(grip, mass, fastest, GATE_M)
    if b.align_speed_mps >= across:
        raise ConfigurationError(
            f"bounds.align_speed_mps = {b.align_speed_mps:g} m/s carries the plate off the magnet before it grips; "
            f"it must be below {across:.3f} m/s"
        )
    if b.align_tilt_deg >= landing.envelope.tilt_deg:
        raise ConfigurationError(
            f"bounds.align_tilt_deg = {b.align_tilt_deg:g} must be below envelope.tilt_deg = {landing.envelope.tilt_deg:g}, "
            "where the UAV counts as out of control"
        )
