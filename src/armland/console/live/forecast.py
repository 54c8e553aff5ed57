"""What the supervisor will do about a fault in a phase: asked of the very table that it looks into; and what a phase waits for."""

from collections.abc import Mapping
from html import escape
from typing import NamedTuple

from armland.console.live.pilot import Now
from armland.errors import ConfigurationError
from armland.experiments.operator.provoked import PROVOKED
from armland.mission.plan import Plan
from armland.mission.supervisor.operator import HELD_BY_HAND
from armland.mission.supervisor.remedies import REMEDIES, STANDING
from armland.mission.supervisor.table import FAULT
from armland.mission.table.phases import SIGNALS
from armland.scenario.faults import Fault

AT_ONCE = "at once"

CELL = "padding:0 3px;border:1px solid #8884;font-size:10px;white-space:nowrap"


class Thrown(NamedTuple):
    """A fault that was thrown in by hand."""

    fault: str
    """Of the supervisor, that it should find."""
    phase: str
    """In which it was thrown in, or at whose begin."""
    expected: str
    """End that the supervisor's table names there; `-`: none."""


def end_of(plan: Plan, fault: str, phase: str) -> str:
    """The end to which the supervisor leads where it finds a fault in a phase; `-` where the fault does not matter there."""
    target = int(plan.table["faults"][0, FAULT[fault], plan.number(phase)])
    return "-" if target < 0 else plan.names[target]


def forecast(plan: Plan, fault: str, phase: str) -> str:
    """The same in words."""
    end, found = end_of(plan, fault, phase), REMEDIES[fault][0]
    if end == "-":
        return f"{fault} ({found}): in {phase} it does not matter, or the procedure itself copes"
    return f"{fault} ({found}): in {phase} the supervisor goes to {end}: {STANDING.get(end, '')}"


def outcome(thrown: Thrown, found: str, phase: str, end: str, after_s: float) -> str:
    """What the supervisor did after a fault was thrown in, beside what its table had said.

    Args:
        thrown: what was thrown in.
        found: fault that the supervisor named.
        phase: in which it did.
        end: to which it went.
        after_s: time between, s.
    """
    as_said = end == thrown.expected and found == thrown.fault
    words = f"{thrown.fault} thrown into {thrown.phase}: found {found} in {phase} after {after_s:.2f} s, went to {end}"
    return words + (", as the table says" if as_said else f"; the table said {thrown.fault} to {thrown.expected}")


def failure(fault: str, phase: str) -> Fault:
    """What has to fail in the plant for the supervisor to find a fault.

    Raises:
        ConfigurationError: nothing in the plant makes it.
    """
    if fault not in PROVOKED:
        raise ConfigurationError(
            f"fault: nothing in the plant makes {fault!r}; those that can be: {', '.join(PROVOKED)}"
        )
    return Fault(**PROVOKED[fault], phase=None if phase == AT_ONCE else phase)


def table_html(plan: Plan, chosen: tuple[str, str] | None = None) -> str:
    """The table fault × phase as HTML, with the cell that is chosen marked."""
    names, ends = plan.names, plan.table["faults"][0]
    phases = [(i, p.name) for i, p in enumerate(plan.phases) if not p.final and p.name not in HELD_BY_HAND]
    head = "".join(f'<th style="{CELL}">{escape(p.replace("_", " "))}</th>' for _, p in phases)
    rows = []
    for fault in PROVOKED:
        cells = []
        for i, phase in phases:
            mark = ";background:#E69F0088;font-weight:700" if (fault, phase) == chosen else ""
            end = int(ends[FAULT[fault], i])
            words = "-" if end < 0 else names[end].replace("_", " ")
            cells.append(f'<td style="{CELL}{mark}">{escape(words)}</td>')
        rows.append(
            f'<tr><th style="{CELL};text-align:left">{escape(fault.replace("_", " "))}</th>{"".join(cells)}</tr>'
        )
    return (
        '<div style="overflow:auto;max-height:320px;padding:2px 8px"><table style="border-collapse:collapse">'
        f"<tr><th></th>{head}</tr>{''.join(rows)}</table></div>"
    )


def waits_html(plan: Plan, now: Now, thresholds: Mapping[str, float]) -> str:
    """What the phase in progress waits for: each guard's conditions, their values, and how far each is from its threshold."""
    phase = plan.phases[int(now.tick["mission"]["phase"][0])]
    if phase.name in HELD_BY_HAND:
        return _block(["held by the operator; `resume` goes on"])
    lines, number = [], int(plan.table["phases"]["first"][0, plan.number(phase.name)])
    for i, guard in enumerate(phase.guards):
        need = int(plan.table["guards"]["hold"][0, number + i])
        held = min(int(now.held_for[number + i]), need)
        lines.append(f"<b>{escape(guard.target.replace('_', ' '))}</b> when, for {held} of {need} ticks,")
        for c in guard.conditions:
            value, bound = float(now.signals[list(SIGNALS).index(c.signal)]), thresholds[c.threshold]
            open_now = value > bound if c.relation == ">" else value < bound
            sign, color = ("✓", "#009E73") if open_now else ("·", "inherit")
            unit = "" if SIGNALS[c.signal] == "1" else f" {SIGNALS[c.signal]}"
            words = f"{c.signal.replace('_', ' ')} {value:.3g} {c.relation} {bound:.3g}{unit}"
            lines.append(f'<span style="color:{color};padding-left:10px">{sign} {escape(words)}</span>')
    left = phase.timeout_s - float(now.tick["mission"]["elapsed"][0])
    if not phase.final:
        lines.append(f"else {escape(phase.on_timeout.replace('_', ' '))} in {max(left, 0.0):.1f} s")
    return _block(lines or ["the mission has ended"])


def _block(lines: list[str]) -> str:
    return f'<div style="font-size:11px;line-height:1.35;padding:2px 10px">{"<br>".join(lines)}</div>'
