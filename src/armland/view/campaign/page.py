"""A campaign's report as one HTML page that needs nothing beside it: no network, no script, no other file."""

from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType

from jinja2 import Environment, StrictUndefined

from armland.experiments.campaign.answers.report import QUANTILES, Report, short
from armland.experiments.campaign.answers.table import Table
from armland.experiments.margins.flights import shortened
from armland.view.campaign.pictures import as_source, pictures
from armland.view.campaign.rare import counted_lines, level, rare_lines, share, where_heads
from armland.view.campaign.terminal import fails_with, headline, interval_of, percent
from armland.view.campaign.worst import Strip

MOST_POINTS = 500


def page(report: Report, table: Table, store: Path, strips: Mapping[int, Strip] = MappingProxyType({})) -> str:
    """The page as text.

    Args:
        report: what it says.
        table: the rows.
        store: named in the commands that fly the worst flights again.
        strips: pictures of the worst flights, by row.
    """
    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters["percent"], environment.filters["value"] = percent, short
    environment.filters["short"], environment.filters["brief"] = (lambda x: f"{x:.3g}"), shortened
    environment.filters["share"], environment.filters["level"] = share, level
    template = environment.from_string((files("armland") / "view" / "campaign" / "page.html").read_text("utf-8"))
    return template.render(
        report=report,
        headline=headline(report),
        store=store,
        quantiles=[f"{100.0 * q:g} %" for q in QUANTILES],
        points=report.points[:MOST_POINTS],
        names={p.point: p.name for p in report.points},
        interval=lambda point: interval_of(report, point),
        fails_with=fails_with,
        rare_lines=[] if report.rare is None else rare_lines(report.rare),
        counted_lines=counted_lines(report),
        where_heads=where_heads(),
        strips=strips,
        pictures={caption: as_source(svg) for caption, svg in pictures(report, table).items()},
        description=report.campaign.about()["description"],
    )
