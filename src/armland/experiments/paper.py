"""The paper's experiments E1, E2 and E3: run, record, judge against the published figures."""

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armland.experiments.assembly import Workplace, assemble
from armland.experiments.metrics import Metrics, measure
from armland.runtime.loop import run_loop
from armland.runtime.recorder import Recorder
from armland.scenario import Scenario

PUBLISHED: dict[str, Any] = {
    "E1": {"attitude_max_deg": 9.2},
    "E2": {"attitude_max_deg": 6.8},
    "statements": [
        "E2 overshoots less than E1",
        "E3 tracks z clearly better than E2",
    ],
}
"""What the paper reports in numbers and in words."""

TOLERANCE = 0.10
"""Relative tolerance on a published number."""

Z_RATIO = 0.5
"""Largest ratio of E3's z RMS error to E2's that counts as clearly better."""


@dataclass(frozen=True)
class Verdict:
    """A claim of the paper, the value found here, the bound it must keep, and whether it does."""

    claim: str
    value: float
    bound: list[float]
    holds: bool


@dataclass(frozen=True)
class Outcome:
    """Everything that came of a run of the experiments."""

    metrics: dict[str, Metrics]
    verdicts: list[Verdict]
    ticks: int
    simulated_s: float
    wall_s: float
    records: dict[str, NDArray[np.void]]

    @property
    def reproduced(self) -> bool:
        """Whether every verdict holds."""
        return all(v.holds for v in self.verdicts)

    def result(self) -> dict[str, Any]:
        """The outcome as plain data, for `result.json`."""
        return {
            "experiments": {name: asdict(m) for name, m in self.metrics.items()},
            "published": PUBLISHED,
            "verdicts": [asdict(v) for v in self.verdicts],
            "run": {
                "ticks": self.ticks,
                "simulated_s": self.simulated_s,
                "wall_s": self.wall_s,
                "real_time_factor": self.simulated_s / self.wall_s,
            },
        }


def warm_up(scenario: Scenario, workplace: Workplace) -> None:
    """Run one tick, so that the laws are compiled before anything is timed."""
    plant, controller, tick = assemble(scenario, sorted(scenario.experiments)[0], workplace)
    plant.connect()
    plant.read(tick)
    controller.update(tick)
    plant.command(tick)


def run_experiments(
    scenario: Scenario,
    workplace: Workplace,
    logs: Path | None = None,
    scenario_text: str = "",
    progress: Callable[[str, int, int], None] | None = None,
) -> Outcome:
    """Run every experiment of a scenario and judge them.

    Args:
        scenario: what to run.
        workplace: its survey.
        logs: folder for one MCAP log per experiment; None keeps them in memory only.
        scenario_text: attached to the logs.
        progress: called with (experiment, ticks done, ticks in all).
    """
    metrics: dict[str, Metrics] = {}
    records: dict[str, NDArray[np.void]] = {}
    rate, ticks, wall = scenario.run.rate_hz, len(workplace.path), 0.0
    for name in sorted(scenario.experiments):
        plant, controller, tick = assemble(scenario, name, workplace)
        file = None if logs is None else logs / f"{name}.mcap"
        metadata = {"experiment": name, "seed": str(scenario.run.seed), "title": scenario.title}
        report = None if progress is None else _reporter(progress, name, ticks)
        period_ns = round(1e9 / rate)
        with Recorder(file, tick, period_ns, metadata, scenario=scenario_text, keep_in_memory=True) as recorder:
            wall += run_loop(plant, controller, recorder, tick, range(ticks), report)
            begin = time.perf_counter()
        wall += time.perf_counter() - begin
        records[name] = recorder.ticks
        metrics[name] = measure(records[name], workplace.legs, rate)
        if report is not None:
            report(ticks)
    total = ticks * len(metrics)
    return Outcome(metrics, judge(metrics), total, total / rate, wall, records)


def _reporter(progress: Callable[[str, int, int], None], name: str, ticks: int) -> Callable[[int], None]:
    return lambda done: progress(name, done, ticks)


def judge(metrics: dict[str, Metrics]) -> list[Verdict]:
    """The verdicts that the experiments present allow."""
    verdicts = []
    for name in ("E1", "E2"):
        if name in metrics:
            published = PUBLISHED[name]["attitude_max_deg"]
            value = metrics[name].attitude_max_deg
            bound = [published * (1.0 - TOLERANCE), published * (1.0 + TOLERANCE)]
            claim = f"{name} deviates up to {published}° in attitude"
            verdicts.append(Verdict(claim, value, bound, bool(bound[0] <= value <= bound[1])))
    if {"E1", "E2"} <= metrics.keys():
        for axis, one, two in zip("xyz", metrics["E1"].overshoot_m, metrics["E2"].overshoot_m, strict=True):
            verdicts.append(Verdict(f"E2 overshoots less than E1 in {axis} (m)", two, [0.0, one], bool(two < one)))
    if {"E2", "E3"} <= metrics.keys():
        ratio = metrics["E3"].position_rms_m[2] / metrics["E2"].position_rms_m[2]
        verdicts.append(
            Verdict(
                "E3 tracks z clearly better than E2 (RMS ratio)",
                ratio,
                [0.0, Z_RATIO],
                bool(ratio <= Z_RATIO),
            )
        )
    return verdicts
