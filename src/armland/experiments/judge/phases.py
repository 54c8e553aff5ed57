"""The phases of a recorded mission: when each began, and which one a mission that was stopped came from."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from armland.experiments.judge.brief import Brief, Ticks


@dataclass(frozen=True)
class PhaseTime:
    """One phase as flown."""

    name: str
    start_s: float
    end_s: float


def phase_times(phase: NDArray[np.int64], names: tuple[str, ...], rate: int) -> list[PhaseTime]:
    """Begin and end of each phase, in the order flown."""
    edges = [0, *(np.flatnonzero(np.diff(phase)) + 1).tolist(), len(phase)]
    return [PhaseTime(names[int(phase[a])], a / rate, b / rate) for a, b in pairwise(edges)]


def end_of(ticks: Ticks, brief: Brief) -> str:
    """Name of the last phase."""
    return brief.phases[int(ticks["mission"]["phase"][-1])]


def last_flown(ticks: Ticks, brief: Brief) -> str:
    """The last phase that was no end: an end that a second fault has led on from is no phase of the mission."""
    names = [brief.phases[int(k)] for k in ticks["mission"]["phase"][_edges(ticks)]]
    flown = [name for name in names if name not in brief.finals]
    return flown[-1] if flown else brief.phases[0]


def _edges(ticks: Ticks) -> NDArray[np.intp]:
    phase = ticks["mission"]["phase"]
    return np.append(np.flatnonzero(np.diff(phase)), len(phase) - 1)
