"""Where an arm can land: all places that the search finds, whether the one that is asked for is good, and the nearest that is."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.belief import flyer
from armland.mission.feasibility.obstacles import Obstacles
from armland.mission.feasibility.places import Bench, Place, everywhere, first_axis
from armland.mission.feasibility.placing import NEAREST, alternatives, nowhere
from armland.mission.plan import plan
from armland.mission.registry import mission_named
from armland.models.parameters import arm_model
from armland.rotations import Array
from armland.scenario import Scenario

MISSION = "landing"


@dataclass(frozen=True)
class Spot:
    """A place to land at, about the arm's first axis."""

    radius_m: float  # of the catch
    height_m: float
    distance_m: float  # of the cradle's middle
    heading_deg: float  # of the cradle
    merit: float


@dataclass(frozen=True)
class Reach:
    """Where an arm can land."""

    asked: Scenario
    refusal: str  # Why it cannot land where it is asked to; empty where it can
    nearest: Scenario | None  # With the nearest place that works, where another one is needed
    spots: list[Spot]
    radius_m: float  # Of the catch that is asked for, from the arm's first axis

    @property
    def lands(self) -> bool:
        """Whether there is a place at all."""
        return not self.refusal or self.nearest is not None

    def result(self) -> dict[str, Any]:
        """As plain data, for JSON."""
        near = None if self.nearest is None else _places(self.nearest)
        return {
            "asked": _places(self.asked),
            "refusal": self.refusal,
            "nearest": near,
            "spots": [vars(s) for s in self.spots],
        }


def reach(scenario: Scenario) -> Reach:
    """Search all places at which the scenario's arm can land, and check the one that it asks for.

    Raises:
        ConfigurationError: what no other place would mend.
    """
    believed = scenario.believed()
    arm, weight = arm_model(believed), flyer(believed).weight
    refusal, nearest = "", None
    try:
        plan(scenario, MISSION)
    except WorkspaceError as e:
        refusal = str(e)
        nearest = _nearest(scenario)
        refusal = refusal if nearest is not None else f"{refusal}. {nowhere(scenario, mission_named(MISSION))}"
    axis = first_axis(arm)
    found = everywhere(Bench(arm, believed, weight, Obstacles(believed), 0.0))
    radius = float(np.hypot(*(np.array(scenario.place.catch_m) - axis)[:2]))
    return Reach(scenario, refusal, nearest, [_spot(place, axis) for place in found], radius)


def _nearest(scenario: Scenario) -> Scenario | None:
    for one in alternatives(scenario, mission_named(MISSION), frozenset(), NEAREST):
        try:
            plan(one, MISSION)
        except ConfigurationError:
            continue
        return one
    return None


def _spot(place: Place, axis: Array) -> Spot:
    out, cradle = place.catch - axis, place.put_down - axis
    radius, distance = float(np.hypot(*out[:2])), float(np.hypot(*cradle[:2]))
    return Spot(radius, float(place.catch[2]), distance, place.heading_deg, place.merit)


def _places(scenario: Scenario) -> dict[str, Any]:
    place = scenario.place
    return {
        "catch_m": list(place.catch_m),
        "put_down_m": list(place.put_down_m),
        "home_deg": None if place.home_deg is None else list(place.home_deg),
        "heading_deg": scenario.cradle.heading_deg,
        "gap_m": scenario.cradle.gap_m,
    }
