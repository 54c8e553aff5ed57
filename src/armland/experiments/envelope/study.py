"""The whole study of the capture: bounds, maps, the mission's thresholds among them, landings as flown, and the moving plate."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from armland.experiments.envelope.bench import Capture, CaptureBench
from armland.experiments.envelope.bounds import STANDARD, Allowed, Axis, Detail, Edge, Envelope, Map
from armland.experiments.envelope.interception import FREQUENCIES_HZ, Tracked, intercept
from armland.experiments.episode import fly
from armland.experiments.judge.brief import Ticks
from armland.experiments.judge.whereabouts import tilt_deg
from armland.experiments.paper import Progress, silent
from armland.models.capture import GATE_M
from armland.scenario import Scenario


class Flown(NamedTuple):
    """State at the gate of a landing."""

    seed: int
    offset: float  # m
    speed: float  # m/s, horizontal
    closing: float  # m/s
    tilt: float  # deg, of the UAV
    plate: float  # deg


def flown_landing(scenario: Scenario, seed: int) -> Flown | None:
    """A landing flown with `seed`; None where it never came to the gate."""
    episode = fly(scenario, "landing", seed)
    state = at_the_gate(episode.ticks, episode.metadata["phases"].split(",").index("close"))
    return None if state is None else Flown(seed, *state)


def at_the_gate(ticks: Ticks, close: int) -> tuple[float, float, float, float, float] | None:
    """Offset, speed, closing speed, UAV's and plate's tilt where a landing last passed the gate in its phase `close`; None if never."""
    truth, phase = ticks["truth"], ticks["mission"]["phase"]
    apart, v = truth["r"] - truth["ee"], truth["v"] - truth["ee_v"]
    passed = np.flatnonzero((apart[1:, 2] < GATE_M) & (apart[:-1, 2] >= GATE_M) & (phase[:-1] == close))
    if not len(passed):
        return None
    k = int(passed[-1]) + 1
    offset, speed = float(np.hypot(*apart[k, :2])), float(np.hypot(*v[k, :2]))
    return offset, speed, float(-v[k, 2]), float(tilt_deg(truth["quat"][k])), float(tilt_deg(truth["plate_quat"][k]))


UNITS = {
    "offset": "m",
    "speed": "m/s",
    "closing": "m/s",
    "tilt": "deg",
    "plate": "deg",
    "fastest": "m/s",
    "slowest": "m/s",
}


class Margin(NamedTuple):
    """A threshold of the mission beside the envelope; in SI units and degrees."""

    threshold: str
    unit: str
    value: float
    bound: float
    alone: float
    closed_form: float
    margin: float
    limit: str
    holds: bool


@dataclass(frozen=True)
class EnvelopeStudy:
    """What the study found; its JSON form is described in docs/envelope.md."""

    allowed: Allowed
    closing: float
    axes: tuple[Axis, ...]
    maps: tuple[Map, ...]
    corners: tuple[tuple[float, Capture], ...]
    flown: tuple[Flown, ...]
    tracked: tuple[Tracked, ...]
    captures: int

    def axis(self, name: str) -> Axis:
        """The axis of this name."""
        return next(a for a in self.axes if a.name == name)

    @property
    def margins(self) -> tuple[Margin, ...]:
        """Each threshold with the bound that counts for it."""
        a = self.allowed
        rows = [
            self._margin("bounds.align_offset_m", "offset", a.offset),
            self._margin("bounds.align_speed_mps", "speed", a.speed),
            self._margin("bounds.align_tilt_deg", "tilt", a.tilt),
            # Closing goes on up to this offset whatever else there is: no second threshold adds to it.
            self._margin("bounds.lost_offset_m", "offset", a.lost, alone=True),
            self._margin("closing speed, highest", "fastest", a.fastest),
            self._margin("closing speed, lowest", "slowest", a.slowest),
        ]
        return tuple(rows)

    def _margin(self, threshold: str, name: str, value: float, alone: bool = False) -> Margin:
        axis = self.axis(name)
        used = axis.bound if alone else axis.bound_together
        margin = value - used.bound if name == "slowest" else used.bound - value
        form = axis.closed if alone else axis.closed_together
        return Margin(
            threshold=threshold,
            unit=UNITS[name],
            value=shown(name, value),
            bound=shown(name, used.bound),
            alone=shown(name, axis.bound.bound),
            closed_form=shown(name, form),
            margin=shown(name, margin),
            limit=used.why,
            holds=bool(margin >= 0.0),
        )

    @property
    def corners_held(self) -> int:
        """Captures that held with all thresholds at once."""
        return sum(c.held for _, c in self.corners)

    @property
    def holds(self) -> bool:
        """Whether all thresholds lie inside."""
        return all(m.holds for m in self.margins) and self.corners_held == len(self.corners)

    @property
    def outside(self) -> list[str]:
        """What lies outside, in words."""
        words = [
            f"{m.threshold} = {m.value:.4g} {m.unit} lies outside: captures hold "
            f"{'from' if 'lowest' in m.threshold else 'up to'} {m.bound:.4g} {m.unit} ({m.limit} beyond)"
            for m in self.margins
            if not m.holds
        ]
        missed = len(self.corners) - self.corners_held
        return words + [f"{missed} of {len(self.corners)} captures fail with all thresholds at once"] * (missed > 0)

    def result(self) -> dict[str, Any]:
        """The study as plain data, for JSON."""
        return {
            "holds": self.holds,
            "outside": self.outside,
            "gate_m": GATE_M,
            "closing_mps": self.closing,
            "thresholds": [m._asdict() for m in self.margins],
            "corners": {"captures": len(self.corners), "held": self.corners_held},
            "axes": [self._axis_data(a) for a in self.axes],
            "maps": [self._map_data(m) for m in self.maps],
            "flown": [f._asdict() for f in self.flown],
            "interception": [{**t._asdict(), "amplitude": t.amplitude, "limit": t.limit} for t in self.tracked],
            "captures": self.captures,
        }

    def _axis_data(self, a: Axis) -> dict[str, Any]:
        return {
            "name": a.name,
            "unit": UNITS[a.name],
            "alone": [_edge_data(a.name, e) for e in a.alone],
            "together": [_edge_data(a.name, e) for e in a.together],
            "closed_form": shown(a.name, a.closed),
            "closed_form_together": shown(a.name, a.closed_together),
        }

    def _map_data(self, m: Map) -> dict[str, Any]:
        return {
            "x": m.x,
            "y": m.y,
            "x_unit": UNITS[m.x],
            "y_unit": UNITS[m.y],
            "at": list(m.at),
            "boundary": [_edge_data(m.y, e) for e in m.boundary],
            "closed_form": [shown(m.y, c) for c in m.closed],
            "thresholds": [shown(m.x, m.box[0]), shown(m.y, m.box[1])],
        }


def shown(name: str, value: float) -> float:
    """A value of `Start` in the unit of `UNITS`."""
    return float(np.rad2deg(value)) if UNITS[name] == "deg" else float(value)


def _edge_data(name: str, e: Edge) -> dict[str, Any]:
    return {"towards_deg": float(np.rad2deg(e.towards)), "bound": shown(name, e.bound), "limit": e.why}


def study(
    scenario: Scenario,
    detail: Detail = STANDARD,
    flights: int = 6,
    frequencies: tuple[float, ...] = FREQUENCIES_HZ,
    progress: Progress = silent,
) -> EnvelopeStudy:
    """The whole study; the same scenario gives the same study.

    Args:
        scenario: of a landing.
        detail: how fine bounds and maps are.
        flights: landings flown with the scenario's seed and those after it.
        frequencies: of the plate that the arm follows, Hz.
        progress: called with name, done and total.

    Raises:
        ConfigurationError: what planning a landing refuses.
        PlantError: a scenario whose landing does not come to a capture.
    """
    envelope = Envelope(CaptureBench(scenario), detail, progress)
    axes, maps, corners = envelope.axes(), envelope.maps(), tuple(envelope.corners())
    tracked, flown = intercept(scenario, frequencies, progress), []
    for k in range(flights):
        flown.append(flown_landing(scenario, scenario.run.seed + k))
        progress("landings", k + 1, flights)
    came = tuple(f for f in flown if f is not None)
    return EnvelopeStudy(
        envelope.allowed, envelope.bench.closing, axes, maps, corners, came, tracked, envelope.captures
    )
