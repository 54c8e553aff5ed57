"""A mission's table as arrays of one fixed size, and the one compiled function that decides which phase comes next.

The size does not depend on the mission, so that no mission compiles anything anew.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.mission.table.checks import check
from armland.mission.table.phases import ARM, LINK, MAGNET, SIGNAL, UAV, Phase
from armland.records import Record

PHASES, GUARDS, CONDITIONS, FAULT_ROWS = 32, 64, 160, 32
"""Most phases, guards, conditions and faults of a mission."""

PHASE = np.dtype(
    [
        ("arm", "i8"),
        ("uav", "i8"),
        ("magnet", "i8"),
        ("link", "i8"),
        ("held", "i8"),
        ("free", "i8"),
        ("observe", "i8"),
        ("seeks", "i8"),
        ("force", "f8"),  # N, largest hinge force
        ("share", "f8"),  # of the hover thrust, at the end of a ramp
        ("duration", "f8"),  # s
        ("timeout", "f8"),  # s
        ("on_timeout", "i8"),
        ("final", "i8"),
        ("first", "i8"),  # of its guards
        ("end", "i8"),
    ]
)

GUARD = np.dtype([("target", "i8"), ("hold", "i8"), ("first", "i8"), ("end", "i8")])  # hold in ticks

CONDITION = np.dtype([("signal", "i8"), ("sign", "f8"), ("threshold", "f8")])
"""Holds where sign·signal > sign·threshold."""

TABLE = np.dtype(
    [
        ("phases", PHASE, (PHASES,)),
        ("guards", GUARD, (GUARDS,)),
        ("conditions", CONDITION, (CONDITIONS,)),
        ("faults", "i8", (FAULT_ROWS, PHASES)),  # final phase; −1 where the fault does not matter
        ("debounce", "i8", (FAULT_ROWS,)),  # ticks
        ("miss", "i8"),  # phase that counts as a retry; −1: none
    ]
)


def compile_table(
    phases: tuple[Phase, ...],
    thresholds: dict[str, float],
    shares: dict[str, float],
    loads: dict[str, float],
    tick_s: float,
) -> NDArray[np.void]:
    """Check a mission's phases and turn them into `TABLE` (1,), its fault rows still empty.

    Args:
        phases: of the mission, its ends included.
        thresholds: by name, in the units of the signals.
        shares: the words of `SHARES` as fractions of the weight.
        loads: the words of `LOADS` in N.
        tick_s: s.

    Raises:
        ConfigurationError: contradictions, all of them, each with the phase and the numbers; or a table that is too large.
    """
    problems = check(phases, thresholds)
    guards = [g for p in phases for g in p.guards]
    sizes = (len(phases), PHASES), (len(guards), GUARDS), (sum(len(g.conditions) for g in guards), CONDITIONS)
    for what, (size, most) in zip(("phases", "guards", "conditions"), sizes, strict=True):
        if size > most:
            problems.append(f"{size} {what}, where a table has room for {most}")
    if problems:
        raise ConfigurationError("\n  ".join(["the mission's table contradicts itself:", *problems]))
    names = [p.name for p in phases]
    table = np.zeros(1, TABLE)
    table["faults"], table["miss"] = -1, names.index("miss") if "miss" in names else -1
    guard = condition = 0
    for row, p in zip(table["phases"][0], phases, strict=False):
        row["arm"], row["uav"], row["magnet"] = ARM.index(p.arm), UAV.index(p.uav), MAGNET.index(p.magnet)
        row["link"] = LINK.index(p.link)
        row["held"], row["free"], row["observe"], row["final"] = p.held, p.free, p.observe, p.final
        row["seeks"] = p.seeks
        row["force"], row["share"] = loads[p.load], shares[p.share]
        row["duration"], row["timeout"] = p.duration_s, p.timeout_s
        row["on_timeout"] = names.index(p.name if p.final else p.on_timeout)
        row["first"], row["end"] = guard, guard + len(p.guards)
        for g in p.guards:
            hold = max(round(g.hold_s / tick_s), 1)
            table["guards"][0, guard] = (names.index(g.target), hold, condition, condition + len(g.conditions))
            guard += 1
            for c in g.conditions:
                sign = 1.0 if c.relation == ">" else -1.0
                table["conditions"][0, condition] = (SIGNAL[c.signal], sign, thresholds[c.threshold])
                condition += 1
    return table


@njit(cache=True)
def next_phase(phase: int, elapsed: float, kept: Record, table: Record) -> int:
    """Phase after this tick: the first guard that has held long enough, else the time-out's, else the same.

    Args:
        phase: index.
        elapsed: time in the phase, s.
        kept: has `signals` as in `SIGNALS` and `held_for` (guards,), ticks for which each guard has held: to be set to zero
            when a phase begins.
        table: `TABLE`.
    """
    p = table.phases[phase]
    for i in range(p.first, p.end):
        g = table.guards[i]
        kept.held_for[i] = kept.held_for[i] + 1 if _open(g, kept, table) else 0
        if kept.held_for[i] >= g.hold:
            return int(g.target)
    if not p.final and elapsed > p.timeout:
        return int(p.on_timeout)
    return phase


@njit(cache=True)
def unmet(phase: int, kept: Record, table: Record) -> int:
    """What a phase still waits for: bit i is set where its first guard asks for signal i of `SIGNALS`, which is not there.

    Args:
        phase: index.
        kept: has `signals` as in `SIGNALS`.
        table: `TABLE`.
    """
    p, bits = table.phases[phase], 0
    if p.first == p.end:
        return bits
    for i in range(table.guards[p.first].first, table.guards[p.first].end):
        c = table.conditions[i]
        if not c.sign * kept.signals[c.signal] > c.sign * c.threshold:
            bits |= 1 << c.signal
    return bits


@njit(cache=True)
def _open(g: Record, kept: Record, table: Record) -> bool:
    for i in range(g.first, g.end):
        c = table.conditions[i]
        # Written so that a signal that is not a number opens nothing.
        if not c.sign * kept.signals[c.signal] > c.sign * c.threshold:
            return False
    return True
