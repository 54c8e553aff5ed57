"""The limits that were really exceeded, by what the plant did and not by what the controller flagged."""

import numpy as np

from armland.experiments.judge.brief import Brief, Ticks

TOUCHED = ("arm_touched_cradle", "arm_touched_floor", "arm_touched_uav")
"""What each number of `truth.foul` is about."""


def limits_violated(ticks: Ticks, brief: Brief) -> list[str]:
    """Names of the limits that were exceeded, of those that `brief.limits` names.

    | limit | unit |
    |---|---|
    | `q_min`, `q_max` (n,) | rad |
    | `qd_max` (n,) | rad/s |
    | `tau_max` (n,) | N·m |
    | `torque_rate` | N·m/s |
    | `sigma_min` | 1 |
    | `hinge_max` | N |
    """
    truth, bound = ticks["truth"], brief.limits
    tau, q, qd = truth["tau"], ticks["measurement"]["q"], ticks["measurement"]["qd"]
    exceeded = {
        "joint_position": "q_min" in bound and bool((q < bound["q_min"]).any() or (q > bound["q_max"]).any()),
        "joint_speed": "qd_max" in bound and bool((np.abs(qd) > bound["qd_max"]).any()),
        "joint_torque": "tau_max" in bound and bool((np.abs(tau) > bound["tau_max"] * (1.0 + 1e-9)).any()),
        # The torque that holds the arm up appears within the first tick, which no limit of the rate can see.
        "torque_rate": "torque_rate" in bound
        and bool(np.abs(np.diff(tau[2:], axis=0)).max(initial=0.0) * brief.rate_hz > bound["torque_rate"] * 1.001),
        "singularity": "sigma_min" in bound and bool((ticks["health"]["sigma_min"] < bound["sigma_min"]).any()),
        "hinge_force": "hinge_max" in bound
        and bool(np.linalg.norm(truth["hinge_force"], axis=1).max() > bound["hinge_max"]),
        **{name: bool(truth["foul"][:, k].any()) for k, name in enumerate(TOUCHED)},
    }
    return [name for name, is_so in exceeded.items() if is_so]
