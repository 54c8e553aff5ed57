"""The capture envelope: offsets, speeds and tilts at the gate from which the magnet grips the plate and keeps it.

Each bound is where captures on `CaptureBench` first fail on the way outwards; beside it stands the closed form of `models.capture`.
A bound is searched in several directions; the smallest counts. `alone`: everything else as in the flight without imperfections.
`together`: everything else at the mission's thresholds, and in the same direction, where it adds up.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from armland.experiments.capture_bench import GATE_M, Capture, CaptureBench, Start
from armland.models import capture as closed

Progress = Callable[[str, int, int], None]

TOP = {
    "offset": 0.012,
    "speed": 0.40,
    "tilt": np.deg2rad(40.0),
    "plate": np.deg2rad(44.0),
    "fastest": 1.2,
    "slowest": 0.0,
}
"""How far a search goes, in the unit of `Start`."""

QUANTITIES = {
    "offset": "offset",
    "speed": "speed",
    "tilt": "tilt",
    "plate": "plate",
    "fastest": "closing",
    "slowest": "closing",
}
"""The field of `Start` that each axis moves; the last two begin at the flight's own closing speed."""


class Detail(NamedTuple):
    """How fine the study is."""

    directions: int = 8
    corners: int = 4  # directions with everything else at its threshold
    points: int = 9  # of a map's boundary
    coarse: int = 5  # steps outwards
    fine: int = 4  # halvings of the step in which captures begin to fail


STANDARD = Detail()


class Edge(NamedTuple):
    """Where captures begin to fail on one way outwards."""

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
    """First failure of `caught` on the way from `start` to `top`: steps outwards, then halvings between held and failed."""
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

    def __init__(self, bench: CaptureBench, detail: Detail = STANDARD, progress: Progress | None = None) -> None:
        self.bench, self.detail, self._progress = bench, detail, progress
        b, closing = bench.scenario.landing.bounds, bench.closing
        # The relative speed that the mission allows may as well lie along the approach.
        slowest, fastest = max(closing - b.align_speed_mps, 0.0), closing + b.align_speed_mps
        tilt = float(np.deg2rad(b.align_tilt_deg))
        self.allowed = Allowed(b.align_offset_m, b.align_speed_mps, tilt, b.lost_offset_m, slowest, fastest)
        self.captures = 0
        gear, model = bench.plant.scene.gear, bench.plant.scene.model
        self.grip = closed.Grip(
            plate_radius=gear.plate.radius,
            pad_radius=gear.magnet.pad_radius,
            drop=gear.plate.drop,
            rated_force=gear.magnet.rated_force,
            gap_scale=gear.magnet.gap_scale,
            shear_share=gear.magnet.shear_share,
            brake_s=float(model.pair("cushion_1").solref[0]),
            reach=gear.magnet.reach,
        )
        p = bench.setup.parameters[0]
        self.mass, self.body = float(p["mass"]), float(p["body_mass"])
        self.arm = float(bench.arm_inertia[2, 2])

    def catch(self, **start: float) -> Capture:
        """One capture."""
        self.captures += 1
        return self.bench.capture(Start(**start))

    def _outwards(self, towards: float, **fixed: float) -> dict[str, float]:
        """The start `fixed` with all directions `towards`."""
        return {"offset_to": towards, "speed_to": towards, "tilt_to": towards, "plate_to": towards, **fixed}

    def axes(self) -> tuple[Axis, ...]:
        """Bounds of each quantity alone, and together with the others at their thresholds."""
        a, found = self.allowed, []
        thresholds = {"offset": a.offset, "speed": a.speed, "tilt": a.tilt}
        for done, (name, quantity) in enumerate(QUANTITIES.items()):
            others = {k: v for k, v in thresholds.items() if k != quantity}
            if quantity == "closing":
                # The mission bounds the magnitude of the speed: what lies along the approach is not across.
                del others["speed"]
            ways = self._ways(self.detail.directions)
            alone = tuple(self._edge(name, way, {}) for way in (ways[:1] if quantity == "closing" else ways))
            together = tuple(self._edge(name, way, others) for way in self._ways(self.detail.corners))
            found.append(Axis(name, alone, together, self.closed_form(name), self.closed_form(name, **others)))
            if self._progress is not None:
                self._progress("bounds", done + 1, len(QUANTITIES))
        return tuple(found)

    @staticmethod
    def _ways(count: int) -> list[float]:
        return [2.0 * np.pi * k / count for k in range(count)]

    def _edge(self, name: str, towards: float, others: dict[str, float]) -> Edge:
        quantity, start = QUANTITIES[name], self._outwards(towards, **others)
        begin = self.bench.closing if quantity == "closing" else 0.0
        return edge(lambda value: self.catch(**{**start, quantity: value}), begin, TOP[name], self.detail, towards)

    def maps(self) -> tuple[Map, ...]:
        """Boundaries of pairs towards a pad, the worst direction: there the plate bares the pad opposite first."""
        a = self.allowed
        pairs = (
            ("offset", "speed", {"tilt": a.tilt}, (a.offset, a.speed)),
            ("offset", "tilt", {"speed": a.speed}, (a.offset, a.tilt)),
            ("closing", "speed", {"offset": a.offset, "tilt": a.tilt}, (a.fastest, a.speed)),
        )
        total = len(pairs) * self.detail.points
        found: list[Map] = []
        for x, y, held, box in pairs:
            top = {"offset": 0.008, "closing": 0.8}[x]
            at = tuple(top * k / (self.detail.points - 1) for k in range(self.detail.points))
            boundary = []
            for value in at:
                fixed = {**held, x: value}
                boundary.append(self._edge(y, 0.0, fixed))
                if self._progress is not None:
                    self._progress("maps", len(found) * self.detail.points + len(boundary), total)
            forms = tuple(self.closed_form(y, **{**held, x: value}) for value in at)
            found.append(Map(x, y, at, tuple(boundary), forms, box))
        return tuple(found)

    def closed_form(
        self, name: str, offset: float = 0.0, speed: float = 0.0, tilt: float = 0.0, closing: float | None = None
    ) -> float:
        """Closed form of the bound of `name` with the others as given; in the unit of `Start`."""
        closing = self.bench.closing if closing is None else closing
        force = float(self.bench.setup.parameters["hinge_max"][0])
        fastest = closed.closing_speed_bound(self.grip, self.mass, self.body, self.arm, force, GATE_M)
        clearance = closed.covered_offset(self.grip) - offset
        if name == "fastest":
            return fastest
        if closing > fastest:
            return 0.0
        time = closed.closing_time(self.grip, self.mass, closing, GATE_M)
        if name == "offset":
            return max(clearance - self._drift(speed, tilt, time), 0.0)
        if name == "speed":
            return closed.lateral_speed_bound(
                self.grip, self.mass, closing, GATE_M, offset + self._drift(0.0, tilt, time)
            )
        if name == "plate":
            return closed.covered_tilt(self.grip, offset)
        # What fits by bisection over a grid: tilts up to where the supervisor gives up, closing speeds from none on.
        if name == "tilt":
            grid = np.linspace(0.0, float(self.bench.setup.parameters["tilt_max"][0]), 200)
            fits = [t for t in grid if self._drift(speed, t, time) <= clearance]
            return float(max(fits, default=0.0))
        grid = np.linspace(0.0, fastest, 100)
        times = [closed.closing_time(self.grip, self.mass, v, GATE_M) for v in grid]
        fits = [v for v, t in zip(grid, times, strict=True) if self._drift(speed, tilt, t) <= clearance]
        return float(min(fits, default=fastest))

    def _drift(self, speed: float, tilt: float, time: float) -> float:
        """Way in m of the pivot aside during `time` s until contact, and of the sliding after it.

        A tilted UAV rights itself about its centre of mass and throws its pivot aside. That its thrust's slope accelerates it the
        arm knows from the attitude, and follows.
        """
        landing, d = self.bench.scenario.landing, self.bench.scenario.demonstrator
        lever, inertia = abs(d.uav.lever_m[2]), d.uav.inertia_kgm2[0][0]
        a = lever * landing.onboard_kp_nm[0] * tilt / inertia
        way, v = closed.righting(a, d.rotors.time_constant_s, time)
        return speed * time + way + closed.slide(self.grip, self.mass, speed + v)

    def corners(self) -> list[tuple[float, Capture]]:
        """Captures with all thresholds at once: (direction in rad, what came of it); the speed from along the approach to across."""
        a, out = self.allowed, []
        for way in self._ways(self.detail.directions):
            for slope in np.deg2rad([-90.0, -45.0, 0.0, 45.0, 90.0]):
                closing = max(self.bench.closing + a.speed * float(np.sin(slope)), 0.0)
                start = self._outwards(way, offset=a.offset, speed=a.speed * float(np.cos(slope)), tilt=a.tilt)
                out.append((way, self.catch(**start, closing=closing)))
        return out
