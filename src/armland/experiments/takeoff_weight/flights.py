"""The take-off weight by flights: the real procedure with ideal sensors, arm, magnet and release; each limit found by bisection.

The take-off weight is the largest with which the UAV flies off at full command and does not sink: at rest it is the static thrust.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armland.experiments.episode import fly
from armland.experiments.quiet import quiet
from armland.models.environment import STANDARD_GRAVITY
from armland.scenario import Scenario

Velocity = tuple[float, float, float]

BRACKET, HALVINGS = 0.008, 5
"""Half width about theory's limit, over the static thrust, in which flights look for theirs, and how often it is halved."""

DROP_M, SINK_MPS, LATE_S = 0.03, 0.01, 0.5
"""Below the height of the release, and downwards at the end: what still counts as flying off; how long the end is."""


@dataclass(frozen=True)
class FlownLimit:
    """Take-off weight over the static thrust, found by flights."""

    name: str
    speed_mps: float
    theory: float
    flown: float
    half_width: float
    """Half of the bracket that is left."""
    inside: bool
    """Whether flights on both sides of it were seen: one that flew off and one that sank."""


def loaded(scenario: Scenario, velocity: Velocity, weight: float, empty: float) -> Scenario:
    """The scenario with ideal sensors and a take-off at `velocity`, m/s, of a UAV that weighs `weight` N, and `empty` N unloaded."""
    place = {"takeoff_velocity_mps": velocity, "fly_on": True}
    extra = (weight - empty) / STANDARD_GRAVITY
    return quiet(scenario).replaced({"place": place, "uav": {"extra_mass_kg": extra}})


def flies_off(scenario: Scenario) -> bool:
    """Whether the UAV of a `loaded` scenario, released with all its thrust, neither sinks nor touches the arm again."""
    episode = fly(scenario, "takeoff", trial=True)
    return flew_off(episode.ticks, episode.metadata["phases"].split(",").index("release"), scenario.run.rate_hz)


def flew_off(ticks: NDArray[np.void], release: int, rate: int) -> bool:
    """As `flies_off`, of the `ticks` of a flight whose phase number `release` lets go of the UAV."""
    truth, begun = ticks["truth"], np.flatnonzero(ticks["mission"]["phase"] == release)
    if not len(begun) or truth["touching"][-1]:
        return False
    free = begun[0] + int(np.flatnonzero(truth["touching"][begun[0] :] == 0)[0])
    height, late = truth["r"][:, 2], truth["v"][-round(LATE_S * rate) :, 2]
    return bool(height[-1] > height[free] - DROP_M and late.mean() > -SINK_MPS and not truth["foul"][free:, 2].any())


def bisected(flies: Callable[[float], bool], about: float, tried: Callable[[], None]) -> tuple[float, float, bool]:
    """Largest weight over the static thrust that `flies`, about `about`; half of the bracket that is left; whether flights on both
    sides were seen."""
    low, high, flew, sank = about - BRACKET, about + BRACKET, False, False
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if flies(middle):
            low, flew = middle, True
        else:
            high, sank = middle, True
        tried()
    return 0.5 * (low + high), 0.5 * (high - low), flew and sank
