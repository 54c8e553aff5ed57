"""What the controller takes for true of UAV, plate and rotors, as numbers, from the believed scenario."""

from typing import NamedTuple

import numpy as np

from armland.models.inflow import Rotors, advance_of, disc_of
from armland.models.parameters import plate_mass, rotor_count, uav_parameters
from armland.models.uav import UavParameters
from armland.scenario import Scenario


class Flyer(NamedTuple):
    """What flies, and what of it the hinge carries."""

    mass: float
    """kg, plate and load included."""
    body: UavParameters
    """What the hinge carries: without the plate."""
    gravity: float
    """Its magnitude, m/s²."""

    @property
    def weight(self) -> float:
        """N, of all that flies."""
        return self.mass * self.gravity


def flyer(scenario: Scenario) -> Flyer:
    """The UAV of a believed scenario, its plate included.

    Raises:
        ModelError: the UAV's file cannot be used, or lacks the body `uav`, the site `cm` or the site `pivot`.
    """
    body = uav_parameters(scenario)
    return Flyer(body.mass + plate_mass(scenario), body, _gravity(scenario))


def hinged(scenario: Scenario) -> Flyer:
    """As `flyer`, of a UAV bound to the arm: the plate is part of the hinge, which the arm carries."""
    body = uav_parameters(scenario)
    return Flyer(body.mass, body, _gravity(scenario))


def _gravity(scenario: Scenario) -> float:
    return float(np.linalg.norm(scenario.environment.gravity_mps2))


def rotors_of(scenario: Scenario) -> Rotors:
    """The rotors as momentum theory sees them."""
    r, count = scenario.rotors, rotor_count(scenario)
    disc = disc_of(r.radius_m, scenario.environment.air_density_kgm3)
    return Rotors(count, count * r.max_thrust_n, disc, r.slope, advance_of(r.slope, r.inflow_ratio))
