"""Figures and pictures inside a page: SVG that follows the page's colours, JPEG as data."""

import base64
import io
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import matplotlib.style
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from armland.view.figures.canvas import paper_style

STYLE: dict[str, Any] = {
    "font.family": "DejaVu Sans",
    "mathtext.fontset": "dejavusans",
    "font.size": 9.0,
    "legend.fontsize": 9.0,
    "axes.linewidth": 0.8,
    "grid.linewidth": 0.5,
    "svg.fonttype": "none",
    "svg.hashsalt": "armland",
    # Points of a line that no eye tells apart from a straight one.
    "path.simplify_threshold": 0.2,
}
"""For screens: larger letters, which stay letters."""

COLORS = {
    "#000000": "currentColor",
    "#d9d9d9": "var(--grid)",
    "#f1f1f1": "var(--shade)",
    "#808080": "var(--muted)",
    "#595959": "var(--muted)",
    "#0072b2": "var(--blue)",
    "#d55e00": "var(--vermilion)",
    "#2dbe93": "var(--green)",
    "#cc79a7": "var(--purple)",
    "#e69f00": "var(--orange)",
    "#56b4e9": "var(--sky)",
    "#ffffff": "var(--paper)",
}
"""Colour in a figure -> the page's, which differs between light and dark."""


NARROW_IN, NARROWS = 5.4, 1.15
"""A figure of one column of a journal becomes so wide, since its letters are larger here, and by so much higher."""

PX_PER_IN = 145
"""Pixels that an inch of a figure takes at most."""


class Drawing(NamedTuple):
    """A figure inside a page."""

    title: str
    words: str
    """What it shows, for those who do not see it and as its caption."""
    svg: str


@contextmanager
def screen_style() -> Iterator[None]:
    """The style of figures on screens, whatever the user's own settings are."""
    with paper_style(), matplotlib.style.context(STYLE):
        yield


def drawing(name: str, title: str, words: str, figure_of: Callable[[], Figure]) -> Drawing:
    """Draw a figure for a page.

    Args:
        name: by which no other figure of the page goes.
        title: of it.
        words: what it shows.
        figure_of: draws it.
    """
    with screen_style():
        figure, out = figure_of(), io.StringIO()
        width, height = figure.get_size_inches()
        if width < NARROW_IN:
            figure.set_size_inches(NARROW_IN, NARROWS * height)
        _fit_legends(figure)
        figure.savefig(out, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    return Drawing(title, words, themed(out.getvalue(), name))


def _fit_legends(figure: Figure) -> None:
    # In as many lines as they need.
    figure.draw_without_rendering()
    for legend in list(figure.legends):
        handles, labels = (
            [h for h in legend.legend_handles if h is not None],
            [text.get_text() for text in legend.get_texts()],
        )
        for columns in range(len(labels) - 1, 0, -1):
            if legend.get_window_extent().width <= figure.bbox.width:
                break
            legend.remove()
            legend = figure.legend(handles, labels, loc="outside upper center", ncols=columns)
            figure.draw_without_rendering()


def themed(svg: str, name: str) -> str:
    """An SVG file as an element of a page: in the page's colours, as wide as there is room, its names its own."""
    text = svg[svg.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    head, rest = text.split(">", 1)
    box = re.search(r'viewBox="0 0 ([\d.]+) [\d.]+"', head)
    assert box is not None
    wide = f"max-width:{float(box[1]) / 72.0 * PX_PER_IN:.0f}px"
    rest = re.sub(r'\bid="', f'id="{name}-', rest)
    rest = re.sub(r'(href="#|url\(#)', rf"\g<1>{name}-", rest)
    rest = re.sub(r"#[0-9a-fA-F]{6}\b", lambda m: COLORS.get(m[0].lower(), m[0]), rest)
    # A tenth of a point is a fraction of a pixel.
    rest = re.sub(r"(\d+\.\d)\d{2,}", r"\1", rest)
    return f'<svg xmlns:xlink="http://www.w3.org/1999/xlink" {box[0]} style="{wide}" aria-hidden="true" focusable="false">{rest}'


def photograph(picture: NDArray[np.uint8], quality: int = 84) -> str:
    """A picture (height, width, 3) as the address of an image that stands in the page itself."""
    out = io.BytesIO()
    Image.fromarray(picture).save(out, "JPEG", quality=quality, optimize=True, progressive=True)
    return f"data:image/jpeg;base64,{base64.b64encode(out.getvalue()).decode()}"
