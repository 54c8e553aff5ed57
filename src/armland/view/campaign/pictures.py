"""Pictures of a campaign's report: the rate at each point, figures with their bounds, a map over two parameters, what matters."""

import base64
import io
from collections.abc import Callable
from itertools import pairwise

import numpy as np
from matplotlib.figure import Figure

from armland.experiments.campaign.answers.report import Report, mapped
from armland.experiments.campaign.answers.sensitivity import as_numbers
from armland.experiments.campaign.answers.table import Table
from armland.experiments.campaign.summary import FIGURES
from armland.view.campaign.terminal import interval_of
from armland.view.figures.canvas import paper_style, sheet

WIDTH_IN = 7.6
BLUE, ORANGE, GREY = "#0072B2", "#D55E00", "0.45"
MOST_CLASSES = 8
MOST_CURVES = 8
COLOURS = (BLUE, ORANGE, "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#666666", "#000000")


def pictures(report: Report, table: Table) -> dict[str, str]:
    """Pictures by their captions, each as the text of an SVG; those that would show nothing are left out."""
    made: dict[str, Callable[[], Figure | None]] = {
        "Rate of success at each point, with its 95 % interval": lambda: rates(report),
        "Share of flights below a value, with the bound": lambda: spreads(report, table),
        "Rate of success over two parameters": lambda: success_map(report, table),
        "Rate of success over each parameter": lambda: slices(report, table),
    }
    out = {}
    with paper_style():
        for caption, draw in made.items():
            figure = draw()
            if figure is not None:
                out[caption] = _svg(figure)
    return out


def as_source(svg: str) -> str:
    """An SVG as the source of an image within a page."""
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode()


def _svg(figure: Figure) -> str:
    stream = io.StringIO()
    figure.savefig(stream, format="svg", metadata={"Date": None})
    return stream.getvalue()


def rates(report: Report) -> Figure | None:
    """Rate and interval of each point, one below the other; None of a single point."""
    points = report.points
    if len(points) < 2:
        return None
    figure = sheet(WIDTH_IN, 0.55 + 0.24 * len(points))
    axes, at = figure.subplots(), np.arange(len(points))
    rate = np.array([100.0 * p.successes / p.flights for p in points])
    ends = 100.0 * np.array([interval_of(report, p) for p in points])
    axes.errorbar(rate, at, xerr=np.abs(ends.T - rate), fmt="o", color=BLUE, markersize=4.0, capsize=2.5, linewidth=1.2)
    axes.set_yticks(at, [p.name for p in points])
    axes.set_ylim(len(points) - 0.5, -0.5)
    axes.set_xlim(min(90.0, np.floor(ends.min() / 10.0) * 10.0), 100.5)
    axes.set_xlabel("flights that succeed (%)")
    return figure


def spreads(report: Report, table: Table) -> Figure | None:
    """A panel for each figure: its distribution at each point, failed flights included, and its bound."""
    shown = list(table.figures)
    if not shown or not report.points:
        return None
    lines = -(-len(shown) // 4)
    figure = sheet(WIDTH_IN, 1.55 * lines + 0.25)
    panels = figure.subplots(lines, 4, squeeze=False).ravel()
    for axes, key in zip(panels, shown, strict=False):
        bound = report.campaign.bounds.get(key)
        for point, colour in zip(report.points[:MOST_CURVES], COLOURS, strict=False):
            values = table.figures[key][table.at(point.point)]
            share = np.linspace(0.0, 1.0, 201)
            if np.isfinite(values).any():
                axes.plot(np.nanquantile(values, share), 100.0 * share, color=colour, linewidth=1.1)
        if bound is not None:
            axes.axvline(bound * FIGURES[key].scale, color=GREY, linewidth=0.9, linestyle=(0, (4.0, 2.0)))
        axes.set_xlabel(FIGURES[key].name.replace("[", "(").replace("]", ")"))
        axes.set_ylim(0.0, 100.0)
    for axes in panels[len(shown) :]:
        axes.set_axis_off()
    for axes in panels[::4]:
        axes.set_ylabel("flights (%)")
    if 1 < len(report.points) <= MOST_CURVES:
        figure.legend([p.name for p in report.points], loc="outside upper center", ncols=2)
    return figure


def success_map(report: Report, table: Table) -> Figure | None:
    """Rate of success in classes of the two parameters that say most; None where fewer than two vary."""
    names = mapped(report, table)
    if names is None:
        return None
    (x, ticks_x), (y, ticks_y) = (_classes(table, name) for name in names)
    count, good = np.zeros((len(ticks_y), len(ticks_x))), np.zeros((len(ticks_y), len(ticks_x)))
    np.add.at(count, (y, x), 1.0)
    np.add.at(good, (y, x), table.success)
    with np.errstate(invalid="ignore"):
        rate = 100.0 * good / count
    darkest = min(50.0, float(np.nanmin(rate)))
    figure = sheet(WIDTH_IN, 0.9 + 0.38 * len(ticks_y))
    axes = figure.subplots()
    axes.grid(visible=False)
    image = axes.imshow(rate, origin="lower", cmap="cividis", vmin=darkest, vmax=100.0, aspect="auto")
    for (i, j), n in np.ndenumerate(count):
        if n:
            bright = rate[i, j] > 0.5 * (darkest + 100.0)
            axes.text(
                j,
                i,
                f"{rate[i, j]:.0f}\n({n:.0f})",
                ha="center",
                va="center",
                fontsize=6.5,
                color="k" if bright else "w",
            )
    axes.set_xticks(range(len(ticks_x)), ticks_x, rotation=0 if max(map(len, ticks_x)) < 9 else 30)
    axes.set_yticks(range(len(ticks_y)), ticks_y)
    axes.set_xlabel(names[0])
    axes.set_ylabel(names[1])
    figure.colorbar(image, ax=axes, label="flights that succeed (%)")
    return figure


def _classes(table: Table, name: str) -> tuple[np.ndarray, list[str]]:
    # Class of each row and the words at the axis: each value itself where there are few, else ranges of equal width.
    column, numbers = table.values[name], as_numbers(table.values[name])
    distinct = sorted(set(column)) if numbers is not None else sorted(set(map(str, column)))
    if numbers is None or len(distinct) <= MOST_CLASSES:
        index = {value: i for i, value in enumerate(distinct)}
        words = [f"{v:g}" if isinstance(v, int | float) else str(v) for v in distinct]
        return np.array([index[v if numbers is not None else str(v)] for v in column]), words
    edges = np.linspace(numbers.min(), numbers.max(), min(MOST_CLASSES, max(2, int((len(column) / 8.0) ** 0.5))) + 1)
    words = [f"{a:.2g} to {b:.2g}" for a, b in pairwise(edges)]
    return np.clip(np.searchsorted(edges, numbers, "right") - 1, 0, len(words) - 1), words


def slices(report: Report, table: Table) -> Figure | None:
    """Rate of success with Wilson's interval over each parameter that is a number, the most influential first."""
    from scipy.stats import binomtest

    ranked = [i.names[0] for i in report.sensitivity.single]
    names = [n for n in ranked if as_numbers(table.values[n]) is not None][:8]
    if not names:
        return None
    lines = -(-len(names) // 4)
    figure = sheet(WIDTH_IN, 1.6 * lines)
    panels = figure.subplots(lines, 4, squeeze=False, sharey=True).ravel()
    for axes, name in zip(panels, names, strict=False):
        numbers, (classes, _) = as_numbers(table.values[name]), _classes(table, name)
        assert numbers is not None
        at, rate, low, high = [], [], [], []
        for k in np.unique(classes):
            here = classes == k
            good, n = int(table.success[here].sum()), int(here.sum())
            interval = binomtest(good, n).proportion_ci(0.95, method="wilson")
            at.append(numbers[here].mean())
            rate.append(100.0 * good / n)
            low.append(100.0 * (good / n - interval.low))
            high.append(100.0 * (interval.high - good / n))
        axes.errorbar(
            at,
            rate,
            yerr=[np.maximum(low, 0.0), np.maximum(high, 0.0)],
            fmt="o-",
            color=BLUE,
            markersize=3.0,
            capsize=2.0,
            linewidth=1.0,
        )
        axes.set_xlabel(name)
        axes.set_ylim(-2.0, 102.0)
    for axes in panels[len(names) :]:
        axes.set_axis_off()
    for axes in panels[::4]:
        axes.set_ylabel("succeed (%)")
    return figure
