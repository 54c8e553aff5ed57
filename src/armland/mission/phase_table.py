"""A mission's phases compiled to arrays, and the one compiled function that decides which phase comes next."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.mission.phases import ARM, LINK, MAGNET, SIGNAL, UAV, Phase, check
from armland.records import Record
from armland.rotations import Array

PHASE = np.dtype(
    [
        ("arm", "i8"),
        ("uav", "i8"),
        ("magnet", "i8"),
        ("link", "i8"),
        ("held", "i8"),
        ("free", "i8"),
        ("observe", "i8"),
        ("force", "f8"),
        ("share", "f8"),
        ("duration", "f8"),
        ("timeout", "f8"),
        ("on_timeout", "i8"),
        ("final", "i8"),
        ("first", "i8"),  # of its guards
        ("end", "i8"),
    ]
)

GUARD = np.dtype([("target", "i8"), ("hold", "i8"), ("first", "i8"), ("end", "i8")])  # hold in ticks

CONDITION = np.dtype(
    [("signal", "i8"), ("sign", "f8"), ("threshold", "f8")]
)  # holds where sign·signal > sign·threshold


class Table(NamedTuple):
    """A mission's tables as arrays."""

    names: tuple[str, ...]
    phases: NDArray[np.void]
    guards: NDArray[np.void]
    conditions: NDArray[np.void]

    def number(self, name: str) -> int:
        """Index of the phase `name`."""
        return self.names.index(name)


def compile_table(phases: tuple[Phase, ...], thresholds: dict[str, float], tick_s: float) -> Table:
    """Check a mission and turn it into arrays.

    Raises:
        ConfigurationError: contradictions; all of them, each with the phase and the numbers.
    """
    problems = check(phases, thresholds)
    if problems:
        raise ConfigurationError("\n  ".join(["the mission's table contradicts itself:", *problems]))
    names = tuple(p.name for p in phases)
    rows = np.zeros(len(phases), PHASE)
    guards: list[tuple] = []
    conditions: list[tuple] = []
    for row, p in zip(rows, phases, strict=True):
        row["arm"], row["uav"], row["magnet"] = ARM.index(p.arm), UAV.index(p.uav), MAGNET.index(p.magnet)
        row["link"] = LINK.index(p.link)
        row["held"], row["free"], row["observe"], row["final"] = p.held, p.free, p.observe, p.final
        row["force"], row["share"], row["duration"], row["timeout"] = p.force_n, p.share, p.duration_s, p.timeout_s
        row["on_timeout"] = names.index(p.name if p.final else p.on_timeout)
        row["first"], row["end"] = len(guards), len(guards) + len(p.guards)
        for g in p.guards:
            hold = max(round(g.hold_s / tick_s), 1)
            guards.append((names.index(g.target), hold, len(conditions), len(conditions) + len(g.conditions)))
            for c in g.conditions:
                conditions.append((SIGNAL[c.signal], 1.0 if c.relation == ">" else -1.0, thresholds[c.threshold]))
    return Table(names, rows, np.array(guards, GUARD), np.array(conditions, CONDITION))


@njit(cache=True)
def next_phase(
    phase: int,
    elapsed: float,
    signals: Array,
    phases: NDArray[np.void],
    guards: NDArray[np.void],
    conditions: NDArray[np.void],
    counts: NDArray[np.int64],
) -> int:
    """Phase after this tick: the first guard that has held long enough, else the time-out's, else the same.

    Args:
        phase: index.
        elapsed: time in the phase, s.
        signals: as in `SIGNALS`.
        phases: table.
        guards: table.
        conditions: table.
        counts: ticks for which each guard has held; to be set to zero when a phase begins.
    """
    p = phases[phase]
    for i in range(p.first, p.end):
        g = guards[i]
        counts[i] = counts[i] + 1 if _open(g, signals, conditions) else 0
        if counts[i] >= g.hold:
            return int(g.target)
    if not p.final and elapsed > p.timeout:
        return int(p.on_timeout)
    return phase


@njit(cache=True)
def _open(g: Record, signals: Array, conditions: NDArray[np.void]) -> bool:
    for i in range(g.first, g.end):
        c = conditions[i]
        # Written so that a signal that is not a number opens nothing.
        if not c.sign * signals[c.signal] > c.sign * c.threshold:
            return False
    return True
