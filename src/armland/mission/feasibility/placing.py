"""Scenarios in which an arm can land, where the one that is wanted does not work: other places, and a slot that a wide arm can pass."""

from collections.abc import Callable, Iterator

from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.belief import flyer
from armland.mission.feasibility.hindrance import hindrance
from armland.mission.feasibility.obstacles import Obstacles
from armland.mission.feasibility.places import Bench, Place, places
from armland.mission.feasibility.reach import survey
from armland.mission.table.mission import Mission
from armland.models.parameters import arm_model
from armland.scenario import Scenario

TRIES = 10
"""Places of each heading that are checked in full, the best first."""

MOST = 4
"""Places that are tried in full, plant included."""

WIDE_GAP_M, WIDE_ARM_M = 0.29, 0.20
"""Slot for an arm whose wrist is beside its forearm: the skids still reach 2 cm beyond its rails. The arm then follows a UAV sideways
by 3 cm only."""

MOVES = {"place.catch_m": "catch", "place.put_down_m": "put_down"}
SLOT = ("cradle.gap_m", "arm.width_m")


def kept(scenario: Scenario) -> frozenset[str]:
    """Those of "catch" and "put_down" that the user set."""
    return frozenset(name for key, name in MOVES.items() if key in scenario.asked)


def alternatives(
    scenario: Scenario, mission: Mission, keep: frozenset[str], nearness: float, seen: list[Place] | None = None
) -> Iterator[Scenario]:
    """Scenarios with other places, in which nothing that is known of the arm speaks against the mission; the best first.

    Args:
        scenario: as it is wanted.
        mission: one with way points.
        keep: those of "catch" and "put_down" that stay where they are.
        nearness: merit that a metre from the wanted catch costs, 1/m.
        seen: gets all places that are looked at more closely; where it stays empty another nearness finds none either.
    """
    arm, weight = arm_model(scenario.believed()), flyer(scenario.believed()).weight
    for wide in _slots(scenario):
        believed = wide.believed()
        bench = Bench(arm, believed, weight, Obstacles(believed), nearness)
        for found in places(bench, keep):
            if seen is not None:
                seen += found
            for place in found[:TRIES]:
                one = place.of(wide)
                try:
                    survey(arm, one.believed(), mission, weight, bench.obstacles)
                except ConfigurationError:
                    continue
                yield one


def _slots(scenario: Scenario) -> Iterator[Scenario]:
    yield scenario
    c, a = scenario.cradle, scenario.arm
    if not scenario.asked.intersection(SLOT) and c.gap_m < WIDE_GAP_M and a.width_m < WIDE_ARM_M:
        yield scenario.replaced({"cradle": {"gap_m": WIDE_GAP_M}, "arm": {"width_m": WIDE_ARM_M}})


def told_places(one: Scenario, wanted: Scenario) -> str:
    """Where `one` has catch and cradle, as settings, with what else of the cradle differs from `wanted`."""
    text = f"place.catch_m = {list(one.place.catch_m)} with place.put_down_m = {list(one.place.put_down_m)}"
    for section, key in (("cradle", "heading_deg"), ("cradle", "gap_m"), ("arm", "width_m")):
        value = getattr(getattr(one, section), key)
        if value != getattr(getattr(wanted, section), key):
            text += f", {section}.{key} = {value:g}"
    return text


def refused(
    scenario: Scenario, mission: Mission, refusal: WorkspaceError, make: Callable[[Scenario], object]
) -> WorkspaceError:
    """The refusal of a scenario, with the nearest place at which `make` refuses nothing, or what stands in the way of all of them."""
    stands = ""
    for tried, near in enumerate(alternatives(scenario, mission, frozenset(), NEAREST)):
        try:
            make(near)
        except ConfigurationError as e:
            stands = stands or f"No place was found for this arm: at {told_places(near, scenario)} {e}"
            if tried + 1 >= MOST:
                break
            continue
        home = f"place.home_deg = {list(near.place.home_deg or ())}"
        return WorkspaceError(f"{refusal}. This arm could catch at {told_places(near, scenario)} and {home}")
    return WorkspaceError(f"{refusal}. {stands or nowhere(scenario, mission)}")


def nowhere(scenario: Scenario, mission: Mission) -> str:
    """That no place was found for the scenario's arm, and the first thing that stands in the way."""
    why = hindrance(scenario, mission)
    return f"No place was found for this arm. {why}" if why else NOWHERE


BEST, NEAREST = 0.5, 5.0
"""Merit that a metre from the wanted catch costs, where the best place is wanted and where the nearest."""

NOWHERE = (
    "No place was found for this arm: none within its reach, up and down by the way of a landing, is clear of floor and cradle and at "
    "the margins to its joints' ends, to singularities and of its torques that the supervisor holds it to"
)
