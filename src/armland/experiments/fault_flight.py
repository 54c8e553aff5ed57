"""A trial flown, and what every trial has to show whatever failed: nobody falls, nothing jumps, the arm comes to rest."""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.fault_trials import Mission, Trial
from armland.experiments.landing_branch import Branches
from armland.experiments.landing_judge import Judgement, tilt_deg
from armland.mission.landing_scenario import landing_scenario
from armland.mission.supervisor import FAULTS

SEED = 1

REST_M, BALANCED_M = 0.002, 0.010
"""Way of the end effector in the last half second in which it counts as at rest; in which it balances a UAV."""

FALL_MPS = 1.2
"""Downward speed that the landing's judge calls a fall."""


class Flight(NamedTuple):
    """A trial as flown."""

    trial: Trial
    records: NDArray[np.void]
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


@cache
def branches(mission: Mission) -> Branches:
    """The mission without faults."""
    return Branches(landing_scenario("landing", {"seed": SEED}), mission)


def fly_trial(trial: Trial, blind_to: tuple[str, ...] = ()) -> Flight:
    """Fly a trial; `blind_to` switches off the supervisor's eye for those faults."""
    base = branches(trial.mission)
    records, judgement = base.fly(trial.faults, blind_to)
    names, phases = base.setup.table.names, base.setup.phases
    first = trial.faults[0]
    begin = base.starts[str(first.phase)].tick + round(first.after_s * base.rate)
    phase = records["mission"]["phase"]
    edges = np.flatnonzero(np.diff(phase)) + 1
    ends = [int(k) for k in edges if phases[int(phase[k])].final and k >= begin]
    fault = records["mission"]["fault"]
    found = list(dict.fromkeys(FAULTS[int(k)] for k in fault[begin:] if k))
    last = trial.faults[-1]
    acted = base.starts[str(last.phase)].tick + round(last.after_s * base.rate)
    truth = records["truth"][begin:]
    after = records["truth"]["r"][ends[0] if ends else begin :, 2]
    return Flight(
        trial,
        records,
        judgement,
        begin,
        [names[int(phase[k])] for k in ends],
        found or ["none"],
        (ends[-1] - (acted if len(trial.faults) > 1 and ends[-1] > acted else begin)) / base.rate if ends else np.inf,
        float(max(-truth["v"][:, 2].min(), 0.0)),
        float(max(after[0] - after.min(), 0.0)),
        float(tilt_deg(truth["quat"]).max()),
        float(np.linalg.norm(truth["hinge_force"], axis=1).max()),
    )


def unsafe(flight: Flight) -> list[str]:
    """What a trial must not show, in words; empty where all is well."""
    base = branches(flight.trial.mission)
    r, p, arm, rate = flight.records, base.setup.parameters[0], base.setup.arm, base.rate
    late, end = r[-rate // 2 :], base.setup.phases[int(r["mission"]["phase"][-1])]
    tau = r["command"]["tau"]
    why = []
    if not np.isfinite(tau).all() or not np.isfinite(r["command"]["thrust"]).all():
        why.append("a command is not a finite number")
    if flight.judgement.state == "lost" or flight.sink_mps > FALL_MPS:
        why.append(f"the UAV fell or is out of control ({flight.sink_mps:.2f} m/s downwards)")
    if (np.abs(tau) > arm.tau_max * (1.0 + 1e-9)).any():
        why.append("a joint torque beyond its limit")
    if np.abs(np.diff(tau[1:], axis=0)).max() > 1.001 * p["torque_rate"] * p["tick_s"]:
        why.append("a joint torque jumped")
    if np.ptp(late["truth"]["ee"], axis=0).max() > (BALANCED_M if end.arm == "balance" else REST_M):
        why.append("the arm does not come to rest")
    if (np.abs(late["command"]["tau"]).max(axis=1) < 1.0).any():
        why.append("the arm has no torque")
    if end.arm == "brake":
        if not late["command"]["brake"].all():
            why.append("the brakes are not on")
        if np.ptp(late["command"]["tau"], axis=0).max() > 0.5:
            why.append("a law runs on behind the brakes")
    if late["command"]["magnet"].max() != late["command"]["magnet"].min() or late["command"]["magnet"][0] != (
        1 if end.magnet == "on" else 0
    ):
        why.append("the magnet does not do what the end says")
    if flight.judgement.state == "held" and end.magnet == "on" and not late["command"]["magnet"].all():
        why.append("held without a magnet")
    return why
