"""A mission as one value: phases, start, places, thresholds, faults, what it is judged by, and what it says of itself."""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Literal, NamedTuple

from armland.mission.supervisor.table import ESCALATION, FAULT_TABLE
from armland.mission.table.phases import Phase
from armland.scenario import Scenario

Start = Literal["hinged", "air", "cradle"]


class At(NamedTuple):
    """A point of the end effector, deck axes: a key of `place`, raised by `above` times another key of it or by metres."""

    place: str
    above: float = 0.0
    of: str | None = None

    def height(self, scenario: Scenario) -> float:
        """How far above the place it lies, m."""
        return self.above * float(getattr(scenario.place, self.of)) if self.of else self.above


class Criterion(NamedTuple):
    """One bound that a judge holds against the record of a flight, in words and as a number."""

    name: str
    bound: float
    unit: str
    meaning: str


class Mission(NamedTuple):
    """All that tells one mission from another, as a value. What is a function takes the believed scenario."""

    name: str
    summary: str
    start: Start
    """Where the UAV is when the mission begins: on the hinge for good, in the air, on the cradle."""
    phases: Callable[[Scenario], tuple[Phase, ...]]
    """The phases of the scenario's version, ends included."""
    uses: tuple[str, ...]
    """Prefixes of the dotted paths of the scenario's keys that it uses."""
    points: Callable[[Scenario], tuple[At, ...]] = lambda _: ()
    """What the end effector visits, in order; none where the mission follows a path."""
    targets: Mapping[str, At] = MappingProxyType({})
    """Phase that moves -> where it ends; `place.catch_m` for the others."""
    moves: Mapping[str, tuple[At, At]] = MappingProxyType({})
    """Phase with a move -> from where to where the end effector then goes, in the order flown: what a slow arm takes longer for."""
    thresholds: Callable[[Scenario], dict[str, float]] = lambda _: {}
    """Thresholds beyond those of `bounds`, by name, in the units of their signals."""
    faults: Mapping[str, Mapping[str, str]] = MappingProxyType(FAULT_TABLE)
    """Fault -> kind of phase -> end."""
    escalation: Mapping[str, Mapping[str, str]] = MappingProxyType(ESCALATION)
    """End -> second fault -> graver end."""
    timeouts: Mapping[str, str] = MappingProxyType({})
    """Phase -> why it can run out of time, and what helps."""
    criteria: tuple[Criterion, ...] = ()
    experiment: str | None = None
    """Row of `[experiments]` that it flies; `track` is told which."""
    judged_as: str = ""
    """Which judge of `experiments.judge` looks at its record."""
    praise: str = ""
    """What the UAV does after a success."""
    doc: str = ""
    """Its page's text."""
