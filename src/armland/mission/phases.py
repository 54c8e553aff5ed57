"""A mission as data: phases, what each of them does, the guards between them with thresholds and units, and their time-outs.

A guard is a conjunction of conditions `signal relation threshold` that must hold for `hold_s`. Signals are numbers that the
controller computes every tick; thresholds have a name, a value and the signal's unit. The tables are checked for contradictions
when they are compiled to arrays, and evaluated by one compiled function.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.records import Record
from armland.rotations import Array

SIGNALS = {
    "progress": "1",
    "elapsed": "s",
    "uav_seen": "1",
    "uav_error": "m",
    "uav_speed": "m/s",
    "offset": "m",
    "relative_speed": "m/s",
    "tilt": "deg",
    "gap": "m",
    "contact": "1",
    "pull": "N",
    "thrust_left": "N",
    "arm_share": "1",
    "ground_share": "1",
    "hinge_force": "N",
    "retreat": "m",
    "magnet_ready": "1",
    "magnet_fault": "1",
    "arm_error": "m",
    "retries": "1",
    "bias_known": "1",
    "rotors": "N",
}
"""What guards may ask for, and the unit. `offset` is horizontal, `pull` the vertical hinge force that pulls the UAV down."""

SIGNAL = {name: i for i, name in enumerate(SIGNALS)}


class Condition(NamedTuple):
    """`signal` below (`<`) or above (`>`) the threshold of that name, in the signal's unit."""

    signal: str
    relation: str
    threshold: str


class Guard(NamedTuple):
    """Way to phase `target`, open when all conditions have held for `hold_s`."""

    target: str
    conditions: tuple[Condition, ...]
    hold_s: float = 0.0


class Phase(NamedTuple):
    """What happens in a phase, and how it ends.

    The fields from `arm` to `observe` say what the controller does; each is an index or a number of the controller's own tables.
    """

    name: str
    arm: str
    """Where the arm's reference comes from, see `ARM`."""
    uav: str
    """What the UAV is asked to do, see `UAV`."""
    kind: str = "flight"
    """Row of the supervisor's fault table."""
    magnet: str = "off"
    """`off`, `on` or `test`."""
    link: str = "guided"
    """What the UAV is told to do should it hear nothing more, see `LINK`."""
    held: bool = False
    """Whether the UAV hangs on the magnet: the controller's model is then arm and UAV together."""
    free: bool = False
    """Whether the end effector is known to touch nothing: the force-torque sensor's bias is learnt."""
    observe: bool = False
    """Whether the disturbance observer learns."""
    force_n: float = 60.0
    """Largest hinge force of the phase, N."""
    share: float = 1.0
    """Share of the weight that the rotors carry at the end of the phase, where the UAV ramps its thrust."""
    duration_s: float = 0.0
    """Duration of the phase's move; 0 where there is none."""
    timeout_s: float = 10.0
    on_timeout: str = "abort"
    guards: tuple[Guard, ...] = ()
    final: bool = False
    """Whether the mission ends here."""


ARM = ("hold", "join", "track", "close", "move", "back_off", "yield", "brake", "balance")
"""Reference of the arm: rest where it is; septic blend from rest to below the plate; below the plate; the gap to the plate closes;
septic move to the phase's target; septic move away downwards from where it is; yield to the hinge force; brakes; balance the UAV."""

UAV = ("autonomous", "station", "level", "ramp", "balance", "off")
"""The UAV hovers by itself; keeps its station by the ground's estimate; level with the thrust it has; level with a
thrust ramp; level with the thrust that frees the hinge of force; stops."""

MAGNET = ("off", "on", "test")

LINK = ("guided", "held", "landed")
"""A UAV without link hovers by itself; stays level with the thrust it has; lets its rotors run down."""

SHARE_RAMP = UAV.index("ramp")

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


def check(phases: tuple[Phase, ...], thresholds: dict[str, float]) -> list[str]:
    """What is wrong with a mission: one line for each contradiction."""
    names = [p.name for p in phases]
    problems = [f"phase {n!r} stands there twice" for n in sorted({n for n in names if names.count(n) > 1})]
    for name, value in thresholds.items():
        if not np.isfinite(value):
            problems.append(f"threshold {name} = {value} is not a finite number")
    for p in phases:
        problems += _phase_problems(p, names, thresholds)
    if problems:
        return problems
    return _unreachable(phases) + _endless(phases)


def _phase_problems(p: Phase, names: list[str], thresholds: dict[str, float]) -> list[str]:
    where, problems = f"phase {p.name!r}", []
    for what, value, known in (
        ("arm", p.arm, ARM),
        ("uav", p.uav, UAV),
        ("magnet", p.magnet, MAGNET),
        ("link", p.link, LINK),
    ):
        if value not in known:
            problems.append(f"{where}: {what} = {value!r} is unknown; known are {', '.join(known)}")
    if not p.final and not p.timeout_s > p.duration_s:
        problems.append(f"{where}: time-out {p.timeout_s:g} s is not above its move's duration of {p.duration_s:g} s")
    if p.held and p.magnet != "on":
        problems.append(f"{where}: the UAV is held, but the magnet is {p.magnet}")
    targets = [g.target for g in p.guards] + ([] if p.final else [p.on_timeout])
    problems += [f"{where} leads to the unknown phase {t!r}" for t in targets if t not in names]
    for g in p.guards:
        problems += [f"{where} -> {g.target}: {line}" for line in _guard_problems(g, p, thresholds)]
    return problems


def _guard_problems(g: Guard, p: Phase, thresholds: dict[str, float]) -> list[str]:
    problems: list[str] = []
    low: dict[str, float] = {}
    high: dict[str, float] = {}
    if g.hold_s >= p.timeout_s:
        problems.append(f"must hold for {g.hold_s:g} s, but the phase times out after {p.timeout_s:g} s")
    for c in g.conditions:
        if c.signal not in SIGNALS or c.relation not in "<>" or c.threshold not in thresholds:
            problems.append(f"condition {' '.join(c)!r}: unknown signal, relation or threshold")
            continue
        value = thresholds[c.threshold]
        if c.relation == ">":
            low[c.signal] = max(low.get(c.signal, -np.inf), value)
        else:
            high[c.signal] = min(high.get(c.signal, np.inf), value)
    for name in low.keys() & high.keys():
        if low[name] >= high[name]:
            unit = SIGNALS[name]
            problems.append(f"{name} must be above {low[name]:g} {unit} and below {high[name]:g} {unit} at once")
    return problems


def _unreachable(phases: tuple[Phase, ...]) -> list[str]:
    # A phase that the supervisor alone enters is final: its fault table leads there.
    ways = {p.name: {g.target for g in p.guards} | {p.on_timeout} for p in phases if not p.final}
    reached, ahead = {phases[0].name}, [phases[0].name]
    while ahead:
        new = ways.get(ahead.pop(), set()) - reached
        reached |= new
        ahead += new
    return [f"phase {p.name!r} is never reached" for p in phases if p.name not in reached and not p.final]


def _endless(phases: tuple[Phase, ...]) -> list[str]:
    ends = {p.name for p in phases if p.final}
    grown = True
    while grown:
        new = {p.name for p in phases if {g.target for g in p.guards} & ends or p.on_timeout in ends} - ends
        ends |= new
        grown = bool(new)
    return [f"phase {p.name!r} leads to no end" for p in phases if p.name not in ends]


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
