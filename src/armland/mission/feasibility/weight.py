"""What a mission refuses before anything moves: a UAV that magnet or rotors cannot carry."""

import numpy as np

from armland.errors import ConfigurationError
from armland.mission.belief import Flyer, rotors_of
from armland.mission.missions.takeoff import gives_speed
from armland.models.airframe.lift import lift_range
from armland.models.inflow import sustained
from armland.scenario import Scenario

HOVER_SHARE = 0.96
"""Of the largest lift that station keeping asks for, what may go into hovering: the rest stops a fall."""


def hover_max(scenario: Scenario, leans: bool = False) -> float:
    """Largest command, N, that may go into hovering: station keeping gives no more than leaves it its largest tilt.

    Args:
        scenario: believed.
        leans: whether it hovers leaning against wind, with that tilt in use and its command that of the lean.
    """
    c, (_, most) = scenario.control, lift_range(scenario)
    return HOVER_SHARE * c.thrust.ceiling * most * (1.0 if leans else float(np.cos(c.station.tilt_max_rad)))


def check_weight(scenario: Scenario, flyer: Flyer, flies_on: bool, trial: bool) -> None:
    """Refuse a UAV that the magnet cannot hold or the rotors cannot carry.

    Args:
        scenario: believed.
        flyer: what flies.
        flies_on: whether the mission leaves it at a speed that helps its rotors.
        trial: whether a take-off with speed may be tried that momentum theory excludes.

    Raises:
        ConfigurationError: all that is too weak, each with the number and the bound.
    """
    weight, g = flyer.weight, flyer.gravity
    rating, share = scenario.magnet.rating_n, scenario.limits.hinge_force_share
    held, (_, static) = share * rating, lift_range(scenario)
    problems = []
    if weight > held:
        problems.append(
            f"the UAV weighs {weight:.1f} N; the magnet may be loaded with {held:.1f} N, "
            f"{share:g} of its rating of {rating:g} N: at most {held / g:.2f} kg can be held"
        )
    if flies_on:
        speed = float(np.hypot(*scenario.place.takeoff_velocity_mps[:2]))
        lift = sustained(rotors_of(scenario), speed, scenario.uav.drag_nspm)
        if weight > lift and not trial:
            problems.append(
                f"the UAV weighs {weight:.3f} N; at {speed:.2f} m/s its rotors carry {lift:.3f} N: at most "
                f"{lift / g:.4f} kg can fly on at that speed"
            )
    elif weight > (lift := hover_max(scenario)):
        problems.append(
            f"the UAV weighs {weight:.2f} N; its rotors give {static:.2f} N, of which {lift:.2f} N may go "
            f"into hovering: at most {lift / g:.3f} kg can fly"
        )
    if problems:
        raise ConfigurationError("\n  ".join(problems))


def check_hinged_thrust(scenario: Scenario) -> None:
    """Refuse a thrust on the hinge that the rotors cannot give.

    Raises:
        ConfigurationError: the thrust, and what they give.
    """
    (low, high), asked = lift_range(scenario), scenario.control.thrust_n
    if not low <= asked <= high:
        raise ConfigurationError(
            f"control.thrust_n = {asked:g} N is beyond the rotors, which give {low:g} to {high:g} N together; "
            "left out it follows the UAV's weight"
        )


def flies_on(scenario: Scenario) -> bool:
    """Whether a take-off of the scenario leaves the UAV at a speed that it keeps with all its thrust."""
    return gives_speed(scenario) and scenario.place.fly_on
