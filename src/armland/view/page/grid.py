"""Tables of a page: cells with words and, where something holds or fails, a mark."""

from collections.abc import Sequence
from typing import NamedTuple

from rich.table import Table
from rich.text import Text


class Cell(NamedTuple):
    """Words in a table."""

    text: str
    mark: str = ""
    """`good`, `bad`, or nothing; the words say the same."""
    share: float | None = None
    """How far a bar below the words reaches, 0 to 1, where there is one."""


class Grid(NamedTuple):
    """A table."""

    caption: str
    columns: Sequence[str]
    rows: Sequence[Sequence[Cell | str]]
    left: Sequence[int] = (0,)
    """Columns of words; the others hold numbers."""


def holds(verdict: bool | None) -> Cell:
    """Whether a bound is kept; None: it was not judged."""
    if verdict is None:
        return Cell("not judged")
    return Cell("holds", "good") if verdict else Cell("fails", "bad")


def grid_of(table: Table) -> Grid:
    """A table of the terminal as one of a page: the same words, verdicts with their mark."""
    columns = [[_plain(c) for c in column.cells] for column in table.columns]
    for k, words in enumerate(columns[0]):
        # A row without a name is of what the row above is of.
        columns[0][k] = words or columns[0][max(k - 1, 0)]
    rows = [tuple(MARKED.get(words, words) for words in row) for row in zip(*columns, strict=True)]
    left = tuple(k for k, column in enumerate(table.columns) if column.justify == "left")
    # A column without a name is one of verdicts, or of what the rows are of.
    names = [_plain(c.header) or ("what" if k == 0 else "verdict") for k, c in enumerate(table.columns)]
    return Grid(_plain(table.title), names, rows, left)


MARKED = {"holds": holds(True), "fails": holds(False)}


def _plain(words: object) -> str:
    plain = words.plain if isinstance(words, Text) else Text.from_markup(str(words)).plain
    # Terminals have no letters for code, and mark it so.
    return plain.replace("`", "")
