"""A trial flown, and what every trial has to show whatever failed: nobody falls, nothing jumps, the arm comes to rest."""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.episode import prepare
from armland.experiments.judge.judgement import Judgement, judge
from armland.experiments.judge.whereabouts import FALL_MPS, tilt_deg
from armland.experiments.snapshot import Run, Snapshot
from armland.mission.supervisor.table import FAULTS
from armland.mission.table.phases import Phase
from armland.scenario import Scenario, load_scenario
from armland.scenario.faults import Fault
from pages.trials import Trial

SEED = 1

REST_M, BALANCED_M = 0.002, 0.010
"""Displacement of the end effector in the last half second in which it counts as at rest; in which it balances a UAV in still air.
In gusts it goes with them, within its reach."""


class Flight(NamedTuple):
    """A trial as flown."""

    trial: Trial
    ticks: NDArray[np.void]
    judgement: Judgement
    begin: int
    """Tick at which the first failure began."""
    ends: list[str]
    """Final phases that it went through."""
    found: list[str]
    """Faults that the supervisor named."""
    reaction_s: float
    """From the last failure that changed anything to the end that it led to."""
    sink_mps: float
    """Largest downward speed of the UAV after the failure."""
    drop_m: float
    """How far the pivot went below where it was, before it stood or was carried on by a moving arm: highest point to lowest after
    the first end."""
    tilt_deg: float
    force_n: float


class Branches:
    """A mission flown once without faults, kept at the begin of each phase, and flown on from there with them.

    Args:
        scenario: its own faults are left out.
        mission: name of the mission.

    Raises:
        ConfigurationError: what is refused before anything moves.
    """

    def __init__(self, scenario: Scenario, mission: str) -> None:
        flight = prepare(scenario.replaced({"faults": ()}), mission)
        self.run, self.plan, self.rate = Run(flight), flight.plan, scenario.run.rate_hz
        self.names: tuple[str, ...] = self.plan.names
        self.phases: tuple[Phase, ...] = self.plan.phases
        self.brief = flight.brief
        start = self.run.keep()
        self.ticks, _ = self.run.advance(self.plan.ticks)
        begins: dict[str, int] = {}
        for k in (0, *(np.flatnonzero(np.diff(self.ticks["mission"]["phase"])) + 1).tolist()):
            begins.setdefault(self.names[int(self.ticks["mission"]["phase"][k])], k)
        self.begins = begins
        """Tick at which each phase first began."""
        self.run.restore(start)
        _, kept = self.run.advance(max(begins.values()), frozenset(begins.values()))
        self.starts: dict[str, Snapshot] = {name: kept[k] for name, k in begins.items()}

    def fly(self, failures: tuple[Fault, ...], blind_to: tuple[str, ...] = ()) -> tuple[NDArray[np.void], Judgement]:
        """Ticks and judgement of the mission with `failures`, flown on from the begin of the first one's phase.

        Args:
            failures: what fails; none in a phase that is over by then.
            blind_to: faults that the supervisor shall not see; for negative controls.
        """
        start = self.starts[failures[0].phase or self.names[0]]
        self.run.restore(start)
        self.run.fail(failures)
        for name in blind_to:
            self.run.controller.board["table"]["faults"][:, FAULTS.index(name)] = -1
        flown, _ = self.run.advance(self.plan.ticks)
        # As bytes: NumPy joins structured arrays field by field.
        ticks = np.frombuffer(self.ticks[: start.tick].tobytes() + flown.tobytes(), flown.dtype)
        return ticks, judge(ticks, self.brief)


@cache
def branches(mission: str, seed: int = SEED, level: str = "nominal") -> Branches:
    """The mission without faults, its plant at a level of deviations."""
    scenario = load_scenario("landing", {"deviation": {"level": level}, "run": {"seed": seed}})
    return Branches(scenario, mission)


def fly_trial(trial: Trial, blind_to: tuple[str, ...] = (), base: Branches | None = None) -> Flight:
    """Fly a trial; `blind_to` switches off the supervisor's eye for those faults; `base` if absent the nominal mission."""
    base = base or branches(trial.mission)
    ticks, judgement = base.fly(trial.faults, blind_to)
    first, last = (
        base.begins[str(f.phase)] + round(f.after_s * base.rate) for f in (trial.faults[0], trial.faults[-1])
    )
    phase, fault, truth = ticks["mission"]["phase"], ticks["mission"]["fault"][first:], ticks["truth"]
    edges = np.flatnonzero(np.diff(phase)) + 1
    ends = [int(k) for k in edges if base.phases[int(phase[k])].final and k >= first]
    acted = last if len(trial.faults) > 1 and ends and ends[-1] > last else first
    height, since = truth["r"][ends[0] if ends else first :, 2], truth[first:]
    return Flight(
        trial,
        ticks,
        judgement,
        first,
        [base.names[int(phase[k])] for k in ends],
        list(dict.fromkeys(FAULTS[int(k)] for k in fault if k)) or ["none"],
        (ends[-1] - acted) / base.rate if ends else np.inf,
        float(max(-since["v"][:, 2].min(), 0.0)),
        float(max(height[0] - height.min(), 0.0)),
        float(tilt_deg(since["quat"]).max()),
        float(np.linalg.norm(since["hinge_force"], axis=1).max()),
    )


def unsafe(flight: Flight, base: Branches | None = None) -> list[str]:
    """What a trial must not show, in words; empty where all is well. `base` as in `fly_trial`."""
    base, ticks = base or branches(flight.trial.mission), flight.ticks
    late, end = ticks[-base.rate // 2 :], base.phases[int(ticks["mission"]["phase"][-1])]
    tau, limits, magnet = ticks["command"]["tau"], base.brief.limits, late["command"]["magnet"]
    still = base.run.scenario.deviation.level == "nominal"
    rest = REST_M if end.arm != "balance" else BALANCED_M if still else base.run.scenario.limits.balance_reach_m
    jump = 1.001 * limits["torque_rate"] / base.rate
    shown = {
        "a command is not a finite number": not (
            np.isfinite(tau).all() and np.isfinite(ticks["command"]["thrust"]).all()
        ),
        f"the UAV fell or is out of control ({flight.sink_mps:.2f} m/s downwards)": flight.judgement.state == "lost"
        or flight.sink_mps > FALL_MPS,
        "a joint torque beyond its limit": (np.abs(tau) > limits["tau_max"] * (1.0 + 1e-9)).any(),
        "a joint torque jumped": (np.abs(np.diff(tau[1:], axis=0)) > jump).any(),
        "the arm does not come to rest": np.ptp(late["truth"]["ee"], axis=0).max() > rest,
        "the arm has no torque": (np.abs(late["command"]["tau"]).max(axis=1) < 1.0).any(),
        "the brakes are not on": end.arm == "brake" and not late["command"]["brake"].all(),
        "a law runs on behind the brakes": end.arm == "brake" and np.ptp(late["command"]["tau"], axis=0).max() > 0.5,
        "the magnet does not do what the end says": np.any(magnet != (end.magnet == "on")),
        "held without a magnet": flight.judgement.state == "held" and end.magnet == "on" and not magnet.all(),
    }
    return [words for words, is_so in shown.items() if is_so]
