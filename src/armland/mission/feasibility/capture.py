"""What a landing refuses before anything moves, by closed forms: thresholds at which no capture holds."""

from armland.errors import ConfigurationError
from armland.mission.missions.landing import LANDING
from armland.mission.reference.septic import PEAK
from armland.models.capture import GATE_M, Grip, covered_offset, lateral_speed_bound
from armland.scenario import Scenario


def grip_of(scenario: Scenario) -> Grip:
    """Magnet and plate of a believed scenario."""
    m, p = scenario.magnet, scenario.plate
    return Grip(
        plate_radius=p.radius_m,
        pad_radius=m.pad_radius_m,
        drop=p.drop_m,
        rated_force=m.rating_n,
        gap_scale=m.gap_scale_m,
        shear_share=m.shear_share,
        reach=m.reach_m,
    )


def check_capture(scenario: Scenario, mass: float) -> None:
    """Refuse thresholds at which the closed forms exclude a capture of a UAV of `mass` kg whatever else is ideal.

    Raises:
        ConfigurationError: the magnet would not be covered, or the supervisor would have given up.
    """
    b, grip = scenario.bounds, grip_of(scenario)
    covered = covered_offset(grip)
    if b.align_offset_m >= covered:
        raise ConfigurationError(
            f"bounds.align_offset_m = {b.align_offset_m:g} m lets the arm close where the plate does not cover the magnet; "
            f"it must be below {covered:g} m, the plate's radius less that of the circle of pads"
        )
    # No approach of the mission is faster than the peak of its move.
    duration = next(p.duration_s for p in LANDING.phases(scenario) if p.name == "close")
    gap = scenario.place.standoff_m + scenario.control.approach.beyond_m
    across = lateral_speed_bound(grip, mass, PEAK * gap / duration + b.align_speed_mps, GATE_M)
    if b.align_speed_mps >= across:
        raise ConfigurationError(
            f"bounds.align_speed_mps = {b.align_speed_mps:g} m/s carries the plate off the magnet before it grips; "
            f"it must be below {across:.3f} m/s"
        )
    if b.align_tilt_deg >= scenario.limits.tilt_deg:
        raise ConfigurationError(
            f"bounds.align_tilt_deg = {b.align_tilt_deg:g} must be below limits.tilt_deg = {scenario.limits.tilt_deg:g}, "
            "where the UAV counts as out of control"
        )
