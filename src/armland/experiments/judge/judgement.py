"""The judge of all missions: from recorded ticks and the plan's data, by what happened, never by what the controller believed."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.experiments.judge.brief import Brief, Ticks
from armland.experiments.judge.deck import seen_from_deck
from armland.experiments.judge.figures import MEASURES, NAMES, Figures
from armland.experiments.judge.limits import Excess, excesses, held_figures
from armland.experiments.judge.limits import in_words as exceeded_in_words
from armland.experiments.judge.whereabouts import in_words, state_of
from armland.mission.supervisor.remedies import learnt_values, stopped
from armland.mission.table.mission import Criterion, Mission


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
    phases = phase_times(ticks["mission"]["phase"], brief.phases, brief.rate_hz)
    return next((p.name for p in reversed(phases) if p.name not in brief.finals), brief.phases[0])


GOAL = "done"  # Name of the phase in which a mission has reached its goal


class Kind(NamedTuple):
    """What the judge looks at."""

    state: str  # Where the UAV has to be when all is done: `flying`, `held` or `standing`
    measures: dict[str, str]
    """Groups of `figures.MEASURES`, and what to say where one has none, because the mission never came to that."""
    criteria: tuple[Criterion, ...] = ()  # What every such mission has to keep beside its own criteria


KINDS = {
    "landing": Kind(
        "standing",
        {"capture": "", "touchdown": "the UAV never stood on the cradle", "rest": ""},
        (Criterion("touching", 0.0, "pads", "not let go"),),
    ),
    "kept": Kind("standing", {"capture": "", "touchdown": "the UAV never stood on the cradle", "rest": ""}),
    "unaided": Kind("standing", {"touchdown": "the UAV never stood on the pad", "rest": ""}),
    "takeoff": Kind("flying", {"release": "the magnet never let go of a flying UAV", "steady": ""}),
    "path": Kind("held", {"tracking": ""}),
}
"""By `Mission.judged_as`."""


@dataclass(frozen=True)
class Judgement:
    """What a record shows."""

    success: bool
    reason: str
    end: str
    fault: str  # The fault that the controller named last
    state: str  # Where the UAV really is: `flying`, `held`, `standing` or `lost`
    phases: list[PhaseTime]
    retries: int
    figures: dict[str, Figures]  # Groups of figures by name, see `figures.MEASURES`
    hinge_force_max_n: float
    joint_torque_max_ratio: float
    fall_m: float  # Largest height from which the UAV fell on something, see `contacts.falls`
    magnet_pull_max_n: float | None  # None where there is no magnet, see `grip`
    magnet_shear_max_n: float | None
    magnet_shear_max_ratio: float | None  # Over what the face then held
    limits_violated: list[str]

    def result(self) -> dict[str, Any]:
        """The judgement as plain data, for JSON; each group of figures stands beside the other keys."""
        data = asdict(self)
        groups = data.pop("figures")
        return {**data, **groups}


def check_kind(mission: Mission) -> None:
    """Refuse a mission that no row of `KINDS` judges, before it flies.

    Raises:
        ConfigurationError: there is none.
    """
    if mission.judged_as not in KINDS:
        raise ConfigurationError(
            f"mission {mission.name!r}: judged_as = {mission.judged_as!r} is unknown to the judge; known are {', '.join(KINDS)}"
        )


def judge(ticks: Ticks, brief: Brief) -> Judgement:
    """Judge a flight; of a log that was read back, by its messages and `brief_of` its metadata."""
    ticks = seen_from_deck(ticks)
    figures = {name: MEASURES[name](ticks, brief) for name in KINDS[brief.judged_as].measures}
    violated, truth = excesses(ticks, brief), ticks["truth"]
    why = list(_complaints(ticks, brief, figures, violated))
    tau_max = brief.limits.get("tau_max", np.inf)
    return Judgement(
        success=not why,
        reason="; ".join(why) or brief.praise,
        end=end_of(ticks, brief),
        fault=brief.faults[int(ticks["mission"]["fault"][-1])],
        state=state_of(ticks, brief),
        phases=phase_times(ticks["mission"]["phase"], brief.phases, brief.rate_hz),
        retries=int(ticks["mission"]["retries"][-1]),
        figures=figures,
        hinge_force_max_n=float(np.linalg.norm(truth["hinge_force"], axis=1).max()),
        joint_torque_max_ratio=float((np.abs(truth["tau"]) / tau_max).max(initial=0.0)),
        **held_figures(ticks, brief),
        limits_violated=list(violated),
    )


def _complaints(
    ticks: Ticks, brief: Brief, figures: dict[str, Figures], violated: Mapping[str, Excess]
) -> Iterator[str]:
    end, kind = end_of(ticks, brief), KINDS[brief.judged_as]
    before, after = _parted(violated, _begin_of_end(ticks, brief))
    if before:
        yield f"limits violated: {exceeded_in_words(before, ticks, brief)}"
    if end != GOAL:
        # A mission that was stopped says where it stopped; how far it came before stands in the figures.
        yield _stopped(ticks, brief, end)
    else:
        if state_of(ticks, brief) != kind.state:
            yield f"ended in {end}, but {in_words(ticks, brief)}"
        yield from (words for name, words in kind.measures.items() if words and None in figures[name].values())
        yield from _exceeded(brief, figures)
    if after:
        yield f"then limits violated: {exceeded_in_words(after, ticks, brief)}"


def _begin_of_end(ticks: Ticks, brief: Brief) -> int:
    """Tick at which the first end began; the number of ticks where none did."""
    final = np.array([name in brief.finals for name in brief.phases])[ticks["mission"]["phase"]]
    return int(np.argmax(final)) if final.any() else len(final)


def _parted(violated: Mapping[str, Excess], tick: int) -> tuple[dict[str, Excess], dict[str, Excess]]:
    """What was violated first before `tick`, and what from then on: a cause stands before what came of it."""
    before = {name: excess for name, excess in violated.items() if excess.where[:tick].any()}
    return before, {name: excess for name, excess in violated.items() if name not in before}


def _stopped(ticks: Ticks, brief: Brief, end: str) -> str:
    now = in_words(ticks, brief)
    if end not in brief.finals:
        return f"still in phase {end} when the time was over: {now}"
    fault = brief.faults[int(ticks["mission"]["fault"][-1])]
    # As it was when the fault was found: what is learnt after the end says nothing of its cause.
    found = int(np.argmax(ticks["mission"]["fault"] == ticks["mission"]["fault"][-1])) if fault != "none" else -1
    unmet = int(ticks["mission"]["unmet"][_begin_of_end(ticks, brief)])
    learnt = learnt_values(ticks["estimate"][found])
    return stopped(end, last_flown(ticks, brief), fault, now, brief.timeouts, learnt, unmet)


def _exceeded(brief: Brief, figures: dict[str, Figures]) -> Iterator[str]:
    for name, bound, unit, meaning in (*brief.criteria, *KINDS[brief.judged_as].criteria):
        group, _, figure = NAMES.get(name, name).partition(".")
        value = figures[group][figure]
        if value is not None and value > bound:
            yield f"{meaning}: {value:.3g} {unit}, above {bound:g} {unit}"
