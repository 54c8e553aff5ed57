"""What a campaign of landings or take-offs shows: how many succeed, and the spread of each figure beside its bound."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from armland.experiments.landing import LandingOutcome
from armland.experiments.landing_judge import PLACED_M, TOUCHDOWN_SPEED_MPS, TOUCHDOWN_TILT_DEG


class Figure(NamedTuple):
    """One figure of merit of a flight: name with unit, where it stands in an outcome, and the judge's upper bound."""

    name: str
    of: Callable[[LandingOutcome], float | None]
    bound: float | None = None


class Spread(NamedTuple):
    """A figure over all flights that have it."""

    name: str
    median: float
    p95: float
    worst: float
    worst_seed: int
    bound: float | None

    @property
    def holds(self) -> bool:
        """Whether the worst flight keeps the bound; true where there is none."""
        return self.bound is None or self.worst <= self.bound * (1.0 + 1e-9)


class Summary(NamedTuple):
    """A whole campaign."""

    flights: int
    successes: int
    interval: tuple[float, float]
    """Wilson's interval of the probability of success at 95 %."""
    retries: int
    violated: dict[str, int]
    """Flights that exceeded a limit, by its name."""
    reasons: dict[str, int]
    """Why flights failed, and how many did."""
    spreads: list[Spread]

    def result(self) -> dict[str, Any]:
        """The summary as plain data, for JSON."""
        return {**self._asdict(), "spreads": [s._asdict() for s in self.spreads]}


def figures(hinge_bound_n: float) -> tuple[Figure, ...]:
    """The figures of a campaign; `hinge_bound_n`: largest hinge force allowed, N."""
    return (
        Figure("touchdown speed [m/s]", lambda o: o.touchdown.get("speed_mps"), TOUCHDOWN_SPEED_MPS),
        Figure("touchdown tilt [°]", lambda o: o.touchdown.get("tilt_deg"), TOUCHDOWN_TILT_DEG),
        Figure("off centre [mm]", lambda o: _scaled(o.touchdown.get("offset_m")), 1e3 * PLACED_M),
        Figure("capture offset [mm]", lambda o: _scaled(o.capture.get("offset_m"))),
        Figure("capture speed [m/s]", lambda o: o.capture.get("relative_speed_mps")),
        Figure("capture tilt [°]", lambda o: o.capture.get("tilt_deg")),
        Figure("release speed [m/s]", lambda o: o.release.get("speed_mps")),
        Figure("release drop [mm]", lambda o: _scaled(o.release.get("drop_m"))),
        Figure("release hinge force [N]", lambda o: o.release.get("hinge_force_n")),
        Figure("hinge force max [N]", lambda o: o.hinge_force_max_n, hinge_bound_n),
        Figure("torque ratio max [1]", lambda o: o.joint_torque_max_ratio, 1.0),
        Figure("duration [s]", lambda o: o.phases[-1].end_s if o.phases else None),
    )


def summarise(outcomes: Sequence[LandingOutcome], hinge_bound_n: float) -> Summary:
    """Summary of at least one outcome; figures that no flight has are left out.

    Args:
        outcomes: of `campaign`.
        hinge_bound_n: largest hinge force allowed, N.
    """
    # Imported here: it takes a second, which a single flight does not pay.
    from scipy.stats import binomtest

    good = sum(o.success for o in outcomes)
    interval = binomtest(good, len(outcomes)).proportion_ci(0.95, method="wilson")
    violated, reasons = (
        _count(n for o in outcomes for n in o.limits_violated),
        _count(o.reason for o in outcomes if not o.success),
    )
    spreads = [s for f in figures(hinge_bound_n) if (s := _spread(f, outcomes)) is not None]
    low, high = float(interval.low), float(interval.high)
    return Summary(len(outcomes), good, (low, high), sum(o.retries for o in outcomes), violated, reasons, spreads)


def _spread(figure: Figure, outcomes: Sequence[LandingOutcome]) -> Spread | None:
    known = [(v, o.seed) for o in outcomes if (v := figure.of(o)) is not None]
    if not known:
        return None
    values = np.array([v for v, _ in known])
    worst, seed = max(known)
    return Spread(figure.name, float(np.median(values)), float(np.percentile(values, 95)), worst, seed, figure.bound)


def _scaled(metres: float | None) -> float | None:
    return None if metres is None else 1e3 * metres


def _count(names: Any) -> dict[str, int]:
    out: dict[str, int] = {}
    for name in names:
        out[name] = out.get(name, 0) + 1
    return dict(sorted(out.items(), key=lambda item: -item[1]))
