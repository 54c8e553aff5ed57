"""What the wind that the user foretells asks of a mission: how far the UAV will lean, and which limits of calm air must give way.

| symbol | name | unit |
|---|---|---|
| W₂₀ | `forecast.wind_mps`, mean wind at 20 ft | m/s |
| V, σ | `Wind.mean`, `.sigma`: mean wind at the catch; of its turbulence, each horizontal component | m/s |
| c, m | drag, and mass of all that flies | N·s/m, kg |

V = W₂₀ ln(h/z₀)/ln(h₂₀/z₀), σ = 0.196 W₂₀. A UAV that keeps its station leans by θ with tan θ = c (V + kσ)/(m g) in a gust of k
standard deviations: that is healthy, and the hinge takes it from the plate. Source: MIL-F-8785C, 3.7, as in `docs/air.md`.

Nothing of this depends on where the wind comes from, nor on what it is like: only on what was foretold. Calm: nothing changes.
"""

from typing import NamedTuple

import numpy as np

from armland.scenario import Scenario

FOOT_M = 0.3048
HEIGHT_M, ROUGH_M = 20.0 * FOOT_M, 0.15 * FOOT_M
"""Height of W₂₀, and z₀ of a landing."""

TURBULENCE, SINKING = 0.196, 0.1
"""σ/W₂₀ and σ_w/W₂₀ at and below 10 ft."""

GUST = 2.0
"""Standard deviations of a gust for which a mission keeps room at every moment."""

STRONGEST = 3.0
"""Likewise of one that must not bring it to an end."""

LENGTH_M, WAITS = 44.0, 6.0
"""Length of turbulence along the wind at 20 ft, h/(0.177 + 0.000823 h)^1.2 in feet: over the mean wind it is the time that a gust takes
to pass. For how many of them a run has time beyond one in calm air."""

LONGEST_S = 300.0
"""Longest run that wind asks for, s."""

RISES_MPS, FOUND_S = 0.4, 0.5
"""Speed with which a hull in sea state 3 rises, mean of its highest third; time until a UAV that hovers in W is seen and guided."""

DRAGS = 1.3
"""Drag that a UAV may have over the believed one: of bluff bodies it is hardly known better."""

SPARE_RAD, MOST_RAD = 0.05, 0.52
"""Lean that is left to move the UAV while it holds against the strongest gust; largest that an autopilot of this kind is set to:
AR.Drone, `euler_angle_max`."""

USUAL: dict[str, object] = {"catch_m": (0.62, 0.0, 0.86), "put_down_m": (0.68, 0.0, 0.701)}
"""Places of the landing by an arm, m, D, as its scenario has them."""

ROOMY: dict[str, object] = {"catch_m": (0.50, 0.0, 0.93), "put_down_m": (0.70, 0.0, 0.60), "wait_below_m": 0.20}
"""Those in wind and on a deck that moves: 0.33 m from catch to cradle and not 0.16, since air that sinks takes a UAV down by
up to 0.25 m while its rotors give all that they can."""

POSTURE_RAD_S = 6.0
"""Bandwidth of the arm's null space where it follows a UAV in gusts, or is shaken by a deck: held by friction alone, its elbow creeps
aside and into the cradle within a minute."""


class Wind(NamedTuple):
    """Wind at the catch as it is expected."""

    mean: float
    sigma: float

    def gust(self, k: float) -> float:
        """Speed, m/s, of a gust of `k` standard deviations."""
        return self.mean + k * self.sigma

    @property
    def sinking(self) -> float:
        """Speed, m/s, of air that sinks, one standard deviation: it takes along a UAV whose rotors are well."""
        return SINKING / TURBULENCE * self.sigma

    def lean(self, slope: float, k: float) -> float:
        """Lean, rad, in a gust of `k` standard deviations of a UAV whose drag over its weight is `slope`, s/m."""
        return float(np.arctan(slope * self.gust(k)))


def expected(scenario: Scenario) -> Wind:
    """The wind at the catch as the user of the scenario foretells it."""
    w20 = scenario.foretold_mps
    height = max(scenario.place.catch_m[2], ROUGH_M)
    return Wind(w20 * float(np.log(height / ROUGH_M) / np.log(HEIGHT_M / ROUGH_M)), TURBULENCE * w20)


def started(scenario: Scenario, mass: float) -> dict[str, float]:
    """What is done differently before a flight in wind or above a deck that moves, by dotted key; nothing in calm.

    The UAV is brought to above the arm, higher by what a gust takes it down before its own hover answers and by what a deck rises
    before it is guided, and in wind it is let lean. The arm's null space keeps its pose.

    Args:
        scenario: as it flies.
        mass: kg, of all that flies.
    """
    wind, g, own = expected(scenario), float(np.linalg.norm(scenario.environment.gravity_mps2)), scenario.onboard.hover
    above = scenario.place.start_above_m + (RISES_MPS * FOUND_S if scenario.foretold_deck else 0.0)
    # Of a UAV that stands a gust of three standard deviations is up to half of its weight: more than wet rails hold.
    kept = {"control.posture_rad_s": POSTURE_RAD_S, "place.keep_hold": True}
    if wind.mean <= 0.0:
        return {"place.start_above_m": above, **kept} if scenario.foretold_deck else {}
    rate = scenario.uav.drag_nspm / mass
    lean = most_lean(wind, rate / g)
    down = GUST * rate * wind.sigma / (own.k_position * own.k_velocity + own.k_integral)
    # Recorded winds and decks last as long as they last.
    longer = 0.0 if scenario.air.trace or scenario.sea.trace else WAITS * LENGTH_M / wind.mean
    return {
        # Weak wind has long gusts, and takes no UAV out of view.
        "run.duration_s": max(scenario.run.duration_s, min(scenario.run.duration_s + longer, LONGEST_S)),
        "place.start_above_m": above + down,
        "onboard.hover.tilt_max_rad": max(own.tilt_max_rad, lean),
        **kept,
    }


def most_lean(wind: Wind, slope: float) -> float:
    """Largest lean, rad, that is asked of a UAV in a wind; `slope` is its drag over its weight, s/m, as it is believed."""
    return min(wind.lean(DRAGS * slope, STRONGEST) + SPARE_RAD, MOST_RAD)


def swayed(scenario: Scenario, mass: float) -> tuple[float, float]:
    """Lean, degrees, and speed, m/s, that a UAV in the wind that is foretold has beyond one in calm air without being out of control.

    The speed is what a gust of two standard deviations gives to it against its own hover.

    Args:
        scenario: as it flies.
        mass: kg, of all that flies.
    """
    wind, rate = expected(scenario), scenario.uav.drag_nspm / mass
    if wind.mean <= 0.0:
        return 0.0, 0.0
    g = float(np.linalg.norm(scenario.environment.gravity_mps2))
    lean = float(np.rad2deg(wind.lean(rate / g, STRONGEST)))
    return lean, GUST * rate * wind.sigma / scenario.onboard.hover.k_velocity
