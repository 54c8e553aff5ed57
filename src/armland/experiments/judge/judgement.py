"""The judge of all missions: from recorded ticks and the plan's data, by what happened, never by what the controller believed."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from armland.experiments.judge.brief import Brief, Ticks
from armland.experiments.judge.figures import MEASURES, NAMES, Figures
from armland.experiments.judge.limits import limits_violated
from armland.experiments.judge.phases import PhaseTime, end_of, last_flown, phase_times
from armland.experiments.judge.whereabouts import in_words, state_of
from armland.mission.supervisor.remedies import stopped
from armland.mission.table.mission import Criterion

GOAL = "done"
"""Name of the phase in which a mission has reached its goal."""


class Kind(NamedTuple):
    """What the judge looks at."""

    state: str
    """Where the UAV has to be when all is done: `flying`, `held` or `standing`."""
    measures: dict[str, str]
    """Groups of `figures.MEASURES`, and what to say where one has none, because the mission never came to that."""
    criteria: tuple[Criterion, ...] = ()
    """What every such mission has to keep beside its own criteria."""


KINDS = {
    "landing": Kind(
        "standing",
        {"capture": "", "touchdown": "the UAV never stood on the cradle", "rest": ""},
        (Criterion("touching", 0.0, "pads", "not let go"),),
    ),
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
    fault: str
    """The fault that the controller named last."""
    state: str
    """Where the UAV really is: `flying`, `held`, `standing` or `lost`."""
    phases: list[PhaseTime]
    retries: int
    figures: dict[str, Figures]
    """Groups of figures by name, see `figures.MEASURES`."""
    hinge_force_max_n: float
    joint_torque_max_ratio: float
    limits_violated: list[str]

    def result(self) -> dict[str, Any]:
        """The judgement as plain data, for JSON; each group of figures stands beside the other keys."""
        data = asdict(self)
        groups = data.pop("figures")
        return {**data, **groups}


def judge(ticks: Ticks, brief: Brief) -> Judgement:
    """Judge a flight; of a log that was read back, by its messages and `brief_of` its metadata."""
    figures = {name: MEASURES[name](ticks, brief) for name in KINDS[brief.judged_as].measures}
    violated, truth = limits_violated(ticks, brief), ticks["truth"]
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
        joint_torque_max_ratio=float((np.abs(truth["tau"]) / tau_max).max()),
        limits_violated=violated,
    )


def _complaints(ticks: Ticks, brief: Brief, figures: dict[str, Figures], violated: list[str]) -> Iterator[str]:
    end, kind = end_of(ticks, brief), KINDS[brief.judged_as]
    if end != GOAL:
        # A mission that was stopped says where it stopped; how far it came before stands in the figures.
        yield _stopped(ticks, brief, end)
    else:
        if state_of(ticks, brief) != kind.state:
            yield f"ended in {end}, but {in_words(ticks, brief)}"
        yield from (words for name, words in kind.measures.items() if words and None in figures[name].values())
        yield from _exceeded(brief, figures)
    if violated:
        yield f"limits violated: {', '.join(violated)}"


def _stopped(ticks: Ticks, brief: Brief, end: str) -> str:
    now = in_words(ticks, brief)
    if end not in brief.finals:
        return f"still in phase {end} when the time was over: {now}"
    fault = brief.faults[int(ticks["mission"]["fault"][-1])]
    return stopped(end, last_flown(ticks, brief), fault, now, brief.timeouts)


def _exceeded(brief: Brief, figures: dict[str, Figures]) -> Iterator[str]:
    for name, bound, unit, meaning in (*brief.criteria, *KINDS[brief.judged_as].criteria):
        group, _, figure = NAMES.get(name, name).partition(".")
        value = figures[group][figure]
        if value is not None and value > bound:
            yield f"{meaning}: {value:.3g} {unit}, above {bound:g} {unit}"
