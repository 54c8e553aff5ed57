"""The table of deviations in `docs/margins.md`: what may differ, by how much, and who says so."""

import re

from armland.scenario.deviation import Row, rows, unit_of
from armland.view.tables.margins import range_in_words

BEGIN, END = "<!-- deviations: made by `make pages` -->", "<!-- deviations: end -->"
"""Between these lines the page is made; the rest is written by hand."""


def with_deviations(page: str) -> str:
    """The page with its table made anew."""
    head, begin, rest = page.partition(BEGIN)
    _, end, tail = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"the page lacks the line {BEGIN if not begin else END}")
    return f"{head}{BEGIN}\n\n{deviations_markdown()}\n{END}{tail}"


def deviations_markdown() -> str:
    """Every deviation, by device, as a table."""
    head = ["deviation", "what differs", "unit", "published range", "bound", "source"]
    parts = [f"| {' | '.join(head)} |", "|---" * len(head) + "|"]
    for row in rows():
        t, (what, source) = row.told, told_by(row)
        cells = (
            f"`deviation.{row.path}`",
            what,
            unit_of(row.path),
            f"0 to {t.high:g}" if t.low == 0.0 else range_in_words(t.low, t.high),
            f"{t.least:g} to {t.most:g}",
            source,
        )
        parts.append(f"| {' | '.join(cells)} |")
    return "\n".join([*parts, ""])


def told_by(row: Row) -> tuple[str, str]:
    """What a row's meaning says of it, and of its source: a published figure in round brackets at the end, or an assumption."""
    what, assumed, why = row.meaning.partition("assumption")
    if assumed:
        return what.rstrip(" ;,"), assumed + why
    found = re.fullmatch(r"(.*?)[;,]? \((.*)\)", row.meaning)
    if found is None:
        raise ValueError(f"{row.path}: {row.meaning!r} names neither a source in round brackets nor an assumption")
    return found[1], found[2]
