"""The world around: gravity, air, a constant disturbance."""

import math
from typing import Annotated

from pydantic import AfterValidator

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key

LEAST_GRAVITY = 0.1
"""m/s²."""


def _gravity(value: of.Acceleration3) -> of.Acceleration3:
    if value[2] > -LEAST_GRAVITY or -value[2] < 0.5 * math.hypot(*value):
        raise ValueError(
            f"gravity must point downwards, within 60 degrees of -z and with at least {LEAST_GRAVITY:g} m/s² along it: "
            "loads are counted in shares of the UAV's weight"
        )
    return value


class Environment(Section):
    """What acts on everything."""

    gravity_mps2: Annotated[of.Acceleration3, AfterValidator(_gravity)] = key((0.0, 0.0, -9.81), "world axes")
    air_density_kgm3: Annotated[float, between(1e-3, 100.0)] = key(1.225, "of the air that the rotors move")


class Disturbance(Section):
    """A constant force and torque on the UAV that no model knows of."""

    force_n: of.Force3 = key((0.0, 0.0, 0.0), "at the centre of mass, world axes")
    torque_nm: of.Torque3 = key((0.0, 0.0, 0.0), "body axes")
