"""The plots of a flight: which numbers of its ticks are shown, and the charts that show a window of them.

A chart has the phases as coloured ground and what the supervisor did as red bands; a second flight's lines and their difference are
drawn into the same charts. All are thinned to `MOST_HZ`, which the eye cannot tell from more.
"""

from collections.abc import Callable, Sequence
from html import escape
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from viser import GuiApi

from armland.console.page.often import put_curves
from armland.records import Records
from armland.rotations import Array
from armland.view.figures.flight import distance_mm, upward_forces_n

MOST_HZ = 30
"""Points of a line for each second of flight."""

COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
"""Of Okabe and Ito."""

GROUNDS = ("#56B4E926", "#99999926", "#F0E44238")
"""Grounds of the phases, by their number: such as follow one another differ, wherever a window begins."""

ACTION, NOW, AXIS = "#D5000055", "#D55E00", "#888888"

ACTION_S = 0.25
"""How long a supervisor's action is shown as a band."""


class Panel(NamedTuple):
    """One chart: its title with the unit, and its lines."""

    title: str
    lines: dict[str, Callable[[Records], Array]]
    of_arm: bool = False
    """Whether it says nothing where no arm flies."""

    def shown(self, arm: bool) -> list[tuple[int, str]]:
        """Number and label of each line that is shown, where an arm flies or none."""
        if arm:
            return list(enumerate(self.lines))
        return [] if self.of_arm else [(i, ARMLESS.get(n, n)) for i, n in enumerate(self.lines) if n != "arm"]


ARMLESS = {"UAV to arm": "UAV to its place", "cradle": "pad"}
"""Labels of lines where no arm flies; a line of the arm is left out."""


def _norm(message: str, field: str) -> Callable[[Records], Array]:
    return lambda t: np.linalg.norm(t[message][field], axis=1)


def _force(number: int) -> Callable[[Records], Array]:
    return lambda t: upward_forces_n({"truth": t["truth"]})[number]


PANELS = (
    Panel("height (m)", {"UAV": lambda t: t["truth"]["r"][:, 2], "arm": lambda t: t["truth"]["ee"][:, 2]}),
    Panel("horizontal distance (mm)", {"UAV to arm": lambda t: distance_mm({"truth": t["truth"]})}),
    Panel(
        "error of the arm (mm)",
        {"to its reference": lambda t: 1e3 * np.linalg.norm(t["estimate"]["r"] - t["reference"]["r"], axis=1)},
        of_arm=True,
    ),
    Panel("hinge force (N)", {"force": _norm("truth", "hinge_force")}),
    Panel("who carries the weight (N)", {"rotors": _force(0), "arm": _force(1), "cradle": _force(2)}),
    Panel("V₂ (J); 0: no law of it at work", {"V₂": lambda t: np.nan_to_num(t["proof"]["v2"])}, True),
    Panel("rate of V₂ (W)", {"promised": lambda t: np.nan_to_num(t["proof"]["v2_rate"])}, True),
    Panel("largest joint torque over its limit (1)", {"torque": lambda t: t["health"]["torque_ratio"]}, True),
    Panel("age of the UAV's sample (ms)", {"link": lambda t: 1e3 * t["health"]["uav_age"]}),
)


class Curves(NamedTuple):
    """What the charts need of ticks: thinned."""

    time: Array  # (k,) s
    phase: NDArray[np.int64]  # (k,)
    fault: NDArray[np.int64]  # (k,)
    lines: tuple[tuple[Array, ...], ...]  # panel by panel, (k,) each


def thin(ticks: Records, rate_hz: int) -> Records:
    """Every so many of the ticks, so that `MOST_HZ` a second are left."""
    return ticks[:: max(1, round(rate_hz / MOST_HZ))]


def curves_of(ticks: Records, period_s: float) -> Curves:
    """The lines of ticks that have been thinned already."""
    with np.errstate(all="ignore"):
        lines = tuple(tuple(np.asarray(f(ticks), dtype=float) for f in p.lines.values()) for p in PANELS)
    mission = ticks["mission"]
    return Curves(ticks["measurement"]["tick"] * period_s, mission["phase"], mission["fault"], lines)


def joined(parts: Sequence[Curves]) -> Curves:
    """Curves one after the other as one."""
    lines = tuple(
        tuple(np.concatenate(pieces) for pieces in zip(*panel, strict=True))
        for panel in zip(*(p.lines for p in parts), strict=True)
    )
    time, phase, fault = (np.concatenate([p[i] for p in parts]) for i in range(3))
    return Curves(time, phase, fault, lines)


def cut(curves: Curves, begin: float, end: float) -> Curves:
    """The part of the curves from `begin` to `end`, s."""
    a, b = (int(np.searchsorted(curves.time, t)) for t in (begin, end + 1e-9))
    lines = tuple(tuple(line[a:b] for line in panel) for panel in curves.lines)
    return Curves(curves.time[a:b], curves.phase[a:b], curves.fault[a:b], lines)


def actions(curves: Curves) -> NDArray[np.bool_]:
    """(k,), where the supervisor has just acted: a fault was named for the first time, or another one."""
    begun = np.flatnonzero((np.diff(curves.fault, prepend=0) != 0) & (curves.fault > 0))
    shown = np.zeros(len(curves.time), bool)
    for k in begun:
        shown |= (curves.time >= curves.time[k]) & (curves.time <= curves.time[k] + ACTION_S)
    return shown


class Charts:
    """The charts on a page.

    Args:
        gui: where they are added.
        names: of the flights: one, or two, short, whose difference is shown as well.
        arm: whether an arm flies in any of them.
    """

    def __init__(self, gui: GuiApi, names: Sequence[str], arm: bool = True) -> None:
        self._two = len(names) > 1
        shown = [(number, panel.shown(arm)) for number, panel in enumerate(PANELS)]
        self._shown = [(number, lines) for number, lines in shown if lines]
        self._charts = [
            self._chart(gui, PANELS[n].title, [word for _, word in lines], names) for n, lines in self._shown
        ]

    def show(self, curves: Curves, other: Curves | None = None, now: float | None = None) -> None:
        """Show a window of curves.

        Args:
            curves: of the first flight.
            other: of the second, at the same times.
            now: time at which a cursor stands, s.
        """
        if len(curves.time) < 2:
            return
        ground = [np.where(curves.phase % len(GROUNDS) == i, 1.0, 0.0) for i in range(len(GROUNDS))]
        ground.append(actions(curves).astype(float))
        here = np.zeros(len(curves.time))
        if now is not None:
            here[int(np.clip(np.searchsorted(curves.time, now), 0, len(here) - 1))] = 1.0
        for (number, shown), chart in zip(self._shown, self._charts, strict=True):
            lines = [curves.lines[number][i] for i, _ in shown]
            if self._two and other is not None:
                beside = [other.lines[number][i] for i, _ in shown]
                lines += [*beside, *(a - b for a, b in zip(lines, beside, strict=True))]
            put_curves(chart, (curves.time, *ground, here, *lines))

    def _chart(self, gui: GuiApi, title: str, labels: Sequence[str], names: Sequence[str]) -> Any:
        ground: dict[str, Any] = {"scale": "ground", "width": 0, "points": {"show": False}}
        series: list[dict[str, Any]] = [
            {"label": "s"},
            *({"label": "phase", **ground, "fill": fill} for fill in GROUNDS),
            {"label": "action", **ground, "fill": ACTION},
            {"label": "now", **ground, "fill": NOW},
        ]
        lines: list[dict[str, Any]] = []
        for flight, name in enumerate(names):
            for i, line in enumerate(labels):
                label = f"{line} {name}" if self._two else line
                lines.append(_line(label, COLORS[i % len(COLORS)], dashed=flight > 0))
        if self._two:
            lines += [_line("difference" if i == 0 else "", "#999999") for i in range(len(labels))]
        gui.add_html(_title(title, lines))
        series += lines
        axis: dict[str, Any] = {"font": "10px sans-serif", "stroke": AXIS, "grid": {"stroke": f"{AXIS}55", "width": 1}}
        axes: Any = ({"size": 28, **axis}, {"size": 46, **axis})
        return gui.add_uplot(
            tuple(np.zeros(2) for _ in series),
            tuple(series),  # type: ignore[arg-type]
            scales={"x": {"time": False}, "ground": {"auto": False, "range": (0.0, 1.0)}},
            axes=axes,
            legend={"show": False},
            height=124,
            # So that the topmost number is whole.
            padding=(8, 8, 0, 0),
        )


def _title(title: str, lines: Sequence[dict[str, Any]]) -> str:
    # In place of the chart's own: it names the grounds as well, and takes as much room as the chart.
    signs = " ".join(
        f'<span style="color:{line["stroke"]}">{"┅" if "dash" in line else "━"}</span> {escape(line["label"])}'
        for line in lines
        if line["label"]
    )
    return f'<div style="font-size:11px;padding:3px 8px 0"><b>{escape(title)}</b> {signs}</div>'


def _line(label: str, color: str, dashed: bool = False) -> dict[str, Any]:
    line: dict[str, Any] = {"label": label, "stroke": color, "width": 1.5, "points": {"show": False}, "spanGaps": False}
    return {**line, "dash": [5, 3]} if dashed else line
