"""Decks by their published statistics, without waves and hull: a floating platform in a tank, and a small USV at sea.

The energy of each motion lies in two lobes alike. Their periods T₁ and T₂ make the mean time between upward zero-crossings T_z,
1/T_z² = ½ (1/T₁² + 1/T₂²).

`tank`: roll and pitch of 1.4° significant single amplitude, zero-crossings every 0.8 s, roll's peak at 2.2 s; x and y of 4 to 7 mm
standard deviation. Heave as large as x and y, and no yaw: assumption.

`usv`: heave of up to 0.18 m significant single amplitude, zero-crossings every 1.8 to 3.5 s, peaks at 1.6 to 2.5 s and 6 to 8 s; 12° of
range in roll. That the range is six standard deviations, pitch as roll, surge and sway as heave, and no yaw: assumption.

Sources: statistics over the records of chongfengliu/Ocean-Disturbance-Data; the range of roll, arXiv 2212.12196. The largest angle of
`tank`, 3.3°, is more than a normal process of its size comes to.
"""

from typing import NamedTuple

import numpy as np

from armland.plant.noise import stream
from armland.plant.sea.motion import Motion
from armland.scenario import Scenario

WIDTH = 0.1
"""Standard deviation of a lobe's frequency over its middle. Assumption."""

WAVES = 60
"""Harmonics of a lobe."""


class Measured(NamedTuple):
    """Standard deviations and periods of a deck."""

    shift: float
    """Of surge, sway and heave, m."""
    angle: float
    """Of roll and pitch, rad."""
    periods: tuple[float, float]
    """Of the lobes, s."""


DECKS = {
    "tank": Measured(0.0055, np.deg2rad(1.4) / 2.0, (2.2, 0.585)),
    "usv": Measured(0.18 / 2.0, np.deg2rad(12.0) / 6.0, (2.0, 7.0)),
}
"""By the scenario's `sea.state`."""


def measured_motion(scenario: Scenario) -> Motion:
    """The motion of the deck for the scenario's seed."""
    deck, random = DECKS[scenario.sea.state], stream(scenario.run.seed, "sea")
    size = np.array([*(3 * [deck.shift]), *(2 * [deck.angle]), 0.0])
    lobes = [2.0 * np.pi / period * (1.0 + WIDTH * random.uniform(-1.7, 1.7, WAVES)) for period in deck.periods]
    phases = random.uniform(-np.pi, np.pi, (2 * WAVES, 6))
    # Equal shares of the variance: ½ |A|² for each of the harmonics.
    return Motion(np.concatenate(lobes), size * np.sqrt(1.0 / WAVES) * np.exp(1j * phases), np.zeros(6), np.zeros(6))
