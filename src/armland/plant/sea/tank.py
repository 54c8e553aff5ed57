"""A floating platform with an arm in a tank: motion by its published statistics, without waves and hull.

Published: roll and pitch of 1.4 degrees significant single amplitude, zero-crossings every 0.8 s with roll's peak at 2.2 s; x and y of
4 to 7 mm standard deviation. Two lobes of equal energy have both: that of the peak, and one at 0.585 s: 1/0.8² = ½ (1/2.2² + 1/0.585²).
Source: statistics over the records of chongfengliu/Ocean-Disturbance-Data. Their largest angle, 3.3 degrees, is more than a normal
process of this size comes to. Heave is not published: as large as x and y, and no yaw: assumption.
"""

import numpy as np

from armland.plant.noise import stream
from armland.plant.sea.motion import Motion
from armland.scenario import Scenario

ANGLE_RAD = np.deg2rad(1.4) / 2.0
"""Standard deviation of roll and pitch."""

SHIFT_M = 0.0055
"""Standard deviation of surge, sway and heave."""

PERIODS_S = (2.2, 0.585)

WIDTH = 0.1
"""Standard deviation of a lobe's frequency over its middle. Assumption."""

WAVES = 60
"""Harmonics of a lobe."""


def tank_motion(scenario: Scenario) -> Motion:
    """The motion of the deck for the scenario's seed."""
    random, size = stream(scenario.run.seed, "sea"), np.array([*(3 * [SHIFT_M]), *(2 * [ANGLE_RAD]), 0.0])
    lobes = [2.0 * np.pi / period * (1.0 + WIDTH * random.uniform(-1.7, 1.7, WAVES)) for period in PERIODS_S]
    phases = random.uniform(-np.pi, np.pi, (2 * WAVES, 6))
    # Equal shares of the variance: ½ |A|² for each of the harmonics.
    return Motion(np.concatenate(lobes), size * np.sqrt(1.0 / WAVES) * np.exp(1j * phases), np.zeros(6), np.zeros(6))
