"""Does a speed that the arm gives allow a higher take-off weight? The paper's claim, by theory and by flights in the plant.

The take-off weight is the largest with which the UAV flies off at full command and does not sink: at rest it is the static thrust.
Flights: the real procedure with ideal sensors, arm, magnet, release; each limit found by bisection.
"""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armland.experiments.landing import run
from armland.experiments.throw import heaviest_at_any_speed, heaviest_thrown, speed_for_gain
from armland.mission.landing_scenario import Imperfections, LandingScenario
from armland.mission.landing_setup import set_up
from armland.mission.launch import largest_speed, rotors_of
from armland.models.inflow import Rotors, sustained
from armland.models.uav import GRAVITY
from armland.plant.landing import LandingPlant

DIRECTIONS = {"forward": (1.0, 0.0, 0.0), "sideways": (0.0, -1.0, 0.0), "upwards": (0.0, 0.0, 1.0)}

FLOWN = (
    ("rest", "forward", 0.0),
    ("sideways", "sideways", 0.3),
    ("sideways", "sideways", 0.6),
    ("forward", "forward", 0.5),
    ("upwards", "upwards", 0.5),
)
"""Name, direction and speed, m/s, of the flights."""

BRACKET, HALVINGS = 0.008, 5
"""Half width about theory's limit, over the static thrust, in which flights look for theirs, and how often it is halved."""

DROP_M, SINK_MPS = 0.03, 0.01
"""Below the height of the release, and downwards at the end: what still counts as flying off."""

HEIGHTS_M = (0.03, 0.5)
"""Height that a thrown UAV may lose."""

GAINS = (0.05, 0.10, 0.20)

PERFECT = Imperfections(
    force_bias_n=0.0,
    torque_bias_nm=0.0,
    heading_error_deg=0.0,
    tilt_error_deg=0.0,
    thrust_error=0.0,
    hover_noise_m=0.0,
    camera=False,
    noise=False,
)

Progress = Callable[[str, int, int], None]


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


@dataclass(frozen=True)
class TakeoffWeight:
    """What the study found; weights over the static thrust, speeds in m/s."""

    static_thrust_n: float
    hover_inflow_mps: float
    arm_speed_mps: dict[str, float]
    sustained: dict[str, float]
    """At the largest horizontal speed of the arm: constant rotor speed, constant power, and both without drag."""
    most: dict[str, tuple[float, float]]
    """Heaviest in level flight at any speed, and that speed, by reading."""
    speed_for_gain: dict[str, dict[str, float | None]]
    thrown: dict[str, dict[str, float]]
    """Best throw at the speed that the arm gives in every direction, and at none, by reading and height that may be lost."""
    flights: list[FlownLimit]
    verdict: str

    def result(self) -> dict[str, Any]:
        """As plain data, for JSON."""
        return asdict(self)


def study(scenario: LandingScenario, flights: bool = True, progress: Progress | None = None) -> TakeoffWeight:
    """Run the study.

    Args:
        scenario: of `landing_scenario`; its faults and imperfections are left out.
        flights: whether to fly, which takes most of the time.
        progress: called with what is flown, done and total.

    Raises:
        ConfigurationError: what `set_up` refuses.
    """
    landing = scenario.landing
    rotors, drag = rotors_of(landing, scenario.demonstrator), landing.rotors.drag_nspm
    speeds = arm_speeds(scenario)
    fastest = max(speeds["forward"], speeds["sideways"])
    readings = {"constant rotor speed": False, "constant power": True}
    level, thrown, gains = {}, {}, {}
    for name, power in readings.items():
        level[name] = sustained(rotors, fastest, drag, power) / rotors.static
        level[f"{name}, no drag"] = sustained(rotors, fastest, 0.0, power) / rotors.static
        for c, what in ((drag, name), (0.0, f"{name}, no drag")):
            gains[what] = {f"{g:g}": speed_for_gain(rotors, g, c, power) for g in GAINS}
        for height in HEIGHTS_M:
            # At the speed that the arm gives in every direction.
            best = heaviest_thrown(rotors, min(speeds.values()), height, drag, power)
            thrown[f"{name}, {height:g} m"] = {
                "thrown": best[0],
                "elevation_deg": float(np.rad2deg(best[1])),
                "from rest": heaviest_thrown(rotors, 0.0, height, drag, power)[0],
            }
    flown = _fly_all(scenario, rotors, drag, progress) if flights else []
    return TakeoffWeight(
        static_thrust_n=rotors.static,
        hover_inflow_mps=rotors.hover_inflow,
        arm_speed_mps=speeds,
        sustained=level,
        most={name: heaviest_at_any_speed(rotors, drag, power) for name, power in readings.items()},
        speed_for_gain=gains,
        thrown=thrown,
        flights=flown,
        verdict=_verdict(level, thrown, rotors, speeds),
    )


def arm_speeds(scenario: LandingScenario) -> dict[str, float]:
    """Largest speed, m/s, that the arm can give in each of `DIRECTIONS` to a UAV that just hovers."""
    rotors = rotors_of(scenario.landing, scenario.demonstrator)
    setup = set_up(_loaded(scenario, (0.0, 0.0, 0.0), rotors.static), "takeoff", trial=True)
    mass = rotors.static / GRAVITY
    return {
        name: largest_speed(setup.arm, setup.home, scenario.landing, mass, np.array(direction))
        for name, direction in DIRECTIONS.items()
    }


def _loaded(scenario: LandingScenario, velocity: tuple[float, float, float], weight: float) -> LandingScenario:
    # The scenario with a UAV of `weight` N, ideal sensors, and a take-off with `velocity`.
    landing, uav = scenario.landing, scenario.demonstrator.uav
    place = landing.place.model_copy(update={"takeoff_velocity_mps": velocity, "fly_on": True})
    extra = weight / GRAVITY - uav.mass_kg - landing.plate_mass_kg
    changed = {"place": place, "extra_mass_kg": extra, "imperfections": PERFECT, "faults": ()}
    return scenario._replace(landing=landing.model_copy(update=changed))


def flies_off(scenario: LandingScenario, velocity: tuple[float, float, float], weight: float) -> bool:
    """Whether a UAV of `weight` N, released at `velocity` m/s with all its thrust, neither sinks nor touches the arm again."""
    setup = set_up(_loaded(scenario, velocity, weight), "takeoff", trial=True)
    records, _ = run(setup, LandingPlant(setup.scenario, setup.home, "cradle"))
    return flew_off(records, setup.table.number("release"))


def flew_off(records: NDArray[np.void], release: int) -> bool:
    """As `flies_off`, of the `records` of a flight whose phase number `release` lets go of the UAV."""
    truth, begun = records["truth"], np.flatnonzero(records["mission"]["phase"] == release)
    if not len(begun) or truth["touching"][-1]:
        return False
    free = begun[0] + int(np.flatnonzero(truth["touching"][begun[0] :] == 0)[0])
    height, late = truth["r"][:, 2], truth["v"][-500:, 2]
    return bool(height[-1] > height[free] - DROP_M and late.mean() > -SINK_MPS and not truth["foul"][free:, 2].any())


def flown_limit(
    scenario: LandingScenario, velocity: tuple[float, float, float], about: float, tried: Callable[[], None]
) -> tuple[float, float, bool]:
    """Largest weight over the static thrust that flies off, by bisection about `about`; half of the bracket that is left; whether
    flights on both sides were seen."""
    static = rotors_of(scenario.landing, scenario.demonstrator).static
    low, high, flew, sank = about - BRACKET, about + BRACKET, False, False
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if flies_off(scenario, velocity, middle * static):
            low, flew = middle, True
        else:
            high, sank = middle, True
        tried()
    return 0.5 * (low + high), 0.5 * (high - low), flew and sank


def _fly_all(scenario: LandingScenario, rotors: Rotors, drag: float, progress: Progress | None) -> list[FlownLimit]:
    out: list[FlownLimit] = []
    for name, direction, speed in FLOWN:
        velocity = tuple(speed * x for x in DIRECTIONS[direction])
        theory = sustained(rotors, speed if direction != "upwards" else 0.0, drag) / rotors.static
        done = 0

        def tried(name: str = name) -> None:
            nonlocal done
            done += 1
            if progress is not None:
                progress(name, done, HALVINGS)

        flown, half, inside = flown_limit(scenario, velocity, theory, tried)  # type: ignore[arg-type]
        out.append(FlownLimit(name, speed, theory, flown, half, inside))
    return out


def _verdict(
    level: dict[str, float], thrown: dict[str, dict[str, float]], rotors: Rotors, speeds: dict[str, float]
) -> str:
    fastest = max(speeds["forward"], speeds["sideways"])
    gains = sorted(100.0 * (level[name] - 1.0) for name in ("constant rotor speed", "constant power"))
    more = [100.0 * (t["thrown"] - t["from rest"]) for t in thrown.values()]
    gram = 10.0 * rotors.static / GRAVITY
    return (
        f"True in principle, of no practical size for this arm: {fastest:.2f} m/s, {fastest / rotors.hover_inflow:.2f} of the "
        f"induced velocity, lift {gains[0]:.2f} to {gains[1]:.2f} % more ({gram * gains[1]:.1f} g), and only while they are kept. "
        f"Thrown at {min(speeds.values()):.2f} m/s, best upwards, a UAV that then gains speed by itself and never hovers may "
        f"weigh {min(more):.1f} to {max(more):.1f} % more than one let go at rest ({gram * max(more):.0f} g)."
    )
