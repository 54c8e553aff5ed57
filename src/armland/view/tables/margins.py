"""What the margins look like on the terminal."""

from collections.abc import Sequence
from pathlib import Path

from rich.table import Table
from rich.text import Text

from armland.experiments.margins.corners import end_of, ends
from armland.experiments.margins.screening import Listed
from armland.experiments.margins.study import Margin, Margins
from armland.scenario.deviation import unit_of
from armland.view.tables.verdicts import terminal, titled

NARROWEST = 10
"""Margins whose first failure is told."""


def print_margins(found: Margins, out: Path) -> None:
    """Print verdict, margins with the worst first, the worst single deviations and pairs, and where the rest is."""
    console = terminal()
    if found.holds:
        console.print("[bold green]holds[/]: each deviation alone may have its published range")
    for path in inside(found):
        console.print(Text.from_markup("[bold red]fails[/]: ").append(f"{path} alone, inside its published range"))
    first, *effects = margin_tables(found)
    console.print(first)
    for line in (*first_failures(found), terms_in_words(found)):
        console.print(line, markup=False)
    for line in screened(found):
        console.print(line, markup=False)
    for table in effects:
        console.print(table)
    console.print(f"The data is in {out}/", markup=False)


def inside(found: Margins) -> list[str]:
    """Deviations that fail alone inside their published range."""
    return [m.row.path for m in found.margins if not m.holds]


def first_failures(found: Margins) -> list[str]:
    """By what the narrowest fail first, a sentence each."""
    lines = []
    for m in found.margins[:NARROWEST]:
        if m.bracket.failure is not None:
            why, end = m.bracket.failure, end_of(m.row, m.bracket.failure.seed)
            where = f"seed {why.seed}{(end and f', {end} end') or ''}"
            lines.append(f"{m.row.path} fails first by: {why.reason} ({where}; UAV {why.state})")
    return lines


def terms_in_words(found: Margins) -> str:
    """On what terms the margins were found, and the signs of their table."""
    terms = found.terms
    return (
        f"{terms.mission}, around {terms.around}, seeds {found.seeds[0]} to {found.seeds[-1]}; a factor holds while "
        f"{100.0 * terms.share:g} % of them succeed. ×: factor on the published range; >: nothing failed up to there."
    )


def screened(found: Margins) -> list[str]:
    """What came of all deviations at once; nothing where that was not flown."""
    s = found.screening
    if s is None:
        return []
    return [
        f"All at once, {s.factor:g} × published: {s.landed} of {s.flights} flights succeed. Effects on the largest figure "
        f"over its bound (2: failed); clear: beyond chance."
    ]


def margin_tables(found: Margins) -> list[Table]:
    """The margins, and the worst single deviations and pairs where all were flown at once."""
    s = found.screening
    effects = [] if s is None else [_effects("Worst single deviations", s.singles), _effects("Worst pairs", s.pairs)]
    return [_margins(found), *effects]


def range_in_words(low: float, high: float, unit: str = "1") -> str:
    """A range in the fewest signs: ±x, one number, or both ends."""
    words = f"±{high:.3g}" if low == -high else f"{high:.3g}" if low in (0.0, high) else f"{low:.3g} to {high:.3g}"
    return words if unit == "1" else f"{words} {unit}"


def reach_in_words(m: Margin) -> str:
    """The factor up to which it holds, with a > where nothing ended it."""
    return f"{'> ' if m.fails is None else ''}{m.lands:.2g}"


def _margins(found: Margins) -> Table:
    title = "What each deviation alone may be"
    table = titled(title, "deviation", "published", "×", "holds at", "fails at", "UAV then", left=(0, 5))
    for m in found.margins:
        table.add_row(*(Text(cell, no_wrap=True) for cell in _cells(m)))
    return table


def _cells(m: Margin) -> tuple[str, ...]:
    t, unit, failure = m.row.told, unit_of(m.row.path), m.bracket.failure
    return (
        m.row.path,
        range_in_words(t.low, t.high, unit),
        reach_in_words(m),
        range_in_words(*ends(m.row, m.lands), unit),
        "-" if m.fails is None else range_in_words(*ends(m.row, m.fails), unit),
        "-" if failure is None else failure.state,
    )


def _effects(title: str, effects: Sequence[Listed]) -> Table:
    table = titled(title, "deviations", "worst at", "effect", "error", "", left=(0, 1, 4))
    for e in effects:
        rows, levels = " × ".join(e.rows), ", ".join(e.worst_at)
        table.add_row(Text(rows), Text(levels), f"{e.size:+.3f}", f"{e.error:.3f}", "clear" if e.clear else "")
    return table
