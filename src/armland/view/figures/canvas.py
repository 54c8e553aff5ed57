"""Sheets for print: sizes, style and lines that all figures share, and files whose bytes repeat."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import matplotlib.style
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

COLUMN_IN, PAGE_IN = 3.5, 7.16  # Widths of one and of two columns of a journal, inches

DPI = 200

STYLE = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 8.0,
    "legend.fontsize": 8.0,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "grid.color": "0.85",
    "grid.linewidth": 0.4,
    "axes.axisbelow": True,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.frameon": False,
    "legend.handlelength": 1.8,
    "legend.columnspacing": 1.4,
    # Journals refuse Type 3 fonts.
    "pdf.fonttype": 42,
}

# Vermilion, blue and bluish green of Okabe and Ito: colour-blind readers tell them apart, too.
_LINES: dict[str, dict] = {
    "E1": {"color": "#D55E00", "linewidth": 1.1, "zorder": 3.0},
    "E2": {"color": "#0072B2", "linewidth": 1.3, "zorder": 3.1},
    # E3 often lies on E2: thin, dashed and on top, it leaves E2 to be seen.
    "E3": {"color": "#2DBE93", "linewidth": 0.9, "linestyle": (0, (3.0, 1.5)), "zorder": 3.2},
}
_OTHERS = ("#CC79A7", "#E69F00", "#56B4E9", "#666666")
DESIRED = {"color": "black", "linestyle": "-", "linewidth": 0.9, "zorder": 2.9}


@contextmanager
def paper_style() -> Iterator[None]:
    """Matplotlib's defaults and `STYLE` while figures are built and saved, whatever the user's own settings are."""
    with matplotlib.style.context(["default", STYLE]):
        yield


def line_of(name: str, index: int) -> dict:
    """Line of the run `name`, the same in all figures; `index` counts the runs and colours unknown ones."""
    return _LINES.get(name, {"color": _OTHERS[index % len(_OTHERS)], "linewidth": 1.0, "zorder": 3.0})


def sheet(width_in: float, height_in: float) -> Figure:
    """An empty figure of this size, inches, that belongs to no window and to no global state."""
    figure = Figure(figsize=(width_in, height_in), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def shade(axes: Axes, spans: Sequence[tuple[float, float]]) -> None:
    """Grey background over the `spans`, each from begin to end on the x axis."""
    for begin, end in spans:
        axes.axvspan(begin, end, color="0.945", linewidth=0.0, zorder=0.0)


def legend_above(figure: Figure, axes: Axes) -> None:
    """The labels of `axes` in one row above all panels, where they cover no line."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(handles))


def drawn(out: Path, figures: Mapping[str, Callable[[], Figure]]) -> list[Path]:
    """Draw figures and write each, by its name, as PDF and PNG into the folder `out`; returns the files' paths.

    The same figure gives the same bytes. A figure that cannot be drawn leaves no folder behind.
    """
    paths = []
    with paper_style():
        for name, figure_of in figures.items():
            pdf, png, figure = out / f"{name}.pdf", out / f"{name}.png", figure_of()
            out.mkdir(parents=True, exist_ok=True)
            figure.savefig(pdf, metadata={"CreationDate": None})
            figure.savefig(png, dpi=DPI)
            paths += [pdf, png]
    return paths
