"""A page: what stands in the template, and the file."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from jinja2 import Environment, PackageLoader, StrictUndefined

from armland import __version__
from armland.view.page.again import Again
from armland.view.page.grid import Grid
from armland.view.page.merits import Tile
from armland.view.page.pictures import Drawing

REPORT = "report.html"
"""Name of the page in a folder of results."""


class Verdict(NamedTuple):
    """What stands at the top."""

    word: str  # `success`, `failure`, or a count
    good: bool
    reason: str


class Still(NamedTuple):
    """A picture of the film strip."""

    source: str
    name: str
    when: str


class Piece(NamedTuple):
    """A phase in the bar of phases."""

    name: str
    share: float  # Percent of the run
    words: str


class Section(NamedTuple):
    """A part of the page: in this order text, pictures, bar, figures, tables, what can be unfolded."""

    title: str
    text: Sequence[str] = ()
    stills: Sequence[Still] = ()
    bar: Sequence[Piece] = ()
    drawings: Sequence[Drawing] = ()
    grids: Sequence[Grid] = ()
    unfolded: Sequence[tuple[str, str]] = ()
    """Title and text of what is folded away on a screen."""


class Sheet(NamedTuple):
    """All that a page says."""

    title: str
    subtitle: str
    verdict: Verdict
    tiles: Sequence[Tile]
    sections: Sequence[Section]
    again: Again | None


def html(sheet: Sheet) -> str:
    """The page as text; whatever stands in a log is escaped."""
    environment = Environment(
        loader=PackageLoader("armland.view.page", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["anchor"] = lambda title: "-".join(str(title).lower().split())
    return environment.get_template("page.html").render(version=__version__, **sheet._asdict())


def write_page(folder: Path, sheet: Sheet) -> Path:
    """Write the page into the folder; returns its path."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / REPORT
    path.write_text(html(sheet), encoding="utf-8")
    return path


def settings_grid(caption: str, values: Mapping[str, Any]) -> Grid:
    """Names and values as a table of words."""
    return Grid(caption, ("what", "value"), [(name, str(value)) for name, value in values.items()], left=(0, 1))
