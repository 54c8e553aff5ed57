"""What a UAV can do by its own numbers, what it needs of arm and magnet, and what of its numbers is suspicious.

| symbol | name | unit |
|---|---|---|
| W, T | weight of all that flies, largest thrust without torque | N |
| c | linear drag | N·s/m |
| J | inertia about a body axis | kg·m² |
"""

from typing import NamedTuple

import numpy as np

from armland.models.airframe.lift import lift_range
from armland.models.airframe.rotor_set import RotorSet
from armland.models.parameters import plate_mass, rotor_set, uav_parameters
from armland.models.uav import UavParameters
from armland.scenario import Scenario

SPEED_MPS = 10.0
HOVER_SHARE = 0.9
"""Of the largest thrust that may go into hovering, as a mission checks it."""

PEAK = 1.6
"""Hinge force over weight, largest of the landings of UAVs from 2 to 10 kg: snap of the magnet and touchdown."""

STEEL_KGM3 = 7850.0


class UavSurvey(NamedTuple):
    """By its own numbers, as the table prints them."""

    weight: float  # N, plate and load included
    thrust: float  # N, largest without torque
    hover_share: float
    tilt_deg: float  # largest that keeps the height with all the thrust; 0 where it cannot hover
    lean_deg: float  # at `SPEED_MPS` through the air
    carries: float  # kg beyond what it has, by `HOVER_SHARE`
    magnet: float  # N, least rating
    payload: float  # kg, least payload of the arm


def survey(scenario: Scenario) -> UavSurvey:
    """Survey the UAV of a scenario that is sized.

    Raises:
        ModelError: the UAV's file cannot be used.
    """
    g = float(np.linalg.norm(scenario.environment.gravity_mps2))
    mass = uav_parameters(scenario).mass + plate_mass(scenario)
    weight, (_, thrust) = mass * g, lift_range(scenario)
    share = weight / thrust
    return UavSurvey(
        weight,
        thrust,
        share,
        float(np.rad2deg(np.arccos(share))) if share < 1.0 else 0.0,
        float(np.rad2deg(np.arctan(scenario.uav.drag_nspm * SPEED_MPS / weight))),
        HOVER_SHARE * thrust / g - mass,
        PEAK * weight / scenario.limits.hinge_force_share,
        mass,
    )


def suspicious(scenario: Scenario, found: UavSurvey) -> list[str]:
    """What of a UAV's numbers is probably a slip, a line each: value, and what would be usual."""
    body, rotors, r = uav_parameters(scenario), rotor_set(scenario), scenario.rotors
    out = []
    if found.hover_share > HOVER_SHARE:
        out.append(
            f"hovers with {found.hover_share:.2f} of its thrust; {HOVER_SHARE:g} is the most that leaves room for control: "
            f"{r.max_thrust_n:g} N a rotor, mass {body.mass:g} kg"
        )
    if found.hover_share < 0.05:
        out.append(f"hovers with {found.hover_share:.3f} of its thrust: grams for kilograms, or a thrust in grams?")
    out += _of_inertia(body, rotors)
    reach = float(np.hypot(rotors.place[:, 0], rotors.place[:, 1]).max())
    if r.radius_m > 1.5 * reach or r.radius_m < 0.1 * reach:
        out.append(
            f"rotors of {r.radius_m:g} m in radius, {reach:.3g} m from the middle: millimetres, inches, a diameter?"
        )
    if not 0.01 <= r.time_constant_s <= 0.3:
        out.append(f"a rotor lag of {r.time_constant_s:g} s; 0.02 to 0.1 s are usual")
    if not 0.02 <= r.drag_torque_m / r.radius_m <= 0.5:
        out.append(f"a reaction torque of {r.drag_torque_m:g} N·m/N; 0.05 to 0.25 of the radius are usual")
    return out


def _of_inertia(body: UavParameters, rotors: RotorSet) -> list[str]:
    # Radii of gyration, of roll and pitch, against the distance of the rotors.
    reach = float(np.hypot(rotors.place[:, 0], rotors.place[:, 1]).mean())
    gyration = np.sqrt(np.diag(body.inertia) / body.mass)
    out = []
    if gyration.max() > 1.2 * reach:
        out.append(f"radius of gyration {gyration.max():.3g} m beyond the rotors at {reach:.3g} m: g·m², or kg·mm²?")
    if gyration.min() < 0.15 * reach:
        side = float(np.cbrt(body.mass / STEEL_KGM3))
        out.append(
            f"radius of gyration {gyration.min():.3g} m, rotors at {reach:.3g} m: a block of steel of that mass has "
            f"{side / np.sqrt(6.0):.3g} m; 0.3 to 0.7 of the rotors' distance are usual"
        )
    return out


def differs(scenario: Scenario) -> list[str]:
    """Where what flies and what is believed of it differ in mass, inertia, lever or thrust, a line each: for before anything moves."""
    belief = scenario.believed()
    real, believed = uav_parameters(scenario), uav_parameters(belief)
    out = []
    if not np.isclose(real.mass, believed.mass, rtol=1e-6):
        out.append(
            f"its file says {real.mass:g} kg, believed are {believed.mass:g} kg; the arm weighs it once it hangs there"
        )
    one, other = np.diag(real.inertia), np.diag(believed.inertia)
    if not np.allclose(real.inertia, believed.inertia, rtol=1e-6, atol=1e-12):
        out.append(f"its file says inertias of {_row(one)} kg·m², believed are {_row(other)}")
    if not np.allclose(real.lever, believed.lever, atol=1e-6):
        out.append(f"its file has the pivot at {_row(real.lever)} m, believed is {_row(believed.lever)}")
    most, thought = scenario.rotors.max_thrust_n, belief.rotors.max_thrust_n
    if not np.isclose(most, thought, rtol=1e-6):
        out.append(
            f"a rotor gives up to {most:g} N, believed are {thought:g} N: by that it is judged whether it can fly"
        )
    return out


def _row(values: np.ndarray) -> str:
    return ", ".join(f"{v:.4g}" for v in values)
