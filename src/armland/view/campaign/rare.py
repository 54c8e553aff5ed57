"""What is said of the rate of a rare failure, on the terminal and on the page."""

import math

from rich.console import Console
from rich.text import Text

from armland.experiments.campaign.answers.report import Report
from armland.experiments.campaign.rare.answer import QUANTILES as SHARES
from armland.experiments.campaign.rare.answer import RareReport
from armland.view.tables.verdicts import titled


def share(x: float) -> str:
    """A rate, a ratio, in the form that rare ones are read in."""
    return "0" if x == 0.0 else f"{x:.3g}" if x >= 1e-3 else f"{x:.2e}"


def rare_lines(rare: RareReport) -> list[str]:
    """The rate, how sure it is, and what it took, in sentences."""
    learnt = sum(s.flights for s in rare.stages)
    stages = f"{len(rare.stages)} {'stage' if len(rare.stages) == 1 else 'stages'} of learning"
    if rare.rate is None:
        return [
            f"Rate of failure ({rare.failure}): not known yet, after {learnt} flights in {stages}.",
            rare.doubt,
        ]
    r = rare.rate
    low, high = (share(x) for x in r.interval)
    lines = [f"Rate of failure ({rare.failure}): {share(r.value)}, with 95 % from {low} to {high}."]
    took = f"It took {rare.flights} flights: {learnt} in {stages}, and {r.flights} for the rate, of which {r.failed} failed."
    if r.failed:
        lines.append(f"Coefficient of variation {100.0 * r.deviation:.3g} %. {took}")
        lines.append(f"Plain flights for the same: {r.plain:.2g}, {rare.gain:.2g} times as many.")
    else:
        lines.append(took)
    return [*lines, rare.doubt] if rare.doubt else lines


def counted_lines(report: Report) -> list[str]:
    """How many flights of each point of a plain campaign failed as its file asks for."""
    from armland.experiments.campaign.rare.failure import in_words

    words, names = in_words(report.campaign.description.failure), {p.point: p.name for p in report.points}
    return [
        f"{words[0].upper()}{words[1:]}, {names[c.point]}: {c.failed} of {c.flights}, {share(c.failed / c.flights)}, "
        f"with 95 % from {share(c.wilson.low)} to {share(c.wilson.high)}."
        for c in report.counted
    ]


def print_rare(console: Console, rare: RareReport) -> None:
    """Print the rate, the stages that led to it, and where failures are."""
    for line in rare_lines(rare):
        console.print(Text(line))
    table = titled("Stages of learning", "", "flights", "failed", "nearest tenth")
    for k, stage in enumerate(rare.stages, start=1):
        table.add_row(str(k), str(stage.flights), str(stage.failed), level(stage.level))
    console.print(table)
    if rare.places:
        table = titled("Where failures are", "parameter", *where_heads())
        for place in rare.places:
            table.add_row(Text(place.name), *(f"{x:.4g}" for x in (*place.all, *place.failing)))
        console.print(table)


def where_heads() -> list[str]:
    """Heads of the columns that say where failures are: of all flights, then of those that fail."""
    return [f"{who} {100.0 * q:g} %" for who in ("all", "failing") for q in SHARES]


def level(x: float | None) -> str:
    """How near the best tenth of a stage came to failing; 0 is failed."""
    return "-" if x is None or math.isinf(x) else f"{x:.3g}"
