"""What a study found: what each change gives, with its interval, what is told apart from chance, and what is not.

Each change is held against the scenario as it is, seed by seed: Agresti's and Min's interval of the difference of the rates of success,
and McNemar's exact test of it, both of `campaign.answers.paired`. Of many changes some differ by chance: the tests' probabilities are
raised so that of what is called told apart one in twenty is expected to be nothing (Benjamini and Hochberg).

A success is yes or no, and says little of forty flights. How often the arm missed the plate says more: it is given beside it, as the
mean of the differences by seed, with a bootstrap interval.

Source: Y. Benjamini, Y. Hochberg: Controlling the false discovery rate, Journal of the Royal Statistical Society B 57, 1995.
"""

from typing import Any, NamedTuple

import numpy as np
from scipy.stats import binomtest, bootstrap, false_discovery_control

from armland.experiments.campaign.answers.paired import Difference, Pairing
from armland.experiments.campaign.answers.report import PointReport, Report
from armland.experiments.campaign.stopping import Interval
from armland.experiments.campaign.store import Store
from armland.experiments.study.table import Change, Study
from armland.rotations import Array

TOLD = 0.05
"""Largest share of nothing among what is called told apart."""

RESAMPLES = 4000


class Gain(NamedTuple):
    """What one change does, or what a term gives that it takes away."""

    name: str
    group: str
    means: str
    flights: int
    successes: int
    wilson: Interval
    rate: Difference
    """Of the rates of success: with the term less without it, or the change less what there is."""
    only_usual: int
    """Seeds with which only the scenario as it is succeeds."""
    only_changed: int
    chance: float
    """McNemar's exact test."""
    raised: float
    """The same, raised for the number of changes."""
    misses: Difference
    """Missed captures of a flight, mean, of the same pair."""
    same: int
    """Seeds with which the flight is the same bit for bit: what is changed never came into play."""

    @property
    def told(self) -> bool:
        """Whether its success is told apart from chance."""
        return self.raised < TOLD


class Findings(NamedTuple):
    """All gains, the largest first."""

    study: Study
    usual: PointReport
    gains: tuple[Gain, ...]
    least: float | None
    """Smallest difference of rates that McNemar's test alone tells apart; None where flights are too few for any."""

    def result(self) -> dict[str, Any]:
        """The findings as plain data, for JSON."""
        gains = [
            {**g._asdict(), "rate": g.rate._asdict(), "misses": g.misses._asdict(), "told": g.told} for g in self.gains
        ]
        usual = {"name": self.usual.name, "flights": self.usual.flights, "successes": self.usual.successes}
        return {"study": self.study.name, "usual": usual, "gains": gains, "least": self.least}


def answer(study: Study, report: Report, store: Store) -> Findings:
    """What the rows of a study's campaign say; changes of which no seed is flown yet are left out.

    Args:
        study: of which the store is.
        report: of the store.
        store: its rows.
    """
    changes = {change.name: change for change in study.changes}
    points = {p.point: p for p in report.points}
    flown = _flown(store)
    pairings = [p for p in report.pairings if points[p.second].name in changes]
    raised = false_discovery_control([p.chance for p in pairings]) if pairings else []
    gains = [
        _gain(changes[points[p.second].name], points[p.second], p, float(up), flown, study.removes)
        for p, up in zip(pairings, raised, strict=True)
    ]
    gains.sort(key=lambda g: (-g.rate.value, g.misses.value))
    usual = points[0]
    return Findings(study, usual, tuple(gains), least_told(min((g.rate.pairs for g in gains), default=0)))


def least_told(pairs: int) -> float | None:
    """Smallest difference of rates, a ratio, that McNemar's exact test tells from chance at 5 %, of so many pairs; None if none."""
    all_one_way = next(k for k in range(1, 100) if binomtest(k, k).pvalue < TOLD)
    return all_one_way / pairs if pairs >= all_one_way else None


def mean_difference(name: str, first: Array, second: Array) -> Difference:
    """Mean of `second` less `first`, both (n,) of the same seeds, in their own unit, with a bootstrap interval at 95 %."""
    apart = np.asarray(second, float) - first
    if len(apart) < 2 or np.ptp(apart) == 0.0:
        return Difference(name, float(apart.mean()), float(apart.mean()), float(apart.mean()), len(apart))
    rng = np.random.default_rng(0)
    found = bootstrap((apart,), np.mean, n_resamples=RESAMPLES, method="percentile", rng=rng, vectorized=True)
    interval = found.confidence_interval
    return Difference(name, float(apart.mean()), float(interval.low), float(interval.high), len(apart))


def _gain(change: Change, point: PointReport, p: Pairing, raised: float, flown: "_Flown", removes: bool) -> Gain:
    misses, same = _beside(flown, p)
    rate = _turned(p.rate) if removes else p.rate
    more = _turned(misses) if removes else misses
    return Gain(
        change.name,
        change.group,
        change.means,
        point.flights,
        point.successes,
        point.wilson,
        rate,
        p.only_first,
        p.only_second,
        p.chance,
        raised,
        more,
        same,
    )


def _turned(d: Difference) -> Difference:
    # From zero, so that nothing is no less than nothing.
    return d._replace(value=0.0 - d.value, low=0.0 - d.high, high=0.0 - d.low)


_Flown = dict[int, dict[int, tuple[float, str]]]


def _flown(store: Store) -> _Flown:
    # Missed captures, and what the ticks are known by, by point and seed.
    found: _Flown = {}
    for row in store.rows():
        if row.result is not None:
            found.setdefault(row.point, {})[row.seed] = float(row.result.get("retries", 0)), row.digest
    return found


def _beside(flown: _Flown, p: Pairing) -> tuple[Difference, int]:
    # What is told beside success: the difference of missed captures, and how many flights are the same.
    first, second = flown.get(p.first, {}), flown.get(p.second, {})
    seeds = sorted(first.keys() & second.keys())
    if not seeds:
        return Difference("misses", np.nan, np.nan, np.nan, 0), 0
    same = sum(first[s][1] == second[s][1] != "" for s in seeds)
    missed = (np.array([point[s][0] for s in seeds]) for point in (first, second))
    return mean_difference("misses", *missed), same
