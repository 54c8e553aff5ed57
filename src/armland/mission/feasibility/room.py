"""Where the arm may follow the plate: a box about the catch that leaves it clear of the cradle's rails."""

import numpy as np

from armland.errors import ConfigurationError
from armland.mission.table.mission import Start
from armland.rotations import Array
from armland.scenario import Scenario


def room(scenario: Scenario, start: Start) -> Array:
    """Lowest and highest place (2, 3), m, D, to which the arm follows the plate's pivot.

    As far as `bounds.uav_error_m` from the catch, or of a UAV that takes off from the cradle's middle, and sideways no further
    than leaves `control.approach.clearance_m` to the rails between which it stands.

    Raises:
        ConfigurationError: a catch outside of the corridor.
    """
    place, cradle, reach = scenario.place, scenario.cradle, scenario.bounds.uav_error_m
    slot = np.array(place.put_down_m)
    catch = slot if start == "cradle" else np.array(place.catch_m)
    half = 0.5 * (cradle.gap_m - scenario.arm.width_m) - scenario.control.approach.clearance_m
    angle = np.deg2rad(cradle.heading_deg)
    across = np.array([-np.sin(angle), np.cos(angle)])
    aside = float(across @ (catch - slot)[:2])
    if abs(aside) > half:
        raise ConfigurationError(
            f"place.catch_m = {place.catch_m} lies {1e3 * abs(aside):.0f} mm beside the middle of the cradle's slot; the corridor, in "
            f"which the arm of {1e3 * scenario.arm.width_m:.0f} mm stays clear of rails {1e3 * cradle.gap_m:.0f} mm apart, is "
            f"{1e3 * half:.0f} mm wide to each side: move the catch, the cradle, or widen cradle.gap_m"
        )
    low, high = catch - reach, catch + reach
    low[2] -= scenario.place.standoff_m
    for i in range(2):
        # Of a slot that stands askew the box takes what is inside for all of it.
        if abs(across[i]) > 1e-9:
            rest = (half - aside - reach * abs(across[1 - i])) / abs(across[i])
            back = (half + aside - reach * abs(across[1 - i])) / abs(across[i])
            up, down = (rest, back) if across[i] > 0.0 else (back, rest)
            high[i] = min(high[i], catch[i] + max(up, 0.0))
            low[i] = max(low[i], catch[i] - max(down, 0.0))
    return np.array([low, high])
