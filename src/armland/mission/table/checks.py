"""What is wrong with a mission's table: unknown words, contradictory guards, phases that are never reached or never left."""

import numpy as np

from armland.mission.table.phases import ARM, KINDS, LINK, LOADS, MAGNET, SHARES, SIGNALS, UAV, Guard, Phase

WORDS = {
    "arm": ARM,
    "uav": UAV,
    "kind": (*KINDS, "end"),
    "magnet": MAGNET,
    "link": LINK,
    "load": LOADS,
    "share": SHARES,
}
"""Field of a phase -> what it may say."""


def check(phases: tuple[Phase, ...], thresholds: dict[str, float]) -> list[str]:
    """What is wrong with a mission: one line for each contradiction.

    Args:
        phases: of the mission, its ends included.
        thresholds: by name, in the units of the signals that they are compared with.
    """
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
    for what, known in WORDS.items():
        value = getattr(p, what)
        if value not in known:
            problems.append(f"{where}: {what} = {value!r} is unknown; known are {', '.join(known)}")
    if not p.final and not p.timeout_s > p.duration_s:
        problems.append(f"{where}: time-out {p.timeout_s:g} s is not above its move's duration of {p.duration_s:g} s")
    if p.held and p.magnet != "on" and p.uav != "hinged":
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
    onward = {p.name: {g.target for g in p.guards} | {p.on_timeout} for p in phases if not p.final}
    reached, ahead = {phases[0].name}, [phases[0].name]
    while ahead:
        new = onward.get(ahead.pop(), set()) - reached
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
