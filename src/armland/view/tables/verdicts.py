"""What all tables share: how they look, and how a verdict reads."""

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from armland.experiments.paper import UNBOUNDED


def terminal() -> Console:
    """Standard output."""
    return Console(highlight=False)


def titled(title: str, *columns: str, left: Sequence[int] = (0,)) -> Table:
    """A table without rows; columns hold numbers, to the right, where they are not in `left`."""
    # As text: a unit in brackets is no markup.
    table = Table(title=Text(title), title_justify="left")
    for k, column in enumerate(columns):
        table.add_column(Text(column), justify="left" if k in left else "right")
    return table


def print_lines(console: Console, lines: Sequence[str], notes: Sequence[str], odd: Sequence[str]) -> None:
    """Print what a file of an arm or a UAV comes to, what was made of it, and what is suspicious in it."""
    for line in lines:
        console.print(Text(line))
    for title, found in (("What was made of the file", notes), ("Suspicious", odd)):
        if found:
            console.print(Text(f"{title}:", style="bold"))
        for line in found:
            console.print(Text(f"- {line}"))


def mark(holds: bool | None) -> str:
    """Whether a bound is kept, in colour; None: it was not judged."""
    if holds is None:
        return "[dim]shown[/]"
    return "[green]holds[/]" if holds else "[red]fails[/]"


def cell(value: float | Sequence[float] | None, scale: float, form: str) -> str:
    """A number times `scale`, or several with slashes between them, or a dash where there is none."""
    if value is None:
        return "-"
    values = value if isinstance(value, Sequence) else [value]
    return "/".join(form.format(scale * v) for v in values)


def bound_in_words(low: float, high: float) -> str:
    """The bound of a claim, from `low` to `high` in its own unit."""
    if high >= UNBOUNDED:
        return f"at least {low:.4g}"
    return f"at most {high:.4g}" if low == 0.0 else f"{low:.4g} to {high:.4g}"


def verdict_table(title: str, verdicts: Sequence[Mapping[str, Any]]) -> Table:
    """Claims, what was found, the bound, and whether it holds."""
    table = titled(title, "claim", "found", "bound", "", left=(0, 3))
    for v in verdicts:
        table.add_row(Text(v["claim"]), f"{v['value']:.4g}", bound_in_words(*v["bound"]), mark(v["holds"]))
    return table
