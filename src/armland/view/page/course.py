"""What happened in a flight and why: phases and the guards that led on, faults and where they led, limits enforced."""

import json
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.experiments.judge.judgement import PhaseTime
from armland.mission.registry import mission_named
from armland.mission.supervisor.remedies import REMEDIES, STANDING, UNMET
from armland.mission.supervisor.table import DEBOUNCE_S
from armland.mission.table.phases import SIGNALS, Condition
from armland.records import LIMIT_NAMES
from armland.scenario import Scenario
from armland.view.flown import Flown

APART_S = 0.25
"""Stretches in which one limit was enforced are one where less time lies between them."""


YES_OR_NO = ("uav_seen", "contact", "magnet_ready", "magnet_fault", "bias_known")
"""Signals that are 0 or 1."""


class Event(NamedTuple):
    """Something that happened."""

    time_s: float
    kind: str  # `phase`, `fault`, `limit` or `retry`
    what: str
    why: str


def course(run: Flown, phases: list[PhaseTime], metadata: Mapping[str, str], scenario: Scenario) -> list[Event]:
    """All events of a flight in the order of their time."""
    found = [*_led_on(run, phases, _guards(metadata, scenario)), *_faults(run), *_retries(run), *_limited(run)]
    return sorted(found, key=lambda event: event.time_s)


def _led_on(run: Flown, phases: list[PhaseTime], told: Mapping[tuple[str, str], str]) -> Iterator[Event]:
    for before, after in pairwise(phases):
        k = min(round(after.start_s * run.brief.rate_hz), len(run.ticks["mission"]) - 1)
        unmet = int(run.ticks["mission"]["unmet"][k])
        fault = run.brief.faults[int(run.ticks["mission"]["fault"][k])]
        if after.name in run.brief.finals and fault != "none":
            why = f"fault {fault}"
        elif waited := [UNMET[name] for i, name in enumerate(SIGNALS) if unmet >> i & 1]:
            why = f"the time for {_plain(before.name)} was over: {', '.join(waited)}"
        else:
            why = told.get((before.name, after.name), "its time was over")
        yield Event(after.start_s, "phase", f"{_plain(before.name)} → {_plain(after.name)}", why)


def _guards(metadata: Mapping[str, str], scenario: Scenario) -> dict[tuple[str, str], str]:
    # Phase and the one after it -> what the guard between them asks for; nothing for a mission that is not known here.
    try:
        mission = mission_named(metadata["mission"])
    except ConfigurationError:
        return {}
    thresholds = json.loads(metadata.get("thresholds", "{}"))
    out: dict[tuple[str, str], str] = {}
    for phase in mission.phases(scenario):
        for guard in phase.guards:
            words = ", ".join(_condition(c, thresholds) for c in guard.conditions)
            held = f" for {guard.hold_s:g} s" if guard.hold_s else ""
            key = (phase.name, guard.target)
            out[key] = f"{out[key]}; or {words}{held}" if key in out else f"{words}{held}"
    return out


def _condition(c: Condition, thresholds: Mapping[str, float]) -> str:
    unit = SIGNALS[c.signal]
    if c.signal in YES_OR_NO and c.threshold == "half":
        return f"{'' if c.relation == '>' else 'not '}{_plain(c.signal)}"
    if c.threshold == "almost_one":
        return "the move at its end" if c.signal == "progress" else f"{_plain(c.signal)} complete"
    value = thresholds.get(c.threshold)
    number = _plain(c.threshold) if value is None else f"{value:.3g}{'' if unit == '1' else f' {unit}'}"
    return f"{_plain(c.signal)} {c.relation} {number}"


def _faults(run: Flown) -> Iterator[Event]:
    mission = run.ticks["mission"]
    fault = mission["fault"]
    for k in np.flatnonzero(np.diff(fault, prepend=0)):
        name = run.brief.faults[int(fault[k])]
        if name not in REMEDIES:
            continue
        means, remedy = REMEDIES[name]
        end = run.brief.phases[int(mission["phase"][min(int(k) + 1, len(fault) - 1)])]
        seen = f"seen for {1e3 * DEBOUNCE_S[name]:g} ms" if name in DEBOUNCE_S else "seen once"
        stands = STANDING.get(end, "")
        did = f"led to {_plain(end)}: {stands}" if stands else f"in {_plain(end)}"
        yield Event(k / run.brief.rate_hz, "fault", f"fault {name}, {seen}; {did}", f"{means}. Remedy: {remedy}")


def _retries(run: Flown) -> Iterator[Event]:
    retries = run.ticks["mission"]["retries"]
    for k in np.flatnonzero(np.diff(retries, prepend=0) > 0):
        yield Event(
            k / run.brief.rate_hz,
            "retry",
            f"capture missed, attempt {int(retries[k]) + 1}",
            "the plate was not gripped",
        )


def _limited(run: Flown) -> Iterator[Event]:
    flags, rate = run.ticks["health"]["flags"], run.brief.rate_hz
    for bit, name in LIMIT_NAMES.items():
        for first, last, ticks in stretches(flags & bit != 0, round(APART_S * rate)):
            until = f" until {last / rate:.2f} s" if last > first else ""
            yield Event(
                first / rate, "limit", f"{_plain(name)} limited{until}", f"{ticks} {'tick' if ticks == 1 else 'ticks'}"
            )


def stretches(where: NDArray[np.bool_], apart: int) -> list[tuple[int, int, int]]:
    """First and last tick of each stretch of `where` (k,), and ticks in it; gaps below `apart` ticks are none."""
    ticks = np.flatnonzero(where)
    if not len(ticks):
        return []
    cuts = np.flatnonzero(np.diff(ticks) > apart) + 1
    return [(int(part[0]), int(part[-1]), len(part)) for part in np.split(ticks, cuts)]


def _plain(name: str) -> str:
    return name.replace("_", " ")
