"""The paper's experiments E1, E2 and E3: flown, recorded, judged against the published figures."""

import os
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from armland.experiments import episode
from armland.experiments.episode import Episode, Flight
from armland.experiments.judge.brief import Brief, Ticks, brief_of
from armland.experiments.judge.tracking import Metrics, measure
from armland.mission.registry import MISSIONS
from armland.scenario import Scenario
from armland.scenario.arm import Arm

PUBLISHED: dict[str, Any] = {
    "E1": {"attitude_max_deg": 9.2},
    "E2": {"attitude_max_deg": 6.8},
    "statements": ["E2 overshoots less than E1", "E3 tracks z clearly better than E2"],
}
"""What the paper reports in numbers and in words."""

PAPER_ARM = Arm.model_fields["file"].default  # File of the arm that stands for the paper's
TOLERANCE = 0.10  # Relative tolerance on a published number
Z_RATIO = 0.5  # Largest ratio of E3's z RMS error to E2's that counts as clearly better
FOREIGN_RATIO = 1.0  # The same of another arm, of which the paper's words say that E3 is better, and not by how much
FITTED = " (to which `paper` is fitted)"  # Said of a claim that the calibration was made to meet
SHOWN = " (the paper's LWR; shown, not judged of another arm)"  # Said where another arm flies
UNBOUNDED = 1e9  # An upper bound from here on is none; JSON knows no infinity
Progress = Callable[[str, int, int], None]  # Called with (what, done, in all)


def silent(what: str, done: int, total: int) -> None:
    """The `Progress` of who wants to hear of none."""


@dataclass(frozen=True)
class Verdict:
    """A claim of the paper, the value found here, the bound it must keep, and whether it does; None: shown, not judged."""

    claim: str
    value: float
    bound: list[float]
    holds: bool | None

    @classmethod
    def within(cls, claim: str, value: float, low: float, high: float) -> "Verdict":
        """The verdict on a claim whose bounds belong to what holds; `UNBOUNDED` above is no bound."""
        return cls(claim, value, [low, high], bool(low <= value <= high))


@dataclass(frozen=True)
class Outcome:
    """Everything that came of a run of the experiments, and whether the paper's arm flew them."""

    episodes: dict[str, Episode]
    metrics: dict[str, Metrics]
    verdicts: list[Verdict]

    @property
    def reproduced(self) -> bool:
        """Whether every verdict that was judged holds."""
        return all(v.holds is not False for v in self.verdicts)

    def result(self) -> dict[str, Any]:
        """The outcome as plain data, for `result.json`."""
        results = [e.result for e in self.episodes.values()]
        simulated, wall = (sum(r[key] for r in results) for key in ("simulated_s", "wall_s"))
        ticks = sum(len(e.ticks) for e in self.episodes.values())
        run = {"ticks": ticks, "simulated_s": simulated, "wall_s": wall, "real_time_factor": simulated / wall}
        return {**_result(self.metrics, self.verdicts), "run": run}


def prepare(scenario: Scenario, names: Iterable[str] | None = None) -> dict[str, Flight]:
    """The scenario's experiments, or those of them that are named, ready to fly.

    Raises:
        ConfigurationError: what is refused before anything moves.
    """
    return {
        name: episode.prepare(scenario, name)
        if name in MISSIONS
        else episode.prepare(scenario, "track", experiment=name)
        for name in (sorted(scenario.experiments) if names is None else names)
    }


def run_experiments(flights: Mapping[str, Flight], logs: Path | None = None, progress: Progress = silent) -> Outcome:
    """Fly what was prepared and judge it.

    Args:
        flights: of `prepare`.
        logs: folder for one MCAP log per experiment; None keeps the ticks in memory only.
        progress: called with (experiment, flights done, flights in all).
    """
    episodes = fly_all(flights, logs, progress)
    metrics = {name: metrics_of(e) for name, e in episodes.items()}
    return Outcome(
        episodes, metrics, judge(metrics, {brief_of(e.metadata).arm for e in episodes.values()} == {PAPER_ARM})
    )


def fly_all(flights: Mapping[str, Flight], logs: Path | None = None, progress: Progress = silent) -> dict[str, Episode]:
    """Fly what was prepared over the threads of this process; arguments as for `run_experiments`."""

    def one(name: str) -> Episode:
        return episode.fly_prepared(flights[name], None if logs is None else logs / f"{name}.mcap")

    episodes = {}
    with ThreadPoolExecutor(os.cpu_count() or 1, "experiment") as pool:
        for done, (name, flown) in enumerate(zip(flights, pool.map(one, flights), strict=True)):
            episodes[name] = flown
            progress(name, done + 1, len(flights))
    return episodes


def metrics_of(flown: Episode) -> Metrics:
    """Figures of merit of an episode that followed a path."""
    return Metrics(**flown.judgement.figures["tracking"])


class Resting(NamedTuple):
    """How a UAV on the hinge rests: of the last second of its flight."""

    swing_deg: float  # Largest deviation of the attitude from its mean: a limit cycle does not rest
    error_m: float  # Largest mean position error of an axis
    tilt_deg: float  # Mean attitude error


def resting(flown: Episode) -> Resting:
    """How the flight ends."""
    last = flown.ticks[-round(1e9 / int(flown.metadata["period_ns"])) :]
    tilt = np.rad2deg(2.0 * last["truth"]["quat"][:, 1:])
    error = last["truth"]["r"] - last["reference"]["r"]
    return Resting(
        float(np.linalg.norm(tilt - tilt.mean(axis=0), axis=1).max()),
        float(np.abs(error.mean(axis=0)).max()),
        float(np.linalg.norm(tilt.mean(axis=0))),
    )


def judged(runs: Mapping[str, tuple[Ticks, Brief]]) -> dict[str, Any]:
    """The result of experiments whose logs were read back: by name, their ticks and what the judge is told of them."""
    metrics = {name: measure(ticks, brief.legs, brief.rate_hz) for name, (ticks, brief) in runs.items()}
    return _result(metrics, judge(metrics, {brief.arm for _, brief in runs.values()} == {PAPER_ARM}))


def _result(metrics: Mapping[str, Metrics], verdicts: list[Verdict]) -> dict[str, Any]:
    return {
        "experiments": {name: asdict(m) for name, m in metrics.items()},
        "published": PUBLISHED,
        "verdicts": [asdict(v) for v in verdicts],
    }


def judge(metrics: Mapping[str, Metrics], own: bool = True) -> list[Verdict]:
    """The verdicts that the experiments present allow.

    Args:
        metrics: by experiment.
        own: whether the paper's arm flew. Of another one its two angles say nothing: what the paper claims of any arm is judged.
    """
    verdicts = []
    for name in ("E1", "E2"):
        if name in metrics:
            verdicts.append(_angle(name, metrics[name].attitude_max_deg, own))
    if {"E1", "E2"} <= metrics.keys():
        for axis, one, two in zip("xyz", metrics["E1"].overshoot_m, metrics["E2"].overshoot_m, strict=True):
            # What does not overshoot cannot do so less.
            claim, less = f"E2 overshoots less than E1 in {axis} (m)", two < one or one == two == 0.0
            verdicts.append(Verdict(claim, two, [0.0, one], bool(less)))
    if {"E2", "E3"} <= metrics.keys():
        ratio = metrics["E3"].position_rms_m[2] / metrics["E2"].position_rms_m[2]
        claim = f"E3 tracks z {'clearly ' if own else ''}better than E2 (RMS ratio; follows the thrust asked)"
        verdicts.append(Verdict.within(claim, ratio, 0.0, Z_RATIO if own else FOREIGN_RATIO))
    return verdicts


def _angle(name: str, found: float, own: bool) -> Verdict:
    published = PUBLISHED[name]["attitude_max_deg"]
    claim = f"{name} deviates up to {published}° in attitude{FITTED if own else SHOWN}"
    verdict = Verdict.within(claim, found, published * (1.0 - TOLERANCE), published * (1.0 + TOLERANCE))
    return verdict if own else replace(verdict, holds=None)
