"""Does a speed that the arm gives allow a higher take-off weight? The paper's claim, by theory and by flights in the plant.

Flights are the real procedure with ideal sensors, arm, magnet and release; each limit is found by bisection. The take-off weight
is the largest with which the UAV flies off at full command and does not sink: at rest it is the static thrust.
"""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armland.experiments.episode import fly, quiet
from armland.experiments.paper import Progress, silent
from armland.experiments.takeoff_weight.theory import Theory, theory
from armland.mission.belief import flyer, rotors_of
from armland.mission.feasibility.launch import Carrying, largest_speed
from armland.mission.plan import plan
from armland.models.environment import STANDARD_GRAVITY
from armland.models.inflow import Rotors, sustained
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
    half_width: float  # Half of the bracket that is left
    inside: bool  # Whether flights on both sides of it were seen: one that flew off and one that sank


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


def bisected(flies: Callable[[float], bool], about: float, tried: Callable[[int], None]) -> tuple[float, float, bool]:
    """Where `flies` ends about `about`, a weight over the static thrust, with the half width of the bracket that is left, and whether
    flights on both sides were seen; `tried` is called with their number after each.
    """
    low, high, flew, sank = about - BRACKET, about + BRACKET, False, False
    for k in range(HALVINGS):
        middle = 0.5 * (low + high)
        if flies(middle):
            low, flew = middle, True
        else:
            high, sank = middle, True
        tried(k + 1)
    return 0.5 * (low + high), 0.5 * (high - low), flew and sank


DIRECTIONS = {"forward": (1.0, 0.0, 0.0), "sideways": (0.0, -1.0, 0.0), "upwards": (0.0, 0.0, 1.0)}

FLOWN = (
    ("rest", "forward", 0.0),
    ("sideways", "sideways", 0.3),
    ("sideways", "sideways", 0.6),
    ("forward", "forward", 0.5),
    ("upwards", "upwards", 0.5),
)
"""Name, direction and speed, m/s, of the flights."""


@dataclass(frozen=True)
class TakeoffWeight:
    """What the study found; weights over the static thrust, speeds in m/s."""

    static_thrust_n: float
    hover_inflow_mps: float
    arm_speed_mps: dict[str, float]
    theory: Theory
    flights: list[FlownLimit]

    @property
    def verdict(self) -> str:
        """What it comes to, in words."""
        speeds, level = self.arm_speed_mps, self.theory.sustained
        fastest = max(speeds["forward"], speeds["sideways"])
        gains = sorted(100.0 * (level[name] - 1.0) for name in ("constant rotor speed", "constant power"))
        more = [100.0 * (t["thrown"] - t["from rest"]) for t in self.theory.thrown.values()]
        gram = 10.0 * self.static_thrust_n / STANDARD_GRAVITY
        return (
            f"True in principle, of no practical size for this arm: {fastest:.2f} m/s, {fastest / self.hover_inflow_mps:.2f} of "
            f"the induced velocity, lift {gains[0]:.2f} to {gains[1]:.2f} % more ({gram * gains[1]:.1f} g), and only while they "
            f"are kept. Thrown at {min(speeds.values()):.2f} m/s, best upwards, a UAV that then gains speed by itself and never "
            f"hovers may weigh {min(more):.1f} to {max(more):.1f} % more than one let go at rest ({gram * max(more):.0f} g)."
        )

    def result(self) -> dict[str, Any]:
        """As plain data, for JSON."""
        data = asdict(self)
        del data["theory"]
        return {**data, **self.theory._asdict(), "verdict": self.verdict}


def study(scenario: Scenario, flights: bool = True, progress: Progress = silent) -> TakeoffWeight:
    """Run the study.

    Args:
        scenario: of a take-off; its faults and imperfections are left out.
        flights: whether to fly, which takes most of the time.
        progress: called with what is flown, done and total.

    Raises:
        ConfigurationError: what planning a take-off refuses.
    """
    rotors, drag, speeds = rotors_of(scenario), scenario.uav.drag_nspm, arm_speeds(scenario)
    horizontal = max(speeds["forward"], speeds["sideways"])
    found = theory(rotors, drag, horizontal, min(speeds.values()))
    flown = [_flown(scenario, rotors, *row, progress) for row in FLOWN] if flights else []
    return TakeoffWeight(rotors.static, rotors.hover_inflow, speeds, found, flown)


def arm_speeds(scenario: Scenario) -> dict[str, float]:
    """Largest speed, m/s, that the arm can give in each of `DIRECTIONS` to a UAV that just hovers."""
    static = rotors_of(scenario).static
    made = plan(loaded(scenario, (0.0, 0.0, 0.0), static, _empty(scenario)), "takeoff", trial=True)
    carrying = Carrying(made.arm, made.told["limit"]["qd_max"][0], static / STANDARD_GRAVITY, made.scenario)
    return {name: largest_speed(carrying, made.home, np.array(along)) for name, along in DIRECTIONS.items()}


def flown_limit(
    scenario: Scenario, velocity: Velocity, about: float, tried: Callable[[int], None]
) -> tuple[float, float, bool]:
    """Largest weight over the static thrust that flies off at `velocity` (3,), m/s, and the rest of `bisected`."""
    static, empty = rotors_of(scenario).static, _empty(scenario)
    return bisected(lambda share: flies_off(loaded(scenario, velocity, share * static, empty)), about, tried)


def _empty(scenario: Scenario) -> float:
    # Weight, N, of UAV and plate without a load.
    return flyer(scenario.replaced({"uav": {"extra_mass_kg": 0.0}}).believed()).weight


def _flown(
    scenario: Scenario, rotors: Rotors, name: str, direction: str, speed: float, progress: Progress
) -> FlownLimit:
    x, y, z = (speed * c for c in DIRECTIONS[direction])
    about = sustained(rotors, speed if direction != "upwards" else 0.0, scenario.uav.drag_nspm) / rotors.static
    limit = flown_limit(scenario, (x, y, z), about, lambda done: progress(name, done, HALVINGS))
    return FlownLimit(name, speed, about, *limit)
