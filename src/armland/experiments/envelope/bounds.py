"""The capture envelope: offsets, speeds and tilts at the gate from which the magnet grips the plate and keeps it.

Each bound is where captures on `CaptureBench` first fail going outwards; beside it stands the closed form. A bound is searched in
several directions; the smallest counts. `alone`: everything else as in the flight without imperfections. `together`: everything
else at the mission's thresholds, and in the same direction, where it adds up.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from armland.experiments.envelope.bench import Capture, CaptureBench, Start
from armland.experiments.paper import Progress, silent

QUANTITIES = {
    "offset": ("offset", 0.012),
    "speed": ("speed", 0.40),
    "tilt": ("tilt", np.deg2rad(40.0)),
    "plate": ("plate", np.deg2rad(29.0)),
    "fastest": ("closing", 1.2),
    "slowest": ("closing", 0.0),
}
"""By axis: the field of `Start` that it moves, and how far a search goes, in that field's unit.

A plate leans at most to the stop of its hinge. The last two begin at the flight's own closing speed.
"""


class Detail(NamedTuple):
    """How fine the study is."""

    directions: int = 8
    corners: int = 4  # directions with everything else at its threshold
    points: int = 9  # of a map's boundary
    coarse: int = 5  # steps outwards
    fine: int = 4  # halvings of the step in which captures begin to fail


STANDARD = Detail()


class Edge(NamedTuple):
    """Where captures begin to fail in one direction."""

    bound: float  # in the unit of `Start`
    why: str  # what fails beyond it
    towards: float = 0.0  # rad


class Axis(NamedTuple):
    """Bounds of one quantity."""

    name: str
    alone: tuple[Edge, ...]  # one for each direction
    together: tuple[Edge, ...]
    closed: float  # closed forms of the two
    closed_together: float

    @property
    def bound(self) -> Edge:
        """The tightest bound with everything else as in flight."""
        return self._tightest(self.alone)

    @property
    def bound_together(self) -> Edge:
        """The tightest bound with everything else at the mission's thresholds."""
        return self._tightest(self.together)

    def _tightest(self, edges: tuple[Edge, ...]) -> Edge:
        return (max if self.name == "slowest" else min)(edges, key=lambda e: e.bound)


class Map(NamedTuple):
    """Boundary of two quantities, the others at the mission's thresholds."""

    x: str
    y: str
    at: tuple[float, ...]
    boundary: tuple[Edge, ...]
    closed: tuple[float, ...]
    box: tuple[float, float]  # the mission's thresholds


class Allowed(NamedTuple):
    """What the mission's thresholds let through, in the unit of `Start`."""

    offset: float
    speed: float
    tilt: float
    lost: float  # offset at which closing is given up
    slowest: float  # closing speed at the gate
    fastest: float


def edge(caught: Callable[[float], Capture], start: float, top: float, detail: Detail, towards: float = 0.0) -> Edge:
    """First failure of `caught` from `start` to `top`: steps outwards, then halvings between held and failed."""
    low, high, why = start, start, "held as far as searched"
    for k in range(detail.coarse + 1):
        high = start + (top - start) * k / detail.coarse
        result = caught(high)
        if not result.held:
            why = result.why
            break
        low = high
    if low == high or high == start:
        return Edge(low, why, towards)
    for _ in range(detail.fine):
        middle = 0.5 * (low + high)
        result = caught(middle)
        if result.held:
            low = middle
        else:
            high, why = middle, result.why
    return Edge(low, why, towards)


class Envelope:
    """The study on one bench.

    Args:
        bench: where captures are made.
        detail: how fine.
        progress: called with name, done and total.
    """

    def __init__(self, bench: CaptureBench, detail: Detail = STANDARD, progress: Progress = silent) -> None:
        self.bench, self.detail, self._progress = bench, detail, progress
        b, closing = bench.scenario.bounds, bench.closing
        # The relative speed that the mission allows may as well lie along the approach.
        slowest, fastest = max(closing - b.align_speed_mps, 0.0), closing + b.align_speed_mps
        tilt = float(np.deg2rad(b.align_tilt_deg))
        self.allowed = Allowed(b.align_offset_m, b.align_speed_mps, tilt, b.lost_offset_m, slowest, fastest)
        self.forms = bench.closed_forms()
        self.captures = 0

    def catch(self, **start: float) -> Capture:
        """One capture."""
        self.captures += 1
        return self.bench.capture(Start(**start))

    def axes(self) -> tuple[Axis, ...]:
        """Bounds of each quantity alone, and together with the others at their thresholds."""
        a, found = self.allowed, []
        thresholds = {"offset": a.offset, "speed": a.speed, "tilt": a.tilt}
        for done, (name, (quantity, _)) in enumerate(QUANTITIES.items()):
            others = {k: v for k, v in thresholds.items() if k != quantity}
            around = directions(self.detail.directions)
            if quantity == "closing":
                # The mission bounds the magnitude of the speed: what lies along the approach is not across.
                del others["speed"]
                around = around[:1]
            alone = tuple(self.edge(name, towards) for towards in around)
            together = tuple(self.edge(name, towards, **others) for towards in directions(self.detail.corners))
            found.append(Axis(name, alone, together, self.forms.bound(name), self.forms.bound(name, **others)))
            self._progress("bounds", done + 1, len(QUANTITIES))
        return tuple(found)

    def edge(self, name: str, towards: float, **others: float) -> Edge:
        """Bound of a quantity of `QUANTITIES` towards an angle, rad, with others as given."""
        (quantity, top), start = QUANTITIES[name], outwards(towards, **others)
        begin = self.bench.closing if quantity == "closing" else 0.0
        return edge(lambda value: self.catch(**{**start, quantity: value}), begin, top, self.detail, towards)

    def maps(self) -> tuple[Map, ...]:
        """Boundaries of pairs towards a pad, the worst direction: there the plate bares the pad opposite first."""
        a, points = self.allowed, self.detail.points
        pairs = (
            ("offset", "speed", {"tilt": a.tilt}, (a.offset, a.speed)),
            ("offset", "tilt", {"speed": a.speed}, (a.offset, a.tilt)),
            ("closing", "speed", {"offset": a.offset, "tilt": a.tilt}, (a.fastest, a.speed)),
        )
        found: list[Map] = []
        for x, y, held, box in pairs:
            top = {"offset": 0.008, "closing": 0.8}[x]
            at = tuple(top * k / (points - 1) for k in range(points))
            boundary = []
            for value in at:
                boundary.append(self.edge(y, 0.0, **held, **{x: value}))
                self._progress("maps", len(found) * points + len(boundary), len(pairs) * points)
            forms = tuple(self.forms.bound(y, **held, **{x: value}) for value in at)
            found.append(Map(x, y, at, tuple(boundary), forms, box))
        return tuple(found)

    def corners(self) -> list[tuple[float, Capture]]:
        """Captures with all thresholds at once: (direction in rad, what came of it); the speed from along the approach to across."""
        a, out = self.allowed, []
        for towards in directions(self.detail.directions):
            for slope in np.deg2rad([-90.0, -45.0, 0.0, 45.0, 90.0]):
                closing = max(self.bench.closing + a.speed * float(np.sin(slope)), 0.0)
                start = outwards(towards, offset=a.offset, speed=a.speed * float(np.cos(slope)), tilt=a.tilt)
                out.append((towards, self.catch(**start, closing=closing)))
        return out


def directions(count: int) -> list[float]:
    """`count` directions around the vertical, rad."""
    return [2.0 * np.pi * k / count for k in range(count)]


def outwards(towards: float, **fixed: float) -> dict[str, float]:
    """The start `fixed` with all its directions `towards`."""
    return {"offset_to": towards, "speed_to": towards, "tilt_to": towards, "plate_to": towards, **fixed}
