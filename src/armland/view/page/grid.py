"""Tables of a page: cells with words and, where something holds or fails, a mark."""

from collections.abc import Sequence
from typing import NamedTuple


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
