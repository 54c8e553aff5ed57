"""What a campaign's report looks like on the terminal."""

from pathlib import Path

from rich.console import Console
from rich.text import Text

from armland.experiments.campaign.answers.report import QUANTILES, PointReport, Report, short
from armland.experiments.campaign.answers.sensitivity import Influence
from armland.experiments.margins.flights import shortened
from armland.view.campaign.rare import counted_lines, print_rare
from armland.view.tables.verdicts import mark, terminal, titled

MOST_POINTS = 40


def print_report(report: Report, store: Path, out: Path) -> None:
    """Print rates with their intervals, figures, comparisons, what failure depends on, and the worst flights with their commands."""
    console = terminal()
    console.print(Text(headline(report), style="bold"))
    if report.rare is not None:
        print_rare(console, report.rare)
    else:
        _rates(console, report)
    for line in counted_lines(report):
        console.print(Text(line))
    if len(report.points) == 1:
        _figures(console, report.points[0])
    _pairings(console, report)
    _influences(console, report)
    for reason, (count, first) in report.reasons.items():
        console.print(Text(f"{count} failed (first row {first}): {shortened(' '.join(reason.split()))}"))
    _worst(console, report, store)
    console.print(Text(f"The rows are in {store}, the report is in {out}/"))


def headline(report: Report) -> str:
    """One line that says what was flown and how far it is."""
    title = report.campaign.description.title or f"Campaign of {report.campaign.job.mission}s"
    odd = ", ".join(f"{count} {name}" for name, count in report.odd.items())
    until = "" if report.until is None else f", until intervals are ±{100.0 * report.until:g} %"
    return f"{title}: {report.rows} of {report.planned} flights{until}{f'; no flights: {odd}' if odd else ''}"


def percent(x: float) -> str:
    """A ratio as a percentage with as many digits as matter near 0 and 100 %."""
    return f"{100.0 * x:.2f}" if 0.9 < x < 1.0 or 0.0 < x < 0.1 else f"{100.0 * x:.1f}"


def interval_of(report: Report, point: PointReport) -> tuple[float, float]:
    """The interval of a rate: that which holds at all looks where somebody looked, Wilson's otherwise."""
    return point.wilson if report.until is None else point.always


def _rates(console: Console, report: Report) -> None:
    kind = "95 % interval" if report.until is None else "95 % interval at all looks"
    table = titled("Success", "point", "flights", "succeed", "rate [%]", f"{kind} [%]", left=(0,))
    for point in report.points[:MOST_POINTS]:
        low, high = interval_of(report, point)
        table.add_row(
            Text(point.name),
            str(point.flights),
            str(point.successes),
            percent(point.successes / point.flights),
            f"{percent(low)} to {percent(high)}",
        )
    console.print(table)
    if len(report.points) > MOST_POINTS:
        console.print(Text(f"and {len(report.points) - MOST_POINTS} more points, which the page has"))


def _figures(console: Console, point: PointReport) -> None:
    # The page has the low quantile, for which a terminal has no room.
    shown = [f"{100.0 * q:g} %" for q in QUANTILES[1:]]
    table = titled("Figures", "", *shown, "worst", "row", "bound", "", left=(0, 7))
    for f in point.figures:
        bound = ("-", "") if f.bound is None else (f"≤ {f.bound:.4g}", mark(f.worst <= f.bound * (1.0 + 1e-9)))
        numbers = (f"{x:.3g}" for x in (*f.quantiles[1:], f.worst))
        table.add_row(Text(f.name, no_wrap=True), *numbers, str(f.worst_run), *bound)
    if point.figures:
        console.print(table)


def _pairings(console: Console, report: Report) -> None:
    if not report.pairings:
        return
    names = {p.point: p.name for p in report.points}
    title = f"Against {names[report.pairings[0].first]}, seed by seed"
    table = titled(title, "point", "seeds", "rate [%]", "95 % interval [%]", "only it", "only the first", "by chance")
    for p in report.pairings:
        r = p.rate
        table.add_row(
            Text(names[p.second]),
            str(r.pairs),
            f"{100.0 * r.value:+.1f}",
            f"{100.0 * r.low:+.1f} to {100.0 * r.high:+.1f}",
            str(p.only_second),
            str(p.only_first),
            f"{p.chance:.2g}",
        )
    console.print(table)


def _influences(console: Console, report: Report) -> None:
    found = report.sensitivity
    if not found.single:
        return
    table = titled("What success depends on", "parameter", "share of variance", "by chance", "fails with", left=(0, 3))
    for i in (*found.single, *(pair for pair in found.pairs if pair.share > 0.0)):
        table.add_row(Text(" and ".join(i.names)), f"{i.share:.3f}", f"{i.chance:.2g}", fails_with(i))
    console.print(table)


def fails_with(i: Influence) -> str:
    """Whether failure comes with more or less of a parameter; a dash where chance alone may have done it."""
    if i.chance > 0.05 or i.share == 0.0:
        return "-"
    return "the combination" if len(i.names) > 1 else "more" if i.trend > 0.0 else "less" if i.trend < 0.0 else "some"


def _worst(console: Console, report: Report, store: Path) -> None:
    if not report.worst:
        return
    table = titled("The worst flights", "row", "seed", "of its bound", "why, and values", left=(3,))
    for w in report.worst:
        values = ", ".join(f"{name} = {short(value)}" for name, value in w.values.items())
        why = shortened(w.why) + (f" ({values})" if values else "")
        table.add_row(str(w.run), str(w.seed), f"{w.share:.2f}" if w.success else "failed", Text(why))
    console.print(table)
    console.print(Text(f"armland campaign replay {store} {report.worst[0].run} flies the first of them again."))
