"""Plots beside a film: heights, forces and tilt over time, drawn once; what is yet to come is pale."""

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from armland.experiments.judge.judgement import PhaseTime
from armland.view.figures.canvas import DESIRED, paper_style, shade
from armland.view.figures.curves import Run
from armland.view.figures.flight import draw_forces, draw_height, draw_tilt
from armland.view.flown import Flown

DPI = 100

PALE = 0.72
"""Share of white in what is yet to come."""

LETTERS = 9.0 / 540.0
"""Size of the letters, points, over the height of the strip, px."""


class Strip:
    """The plots of a run as a picture.

    Args:
        run: what is plotted.
        phases: of it, every second of which is shaded.
        width: px.
        height: px.
    """

    def __init__(self, run: Flown, phases: list[PhaseTime], width: int, height: int) -> None:
        letters = {"font.size": LETTERS * height, "legend.fontsize": 0.9 * LETTERS * height}
        style = {"font.family": "DejaVu Sans", "mathtext.fontset": "dejavusans", **letters}
        with paper_style(), matplotlib.style.context(style):
            figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, layout="constrained")
            canvas = FigureCanvasAgg(figure)
            panels = list(figure.subplots(4, 1, sharex=True))
            _draw(panels, run, phases)
            figure.align_ylabels()
            canvas.draw()
        self._picture = np.asarray(canvas.buffer_rgba())[..., :3].copy()
        ahead = PALE * 255 + (1.0 - PALE) * self._picture.astype(float)
        self._ahead = np.rint(ahead).astype(np.uint8)
        self._boxes = [np.rint(a.get_window_extent().extents).astype(int) for a in panels]
        self._of_time = panels[0].transData

    def at(self, t: float) -> NDArray[np.uint8]:
        """The plots (height, width, 3) at the time `t`, s, with a line there."""
        out, height = self._picture.copy(), len(self._picture)
        x = round(float(self._of_time.transform((t, 0.0))[0]))
        for left, low, right, high in self._boxes:
            place = slice(height - high, height - low)
            cut = int(np.clip(x, left, right))
            out[place, cut:right] = self._ahead[place, cut:right]
            out[place, max(cut - 1, left) : cut + 1] = (0, 0, 0)
        return out


def _draw(panels: list[Axes], run: Flown, phases: list[PhaseTime]) -> None:
    log, time = run.ticks, run.time
    draw_height(panels[0], time, log)
    draw_forces(panels[1], panels[2], time, log, run.brief.rate_hz)
    draw_tilt(panels[3], Run("", time, log, DESIRED))
    for axes in panels:
        shade(axes, [(p.start_s, p.end_s) for p in phases[1::2]])
        axes.yaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 5, 10]))
    panels[0].legend(*panels[2].get_legend_handles_labels(), loc="lower center", bbox_to_anchor=(0.42, 1.0), ncols=3)
    panels[-1].xaxis.set_major_locator(MaxNLocator(nbins=6, integer=True))
    panels[-1].set(xlim=(0.0, len(time) / run.brief.rate_hz), xlabel="time (s)")
