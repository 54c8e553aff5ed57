"""Many flights in a few numbers: how many succeed, and the spread of each figure beside its bound."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

Row = dict[str, Any]  # The result of one episode, see `episode.Episode`


class Figure(NamedTuple):
    """One figure of merit of a flight: its name with unit, and by what it is multiplied for that unit."""

    name: str
    scale: float = 1.0


FIGURES: dict[str, Figure] = {
    "touchdown.speed_mps": Figure("touchdown speed [m/s]"),
    "touchdown.tilt_deg": Figure("touchdown tilt [°]"),
    "touchdown.offset_m": Figure("off centre [mm]", 1e3),
    "capture.offset_m": Figure("capture offset [mm]", 1e3),
    "capture.relative_speed_mps": Figure("capture speed [m/s]"),
    "capture.tilt_deg": Figure("capture tilt [°]"),
    "release.speed_mps": Figure("release speed [m/s]"),
    "release.drop_m": Figure("release drop [mm]", 1e3),
    "release.hinge_force_n": Figure("release hinge force [N]"),
    "tracking.attitude_max_deg": Figure("attitude error max [°]"),
    "hinge_force_max_n": Figure("hinge force max [N]"),
    "magnet_pull_max_n": Figure("magnet pull max [N]"),
    "magnet_shear_max_ratio": Figure("magnet shear ratio max [1]"),
    "fall_m": Figure("fall max [mm]", 1e3),
    "joint_torque_max_ratio": Figure("torque ratio max [1]"),
    "duration_s": Figure("duration [s]"),
}
"""Figures by where they stand in a row; `duration_s` is the end of the last phase."""


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
    interval: tuple[float, float]  # Wilson's interval of the probability of success at 95 %
    retries: int
    violated: dict[str, int]  # Flights that exceeded a limit, by its name
    reasons: dict[str, int]  # Why flights failed, and how many did
    spreads: list[Spread]

    def result(self) -> dict[str, Any]:
        """The summary as plain data, for JSON."""
        return {**self._asdict(), "spreads": [s._asdict() for s in self.spreads]}


def value(row: Row, figure: str) -> float | None:
    """A figure of `FIGURES` in a row, in the unit of its name; None where the flight has none."""
    found = raw(row, figure)
    return None if found is None else found * FIGURES[figure].scale


def raw(row: Row, figure: str) -> float | None:
    """A figure of `FIGURES` in a row, SI units and degrees; None where the flight has none."""
    if figure == "duration_s":
        return float(row["phases"][-1]["end_s"]) if row.get("phases") else None
    group, _, name = figure.rpartition(".")
    found = (row.get(group) or {}).get(name) if group else row.get(name)
    return None if found is None else float(found)


def summarise(rows: Sequence[Row], bounds: Mapping[str, float]) -> Summary:
    """Summary of at least one row; figures that no flight has are left out.

    Args:
        rows: of `engine.campaign`.
        bounds: largest allowed value of figures of `FIGURES`, SI units, see `judge.figures.bounds`.
    """
    # Imported here: it takes a second, which a single flight does not pay.
    from scipy.stats import binomtest

    good = sum(row["success"] for row in rows)
    interval = binomtest(good, len(rows)).proportion_ci(0.95, method="wilson")
    return Summary(
        flights=len(rows),
        successes=good,
        interval=(float(interval.low), float(interval.high)),
        retries=sum(row.get("retries", 0) for row in rows),
        violated=dict(Counter(name for row in rows for name in row.get("limits_violated", ())).most_common()),
        reasons=dict(Counter(row["reason"] for row in rows if not row["success"]).most_common()),
        spreads=[s for figure in FIGURES if (s := _spread(figure, rows, bounds.get(figure))) is not None],
    )


def _spread(figure: str, rows: Sequence[Row], bound: float | None) -> Spread | None:
    known = [(v, int(row["seed"])) for row in rows if (v := value(row, figure)) is not None]
    if not known:
        return None
    (worst, seed), values = max(known), np.array([v for v, _ in known])
    name, scale = FIGURES[figure]
    limit = None if bound is None else bound * scale
    return Spread(name, float(np.median(values)), float(np.percentile(values, 95)), worst, seed, limit)
