"""A mission as data: phases, what each of them does, the guards between them with thresholds and units, and their time-outs.

A guard is a conjunction of conditions `signal relation threshold` that must hold for `hold_s`. Signals are numbers that the
controller computes every tick; thresholds have a name, a value and the signal's unit. The tables are checked for contradictions
when they are compiled to arrays (`phase_table`), and evaluated by one compiled function.
"""

from typing import NamedTuple

import numpy as np

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


CARRIED_N, IMPACT_N = 20.0, 60.0  # while nothing meets, where faces meet; the demonstrator's flights make 3 N and 30 N


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
    sight: bool = True
    """Whether the camera should see the UAV."""
    observe: bool = False
    """Whether the disturbance observer learns."""
    force_n: float = CARRIED_N
    """Hinge force, N, that no healthy flight of the phase makes."""
    share: float = 1.0
    """Share of the weight that the rotors carry at the end of the phase, where the UAV ramps its thrust."""
    duration_s: float = 0.0
    """Duration of the phase's move; 0 where there is none."""
    timeout_s: float = 10.0
    on_timeout: str = "abort"
    guards: tuple[Guard, ...] = ()
    final: bool = False
    """Whether the mission ends here."""


ARM = ("hold", "join", "track", "close", "move", "back_off", "yield", "brake", "launch", "leave", "balance")
"""Reference of the arm: rest where it is; septic blend from rest to below the plate; below the plate; the gap to the plate closes;
septic move to the phase's target; septic move away downwards from where it is; give way to the hinge force; brakes on; run-up to the
speed that the UAV is given, then on at it; down from below the UAV at its speed, and to rest; balance the UAV."""

UAV = ("autonomous", "station", "level", "ramp", "balance", "off", "run_up", "cruise")
"""The UAV hovers by itself; keeps its station by the ground's estimate; level with the thrust it has; level with a
thrust ramp; level with the thrust that frees the hinge of force; stops; as level, tilted against its drag; flies on."""

MAGNET = ("off", "on", "test")

LINK = ("guided", "held", "landed", "caught")
"""A UAV without link hovers by itself; stays level with the thrust it has; lets its rotors run down; hovers by itself though the
magnet has gripped it."""

SHARE_RAMP = UAV.index("ramp")


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
