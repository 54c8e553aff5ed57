"""Does a speed that the arm gives allow a higher take-off weight? The paper's claim, by theory and by flights in the plant."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from armland.experiments.takeoff_weight.flights import HALVINGS, FlownLimit, bisected, flies_off, loaded
from armland.experiments.takeoff_weight.theory import Theory, theory
from armland.mission.belief import flyer, rotors_of
from armland.mission.feasibility.launch import Carrying, largest_speed
from armland.mission.plan import plan
from armland.models.environment import STANDARD_GRAVITY
from armland.models.inflow import Rotors, sustained
from armland.scenario import Scenario

DIRECTIONS = {"forward": (1.0, 0.0, 0.0), "sideways": (0.0, -1.0, 0.0), "upwards": (0.0, 0.0, 1.0)}

FLOWN = (
    ("rest", "forward", 0.0),
    ("sideways", "sideways", 0.3),
    ("sideways", "sideways", 0.6),
    ("forward", "forward", 0.5),
    ("upwards", "upwards", 0.5),
)
"""Name, direction and speed, m/s, of the flights."""

Progress = Callable[[str, int, int], None]
"""Called with what is flown, done and total."""


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


def study(scenario: Scenario, flights: bool = True, progress: Progress | None = None) -> TakeoffWeight:
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
    flown = _fly_all(scenario, rotors, progress) if flights else []
    return TakeoffWeight(rotors.static, rotors.hover_inflow, speeds, found, flown)


def arm_speeds(scenario: Scenario) -> dict[str, float]:
    """Largest speed, m/s, that the arm can give in each of `DIRECTIONS` to a UAV that just hovers."""
    static = rotors_of(scenario).static
    made = plan(loaded(scenario, (0.0, 0.0, 0.0), static, _empty(scenario)), "takeoff", trial=True)
    carrying = Carrying(made.arm, made.told["limit"]["qd_max"][0], static / STANDARD_GRAVITY, made.scenario)
    return {name: largest_speed(carrying, made.home, np.array(along)) for name, along in DIRECTIONS.items()}


def flown_limit(
    scenario: Scenario, velocity: tuple[float, float, float], about: float, tried: Callable[[], None]
) -> tuple[float, float, bool]:
    """Largest weight over the static thrust that flies off at `velocity` (3,), m/s, and the rest of `flights.bisected`."""
    static, empty = rotors_of(scenario).static, _empty(scenario)
    return bisected(lambda share: flies_off(loaded(scenario, velocity, share * static, empty)), about, tried)


def _empty(scenario: Scenario) -> float:
    # Weight, N, of UAV and plate without a load.
    return flyer(scenario.replaced({"uav": {"extra_mass_kg": 0.0}}).believed()).weight


def _fly_all(scenario: Scenario, rotors: Rotors, progress: Progress | None) -> list[FlownLimit]:
    out: list[FlownLimit] = []
    for name, direction, speed in FLOWN:
        x, y, z = (speed * c for c in DIRECTIONS[direction])
        about = sustained(rotors, speed if direction != "upwards" else 0.0, scenario.uav.drag_nspm) / rotors.static
        done = iter(range(1, HALVINGS + 1))

        def tried(name: str = name, done: Any = done) -> None:
            if progress is not None:
                progress(name, next(done), HALVINGS)

        out.append(FlownLimit(name, speed, about, *flown_limit(scenario, (x, y, z), about, tried)))
    return out
