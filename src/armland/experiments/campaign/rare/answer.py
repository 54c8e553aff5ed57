"""What a rare campaign says: the rate, how sure it is, what it took, where the failures are."""

from typing import Any, NamedTuple

import numpy as np
from scipy.special import ndtr
from scipy.stats import binomtest

from armland.experiments.campaign.answers.table import Table
from armland.experiments.campaign.engine import Campaign
from armland.experiments.campaign.rare.estimate import Rate, rate_of
from armland.experiments.campaign.rare.failure import in_words, score
from armland.experiments.campaign.rare.proposal import effective
from armland.experiments.campaign.rare.search import Search
from armland.experiments.campaign.stopping import Interval
from armland.experiments.campaign.store import Store
from armland.rotations import Array

FEWEST = 10.0
"""Failures of equal weight below which an interval is not to be trusted."""
QUANTILES = (0.05, 0.5, 0.95)


class Learnt(NamedTuple):
    """One stage of learning."""

    flights: int
    failed: int
    level: float | None
    """Score of the best tenth's last, 0 where that failed; None where nothing says how near it came."""


class Place(NamedTuple):
    """Where the failures are in one parameter."""

    name: str
    all: tuple[float, ...]
    """Quantiles at `QUANTILES` of what the campaign draws."""
    failing: tuple[float, ...]
    """Of that, with which a flight fails."""


class RareReport(NamedTuple):
    """What the rows of a rare campaign say."""

    failure: str
    """In words."""
    stages: tuple[Learnt, ...]
    flights: int
    """All that were flown, those that learnt as well."""
    rate: Rate | None
    """None while it is learnt where to look."""
    equal: float
    """Failures of equal weight that say as much as those which were flown."""
    places: tuple[Place, ...]

    @property
    def gain(self) -> float:
        """How many flights of a plain campaign one of these was worth, those that learnt included; infinite where none failed."""
        return 0.0 if self.rate is None else self.rate.plain / self.flights

    @property
    def doubt(self) -> str:
        """Why not to trust the interval, or what to do; empty where nothing speaks against it."""
        if self.rate is None:
            return "It is still learnt where failures are; more --runs with --resume go on."
        if self.rate.failed == 0:
            return "No flight failed, so only an upper bound is known; more --runs with --resume narrow it."
        if self.equal < FEWEST:
            return (
                f"A few failures that weigh much carry the rate, as if {self.equal:.1f} had been seen: the interval may be too narrow. "
                "More --runs with --resume help."
            )
        if self.gain < 1.0:
            return (
                "The parameters say little about who fails: plain flights, without --rare, would have done as well. "
                "What decides is in the seeds."
            )
        return ""

    def result(self) -> dict[str, Any]:
        """It as plain data, for JSON."""
        rate = None if self.rate is None else {k: _finite(v) for k, v in self.rate._asdict().items()}
        return {
            **self._asdict(),
            "stages": [s._asdict() for s in self.stages],
            "rate": rate,
            "places": [p._asdict() for p in self.places],
            "gain": _finite(self.gain),
            "doubt": self.doubt,
        }


class Counted(NamedTuple):
    """How many flights of a point of a plain campaign failed in the way that its file asks for."""

    point: int
    flights: int
    failed: int
    wilson: Interval


def rare_report(campaign: Campaign, store: Store) -> RareReport:
    """What the rows of a store say, which is of a rare campaign and has at least one.

    Raises:
        ConfigurationError: rows that do not belong together.
    """
    search = Search(campaign)
    for row in store.rows():
        search.add(row)
    stages = [*search.stages, *([] if search.next.learnt or not search.scores else [search.so_far()])]
    learnt = tuple(Learnt(len(s.score), s.failed, _finite(min(s.level, 0.0))) for s in stages)
    flown, last = search.first + len(search.scores), search.so_far()
    rate, equal = None, 0.0
    places: tuple[Place, ...] = ()
    if search.next.learnt and len(last.score) > 1:
        weights, failed = search.next.proposal.weights(last.z), last.score >= 0.0
        rate = rate_of(weights, failed)
        if failed.any():
            equal = effective(weights[failed])
            places = _places(search, last.z[failed], weights[failed])
    return RareReport(in_words(campaign.description.failure), learnt, flown, rate, equal, places)


def counted(campaign: Campaign, store: Store, table: Table) -> tuple[Counted, ...]:
    """How many flights of each point of a plain campaign failed as its file asks for; empty for the mission's criteria."""
    failure = campaign.description.failure
    if failure is None or failure.figure is None:
        return ()
    failed = np.array([score(row, failure, campaign.bounds) >= 0.0 for row in store.rows()], bool)
    out = []
    for point in np.unique(table.point):
        here = failed[table.at(point)]
        interval = binomtest(int(here.sum()), len(here)).proportion_ci(0.95, method="wilson")
        out.append(Counted(int(point), len(here), int(here.sum()), Interval(float(interval.low), float(interval.high))))
    return tuple(out)


def _places(search: Search, z: Array, weights: Array) -> tuple[Place, ...]:
    out = []
    for i, (name, parameter) in enumerate(search.drawn.items()):
        law = parameter.quantile()
        order = np.argsort(z[:, i], kind="stable")
        below = np.cumsum(weights[order]) / weights.sum()
        at = order[np.minimum(np.searchsorted(below, QUANTILES), len(order) - 1)]
        found = law(np.array(QUANTILES)), law(ndtr(z[at, i]))
        if all(isinstance(x, int | float) and not isinstance(x, bool) for values in found for x in values):
            out.append(Place(name, *(tuple(float(x) for x in values) for values in found)))
    return tuple(out)


def _finite(x: Any) -> Any:
    # JSON has no infinity.
    return None if isinstance(x, float) and not np.isfinite(x) else x
