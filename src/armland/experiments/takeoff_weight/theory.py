"""What momentum theory and the arm's limits say about the take-off weight at speed; weights over the static thrust, speeds in m/s."""

from typing import NamedTuple

import numpy as np

from armland.experiments.takeoff_weight.throw import (
    Air,
    heaviest_at_any_speed,
    heaviest_thrown,
    level_share,
    speed_for_gain,
)
from armland.models.inflow import Rotors

READINGS = {"constant rotor speed": False, "constant power": True}
"""What full command means, and whether the motors' power is what stays."""

HEIGHTS_M = (0.03, 0.5)
"""Height that a thrown UAV may lose."""

GAINS = (0.05, 0.10, 0.20)
"""Gains of weight for which a speed is looked for."""


class Theory(NamedTuple):
    """What is possible without flying; by reading, and by reading `, no drag`."""

    sustained: dict[str, float]
    """Heaviest in level flight at the largest horizontal speed of the arm."""
    most: dict[str, tuple[float, float]]
    """Heaviest in level flight at any speed, and that speed."""
    speed_for_gain: dict[str, dict[str, float | None]]
    thrown: dict[str, dict[str, float]]
    """Best throw at the speed that the arm gives in every direction, and at none, by reading and height that may be lost."""


def theory(rotors: Rotors, drag: float, horizontal: float, anywhere: float) -> Theory:
    """The theory for speeds of the arm.

    Args:
        rotors: of the UAV.
        drag: linear, horizontal, N·s/m.
        horizontal: largest horizontal speed that the arm can give, m/s.
        anywhere: speed that it can give in every direction, m/s.
    """
    level, thrown, gains, most = {}, {}, {}, {}
    for reading, power in READINGS.items():
        air = Air(rotors, drag, power)
        for here, name in ((air, reading), (air._replace(drag=0.0), f"{reading}, no drag")):
            level[name] = level_share(here, horizontal)
            gains[name] = {f"{g:g}": speed_for_gain(here, g) for g in GAINS}
        most[reading] = heaviest_at_any_speed(air)
        for height in HEIGHTS_M:
            weight, elevation = heaviest_thrown(air, anywhere, height)
            thrown[f"{reading}, {height:g} m"] = {
                "thrown": weight,
                "elevation_deg": float(np.rad2deg(elevation)),
                "from rest": heaviest_thrown(air, 0.0, height)[0],
            }
    return Theory(level, most, gains, thrown)
