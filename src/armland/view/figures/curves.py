"""Curves of a run: its ticks on the clock of the figures, and what the figures derive from them."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.spatial.transform import Rotation

from armland.errors import LogError
from armland.experiments.judge.tracking import deviation
from armland.view.figures.canvas import line_of
from armland.view.flown import Flown, Ticks

STILL_M_S = 1e-4  # The desired path rests where it is slower than this
SMOOTH_S = 0.04  # Window of the running mean: short against the UAV's swing of some 0.4 s
BUCKETS = 700  # Finer than a printer's dots on a page's width


class Run(NamedTuple):
    """One run on the clock of the figures."""

    name: str
    time: NDArray  # (ticks,) s, 0 at the start of the desired path
    ticks: Ticks  # messages by name, (ticks,) each
    line: dict  # of its curves

    def plot(self, axes: Axes, y: NDArray, **changes: object) -> None:
        """Draw y (ticks,) over time with the line of this run, or with what `changes` says of it."""
        axes.plot(*thinned(self.time, y), **{"label": self.name, **self.line, **changes})

    def plot_noisy(self, axes: Axes, y: NDArray) -> None:
        """Draw the running mean of y (ticks,) over time, and y itself pale behind it."""
        width = max(round(SMOOTH_S / (self.time[1] - self.time[0])), 1)
        self.plot(axes, uniform_filter1d(y, width, mode="nearest"))
        self.plot(axes, y, label="_raw", linewidth=0.4, linestyle="-", alpha=0.3, zorder=2.0)

    def judged(self, y: NDArray) -> NDArray:
        """The part of y (ticks, ...) since the start of the desired path."""
        return y[self.time >= 0.0]


def clocked(runs: Sequence[Flown]) -> list[Run]:
    """The runs in the order of their names, with the time of each tick.

    Raises:
        LogError: no runs, or one without a path or that ends before its path starts.
    """
    if not runs:
        raise LogError("there is no run to draw; give the log of at least one experiment, such as E1")
    on_clock = []
    for i, run in enumerate(sorted(runs, key=lambda run: run.name)):
        if not run.brief.legs:
            raise LogError(
                f"run {run.name} follows no path; figures of a path need the log of an experiment, such as E1"
            )
        time = run.time - run.brief.legs[0].start_s
        if len(time) < 2 or time[-2] < 0.0:
            raise LogError(f"run {run.name} has {len(time)} ticks; it ends before its path starts")
        on_clock.append(Run(run.name, time, run.ticks, line_of(run.name, i)))
    return on_clock


def thinned(x: NDArray, y: NDArray, buckets: int = BUCKETS) -> tuple[NDArray, NDArray]:
    """The points (x, y), both (k,), or where there are many: the ends, and of each bucket the lowest and the highest.

    Peaks keep their height, which a plain "every k-th" would cut.
    """
    if len(y) <= 2 * buckets:
        return x, y
    keep = [np.array([0, len(y) - 1])]
    for part in np.array_split(np.arange(len(y)), buckets):
        keep.append(part[[np.argmin(y[part]), np.argmax(y[part])]])
    index = np.unique(np.concatenate(keep))
    return x[index], y[index]


def deviation_deg(ticks: Ticks) -> NDArray:
    """Angle between the UAV's true attitude and q_d at each tick, (ticks,), deg."""
    return np.degrees(deviation(ticks["truth"]["quat"], ticks["reference"]["quat"]))


def roll_pitch_yaw_deg(ticks: Ticks) -> NDArray:
    """Roll, pitch and yaw of the UAV's true attitude, R = Rz(yaw) Ry(pitch) Rx(roll), (ticks, 3), deg."""
    turns = Rotation.from_quat(ticks["truth"]["quat"], scalar_first=True)
    return np.asarray(turns.as_euler("ZYX", degrees=True)[:, ::-1])


def error_mm(ticks: Ticks) -> NDArray:
    """Actual minus desired pivot position at each tick, (ticks, 3), mm, world."""
    return 1e3 * (ticks["truth"]["r"] - ticks["reference"]["r"])


def moves(run: Run) -> list[tuple[float, float]]:
    """Begin and end of each move of the desired path, s."""
    speed = np.linalg.norm(np.gradient(run.ticks["reference"]["r"], run.time, axis=0), axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], speed > STILL_M_S, [0]]).astype(int)))
    return [(float(run.time[a]), float(run.time[b - 1])) for a, b in edges.reshape(-1, 2)]


def rests(run: Run) -> list[tuple[float, float]]:
    """Begin and end of each rest of the desired path after a move, s."""
    busy = moves(run)
    ends = [begin for begin, _ in busy[1:]] + [float(run.time[-1])]
    return [(arrival, end) for (_, arrival), end in zip(busy, ends, strict=False)]
