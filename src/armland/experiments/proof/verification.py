"""The proof, run: does V₂ behave as (30) says on the UAV subsystem, and what is left of that on the demonstrator?"""

import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.experiments.paper import Verdict, fly_all, prepare, silent
from armland.experiments.proof.attribution import Loop, attribute, ledger
from armland.experiments.proof.cases import CASES, TOLERANCE, Case, Progress, parts, run_case
from armland.scenario import Scenario

SAMPLES, FEWER = 10_000, 10
"""States from which (29) starts under the paper's kinematics; the other cases get that many times fewer."""

RATE_GAP = 1e-9  # Largest gap between (30) and V̇₂ along the vector field, relative to the former
CLOSURE = 0.05  # Largest RMS of what the attribution leaves unexplained, relative to that of V₂'s measured rate


@dataclass(frozen=True)
class Proof:
    """Everything that came of a run of the proof."""

    cases: dict[str, Case]
    channels: dict[str, NDArray[np.void]]  # of `attribution.CHANNELS`, per experiment
    ledgers: dict[str, dict[str, Any]]  # of `ledger.ledger`, since the path's start
    start_s: float  # of the path, in the channels' time
    verdicts: list[Verdict]
    wall_s: float

    @property
    def holds(self) -> bool:
        """Whether every verdict holds."""
        return all(v.holds for v in self.verdicts)

    def result(self) -> dict[str, Any]:
        """The proof as plain data, for `result.json`."""
        return {
            "subsystem": {name: case.figures() for name, case in self.cases.items()},
            "demonstrator": self.ledgers,
            "verdicts": [asdict(v) for v in self.verdicts],
            "run": {"wall_s": self.wall_s, "integration_tolerance": TOLERANCE},
        }


def prove(scenario: Scenario, samples: int = SAMPLES, logs: Path | None = None, progress: Progress = silent) -> Proof:
    """Run the proof on the subsystem, then look for what is left of it on the demonstrator.

    Args:
        scenario: UAV, gains, seed; looks at its experiments with the paper's law and a quaternion PD on board.
        samples: states from which (29) starts under the paper's kinematics.
        logs: folder for one MCAP log per experiment; None keeps them in memory only.
        progress: called with (what, done, in all).

    Raises:
        ConfigurationError: no samples; gains or UAV parameters for which the proof does not hold.
    """
    if samples < 1:
        raise ConfigurationError(f"samples is {samples}; it must be at least 1, and {SAMPLES} is the default")
    begin = time.perf_counter()
    cases = {
        name: run_case(kind, scenario, samples if name == "paper" else -(-samples // FEWER), progress)
        for name, kind in CASES.items()
    }
    loops = {name: loop for name in sorted(scenario.experiments) if (loop := loop_of(scenario, name)) is not None}
    flown = fly_all(prepare(scenario, loops), logs, progress)
    channels = {name: attribute(flown[name].ticks, loop) for name, loop in loops.items()}
    start_s = max((leg["start_s"] for e in flown.values() for leg in json.loads(e.metadata["legs"])[:1]), default=0.0)
    ledgers = {name: ledger(c[c["t"] >= start_s]) for name, c in channels.items()}
    return Proof(cases, channels, ledgers, start_s, judge(cases, ledgers), time.perf_counter() - begin)


def loop_of(scenario: Scenario, experiment: str) -> Loop | None:
    """What stands between law and UAV in an experiment; None if its laws are others than those that V₂ speaks of."""
    e = scenario.experiments[experiment]
    onboard = e.onboard or scenario.onboard
    if e.law != "paper" or e.rule is not None or onboard.controller != "quaternion_pd":
        return None
    uav, gains, pd = parts(scenario.replaced({"onboard": onboard.model_dump()}))
    link, rate = scenario.link, scenario.run.rate_hz
    disturbance = np.array([*scenario.disturbance.force_n, *scenario.disturbance.torque_nm])
    way = np.array(link.torque_limit_nm), link.torque_effectiveness, round(1e-3 * link.uplink_delay_ms * rate)
    return Loop(uav, gains, pd, *way, rate, disturbance, scenario.environment.gravity_mps2)


def judge(cases: dict[str, Case], ledgers: dict[str, dict[str, Any]]) -> list[Verdict]:
    """Verdicts on the cases that are said to be proven, and on whether the attribution adds up.

    That V₂ rises on the demonstrator is reported and not judged: the demonstrator breaks the proof's assumptions.
    """
    verdicts = []
    for case in cases.values():
        if not case.kind.proven:
            continue
        name, figures = case.kind.title, case.figures()
        for claim, key, low, high in (
            ("the rate of V₂ is that of (30) (largest relative gap)", "rate_gap_largest", 0.0, RATE_GAP),
            (
                "V₂ never rises between sign changes of η_e (largest relative change)",
                "v2_rise_largest",
                -1.0,
                TOLERANCE,
            ),
            ("every state arrives (how many do not)", "not_arrived", 0.0, 0.0),
        ):
            verdicts.append(Verdict.within(f"{name}: {claim}", float(figures[key]), low, high))
    for name, book in ledgers.items():
        claim = f"{name}: (30) and the broken assumptions explain V₂'s rate (relative RMS of the rest)"
        verdicts.append(Verdict.within(claim, book["closure"], 0.0, CLOSURE))
    return verdicts
