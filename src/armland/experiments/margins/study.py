"""What a demonstrator must keep: how far each deviation alone may grow until flights fail, and which pairs are worst together."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from armland.errors import ConfigurationError
from armland.experiments.margins.corners import COMPANIONS, at, end_of, ends, largest, nested
from armland.experiments.margins.flights import NOT_FLOWN, flown, on_threads, shortened
from armland.experiments.margins.screening import Screening, screened
from armland.experiments.margins.search import MOST, Bracket, Failure, bracketed
from armland.experiments.paper import Progress, silent
from armland.scenario import Scenario
from armland.scenario.deviation import LEVELS, Level, Row, rows, unit_of


class Terms(NamedTuple):
    """What is asked of the flights."""

    mission: str = "landing"
    around: Level = "nominal"
    """Level of the other deviations while one is varied."""
    seeds: int = 3
    share: float = 1.0
    """Share of the seeds that must succeed."""
    level: Level = "published"
    """Level of the deviations in the screening design."""
    jobs: int | None = None


class Margin(NamedTuple):
    """How far one deviation alone may grow."""

    row: Row
    bracket: Bracket
    bound: float
    """Factor at which the device could not be worse."""

    @property
    def lands(self) -> float:
        """Largest factor on the published range at which the flights succeeded."""
        return self.bracket.lands

    @property
    def fails(self) -> float | None:
        """Smallest factor at which they did not; None where none was found."""
        failure = self.bracket.failure
        return self.bracket.fails if failure is None or failure.flown else None

    @property
    def holds(self) -> bool:
        """Whether the published range holds."""
        return self.lands >= 1.0

    def data(self) -> dict[str, Any]:
        """As plain data, for JSON."""
        failure, t = self.bracket.failure, self.row.told
        return {
            "row": self.row.path,
            "unit": unit_of(self.row.path),
            "meaning": self.row.meaning,
            "published": [t.low, t.high],
            "lands": self.lands,
            "fails": self.fails,
            "lands_at": list(ends(self.row, self.lands)),
            "fails_at": None if self.fails is None else list(ends(self.row, self.fails)),
            "bound": self.bound,
            "trials": self.bracket.trials,
            "failure": failure and {**failure._asdict(), "end": end_of(self.row, failure.seed)},
        }


class Margins(NamedTuple):
    """The whole study; its JSON form is described in docs/margins.md."""

    terms: Terms
    seeds: tuple[int, ...]
    margins: tuple[Margin, ...]
    """The worst first."""
    screening: Screening | None

    @property
    def holds(self) -> bool:
        """Whether every deviation alone may have its published range."""
        return all(m.holds for m in self.margins)

    def result(self) -> dict[str, Any]:
        """As plain data, for JSON."""
        s = self.screening
        effects = s and {n: [e._asdict() for e in es] for n, es in (("singles", s.singles), ("pairs", s.pairs))}
        return {
            "holds": self.holds,
            **self.terms._asdict(),
            "seeds": list(self.seeds),
            "margins": [m.data() for m in self.margins],
            "screening": s and {**s._asdict(), **(effects or {})},
        }


def study(
    scenario: Scenario, chosen: Sequence[Row], terms: Terms, pairs: bool = True, progress: Progress = silent
) -> Margins:
    """Search the margin of each row, then screen all of them for the worst pairs.

    Args:
        scenario: whose own deviations stay; its level is replaced by `terms.around`, its seed is the first.
        chosen: rows of `[deviation]`.
        terms: what is asked.
        pairs: whether to screen for pairs, which needs two rows.
        progress: called with what is done, how much, and in all.

    Raises:
        ConfigurationError: what planning the mission refuses; too few flights succeed before anything is varied.
    """
    around = scenario.replaced({"deviation": {"level": terms.around}})
    seeds = tuple(range(scenario.run.seed, scenario.run.seed + terms.seeds))
    _check_baseline(around, seeds, terms)
    total = len(chosen)
    found = on_threads(
        lambda row: margin_of(around, row, seeds, terms),
        chosen,
        terms.jobs,
        lambda done: progress("deviations", done, total),
    )
    screening = None
    if pairs and total > 1:
        screening = screened(around, terms.mission, chosen, LEVELS[terms.level], terms.jobs, progress)
    return Margins(terms, seeds, tuple(sorted(found, key=_order)), screening)


def _order(m: Margin) -> tuple[float, float]:
    # The narrowest first; of those that nothing ended the ones that reached least.
    return (math.inf if m.fails is None else m.lands, m.lands)


def margin_of(scenario: Scenario, row: Row, seeds: Sequence[int], terms: Terms) -> Margin:
    """Search the margin of one row, all others as in the scenario."""
    company, bound = [r for r in rows() if r.path == COMPANIONS.get(row.path)], largest(row)
    beside = max(1.0, LEVELS[terms.around])

    def trial(factor: float) -> Failure | None:
        return first_failure(
            scenario,
            seeds,
            terms,
            lambda seed: nested([*(at(r, beside, seed) for r in company), at(row, factor, seed)]),
        )

    return Margin(row, bracketed(trial, min(bound, MOST)), bound)


def first_failure(scenario: Scenario, seeds: Sequence[int], terms: Terms, changes: Any) -> Failure | None:
    """The first seed that fails with the `changes` of a seed, where too many do; None where enough succeed.

    Seeds that can no longer change the verdict are not flown.
    """
    allowed, failures = math.floor((1.0 - terms.share) * len(seeds) + 1e-9), []
    for seed in seeds:
        result = flown(scenario, terms.mission, seed, changes(seed))
        if not result["success"]:
            state = result["state"]
            failures.append(Failure(seed, shortened(result["reason"]), state, state != NOT_FLOWN))
        if len(failures) > allowed:
            return failures[0]
    return None


def _check_baseline(scenario: Scenario, seeds: Sequence[int], terms: Terms) -> None:
    # Where flights fail already, nothing can be said of what would make them fail.
    failure = first_failure(scenario, seeds, terms, lambda _: {})
    if failure is not None:
        raise ConfigurationError(
            f"around {terms.around!r}, with nothing varied, too few of the {len(seeds)} seeds from {seeds[0]} succeed (seed "
            f"{failure.seed}: {failure.reason}), so no margin can be searched; try --around nominal, another --seed, or a "
            f"smaller --share"
        )
