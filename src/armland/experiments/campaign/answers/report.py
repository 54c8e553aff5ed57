"""What a campaign says: rates with their intervals, quantiles, points compared by seed, what failure depends on, the worst flights."""

from typing import Any, NamedTuple

import numpy as np
from scipy.stats import binomtest

from armland.experiments.campaign.answers.paired import Pairing, compare
from armland.experiments.campaign.answers.sensitivity import Sensitivity, as_numbers, sensitivity
from armland.experiments.campaign.answers.table import Table, tabulate
from armland.experiments.campaign.description import Description
from armland.experiments.campaign.engine import Campaign, campaign_of
from armland.experiments.campaign.rare.answer import Counted, RareReport, counted, rare_report
from armland.experiments.campaign.rows import BROKE, KILLED, REFUSED
from armland.experiments.campaign.stopping import Interval, Watch
from armland.experiments.campaign.store import Store
from armland.experiments.campaign.summary import FIGURES

QUANTILES = (0.05, 0.5, 0.95, 0.99)
WORST = 10
MOST_COMPARED = 20


class Quantiles(NamedTuple):
    """A figure over the flights of a point that have it."""

    figure: str
    """Key of `summary.FIGURES`."""
    name: str
    flights: int
    quantiles: tuple[float, ...]
    """At `QUANTILES`, in the unit of the name."""
    worst: float
    worst_run: int
    bound: float | None


class PointReport(NamedTuple):
    """What came of one point."""

    point: int
    name: str
    flights: int
    successes: int
    wilson: Interval
    """Wilson's interval of the rate at 95 %, for a number of flights that was fixed before."""
    always: Interval
    """The confidence sequence at 95 %, which holds however often somebody looked."""
    figures: tuple[Quantiles, ...]


class Worst(NamedTuple):
    """One of the worst flights."""

    run: int
    seed: int
    success: bool
    share: float
    """Largest figure over its bound, a ratio."""
    why: str
    values: dict[str, Any]


class Report(NamedTuple):
    """All that is said of a campaign."""

    campaign: Campaign
    versions: dict[str, str]
    until: float | None
    """Half width of the rates' intervals, a ratio, at which it was to stop."""
    rows: int
    planned: int
    points: tuple[PointReport, ...]
    pairings: tuple[Pairing, ...]
    sensitivity: Sensitivity
    worst: tuple[Worst, ...]
    reasons: dict[str, tuple[int, int]]
    odd: dict[str, int]
    cpu_s: float
    """Processor's time of a flight, s, mean."""
    rare: RareReport | None
    """Of a rare campaign; it has neither points nor pairings nor sensitivity, which would be those of how it was drawn."""
    counted: tuple[Counted, ...]
    """Of a plain campaign whose file asks for a failure of its own, at each point."""

    def result(self) -> dict[str, Any]:
        """The report as plain data, for JSON."""
        described = self.campaign.about()["description"]
        data = {"description": described, "runs": self.campaign.runs, **self._asdict()}
        del data["campaign"]
        data["points"] = [{**p._asdict(), "figures": [q._asdict() for q in p.figures]} for p in self.points]
        data["pairings"] = [
            {**p._asdict(), "rate": p.rate._asdict(), "figures": [d._asdict() for d in p.figures]}
            for p in self.pairings
        ]
        data["sensitivity"] = {k: [i._asdict() for i in v] for k, v in self.sensitivity._asdict().items()}
        data["worst"] = [w._asdict() for w in self.worst]
        data["rare"] = None if self.rare is None else self.rare.result()
        data["counted"] = [c._asdict() for c in self.counted]
        return data


def report(store: Store) -> tuple[Report, Table]:
    """What the rows of a store say, and the rows as columns."""
    about = store.about
    campaign, table = campaign_of(about), tabulate(store)
    names = names_of(campaign.description)
    rare = rare_report(campaign, store) if campaign.rare else None
    watch = Watch(len(names), None)
    for run, success in zip(table.run, table.success, strict=True):
        watch.add(int(run), bool(success))
    always = watch.intervals()
    there = [k for k in range(len(names)) if table.at(k).any() and rare is None]
    points = tuple(_point(table, k, names[k], always[k], campaign.bounds) for k in there)
    paired = (compare(table, there[0], k) for k in there[1:MOST_COMPARED])
    return Report(
        campaign,
        about["versions"],
        about.get("until"),
        len(table.run),
        len(campaign.schedule),
        points,
        tuple(p for p in paired if p is not None),
        sensitivity(table) if rare is None else Sensitivity((), ()),
        _worst(table, store, campaign),
        dict(list(table.reasons.items())[:WORST]),
        table.odd,
        float(np.mean(table.cpu_s)) if len(table.cpu_s) else 0.0,
        rare,
        counted(campaign, store, table) if rare is None else (),
    ), table


def names_of(description: Description) -> list[str]:
    """What tells the points of a campaign apart: the name of the variant, and the values that are swept in it."""
    grid = description.grid
    if not description.variants:
        return point_names(grid)
    swept = point_names([{path: point[path] for path in description.swept} for point in grid])
    return [
        f"{name}, {values}" if description.swept else name
        for name, values in zip(description.named, swept, strict=True)
    ]


def point_names(points: list[dict[str, Any]]) -> list[str]:
    """What tells the points apart, in words: the values that differ between them."""
    differ = [path for path in points[0] if any(p[path] != points[0][path] for p in points)]
    return [", ".join(f"{path} = {short(p[path])}" for path in differ) or "all flights" for p in points]


def short(value: Any) -> str:
    """A value of a parameter with as many digits as a reader needs."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _point(table: Table, point: int, name: str, always: Interval, bounds: dict[str, float]) -> PointReport:
    here = table.at(point)
    n, good = int(here.sum()), int(table.success[here].sum())
    wilson = binomtest(good, n).proportion_ci(0.95, method="wilson")
    found = []
    for key, column in table.figures.items():
        values, runs = column[here], table.run[here]
        known = np.isfinite(values)
        if known.any():
            worst = int(np.nanargmax(values))
            bound = bounds.get(key)
            limit = None if bound is None else bound * FIGURES[key].scale
            quantiles = tuple(float(x) for x in np.quantile(values[known], QUANTILES))
            found.append(
                Quantiles(
                    key, FIGURES[key].name, int(known.sum()), quantiles, float(values[worst]), int(runs[worst]), limit
                )
            )
    return PointReport(point, name, n, good, Interval(float(wilson.low), float(wilson.high)), always, tuple(found))


def _worst(table: Table, store: Store, campaign: Campaign) -> tuple[Worst, ...]:
    if not len(table.run):
        return ()
    failure = campaign.description.failure
    asked = None if failure is None else failure.figure
    bounds = campaign.bounds if failure is None or asked is None else {asked: failure.above or 0.0}
    shares = np.zeros(len(table.run))
    for key, column in table.figures.items():
        if bounds.get(key, 0.0) > 0.0:
            shares = np.fmax(shares, column / (bounds[key] * FIGURES[key].scale))
    flew = np.array([outcome not in (REFUSED, BROKE, KILLED) for outcome in table.outcome])
    # What failed in flight, then what did not fly, then what came nearest to a bound; where a figure is asked for, by that alone.
    order = np.lexsort((table.run, -shares, ~flew, table.success))[:WORST]
    if asked is not None and asked in table.figures:
        order = np.lexsort((table.run, -np.nan_to_num(table.figures[asked], nan=-np.inf)))[:WORST]
    rows = {row.run: row for row in store.rows([int(table.run[i]) for i in order])}
    found = [rows[int(table.run[i])] for i in order]
    return tuple(
        Worst(row.run, row.seed, row.success, float(shares[i]), row.judged()["reason"], row.values)
        for i, row in zip(order, found, strict=True)
    )


def mapped(report: Report, table: Table) -> tuple[str, str] | None:
    """The two parameters over which a map of success says most: those swept, then those with most influence; None of fewer than two."""
    swept = [path for path in report.campaign.description.swept if path in table.values]
    ranked = [i.names[0] for i in report.sensitivity.single if as_numbers(table.values[i.names[0]]) is not None]
    names = list(
        dict.fromkeys(
            [*swept, *ranked, *(n for n, v in table.values.items() if as_numbers(v) is not None and len(set(v)) > 1)]
        )
    )
    return (names[0], names[1]) if len(names) > 1 else None
