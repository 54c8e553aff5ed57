"""Which limits a flight exceeded, when and by how much: states by what was true in the plant, rates by what was sent to it.

A limiter that works violates nothing, whatever a sensor says; a plant that goes beyond a limit violates it, whatever it says.
"""

from collections import defaultdict
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.judge.brief import Brief, Ticks
from armland.experiments.judge.contacts import BEFORE_TICKS, Touch, falls, touches
from armland.experiments.judge.geometry import insides
from armland.experiments.judge.grip import loads, shear_ratio
from armland.experiments.judge.singularity import smallest_singular_values
from armland.rotations import Array

FALL_M = 0.1
"""Highest fall that a UAV may make."""

SINGULAR_TICKS = 5
"""The Jacobian is looked at this often: at 1 kHz and 2 rad/s a joint turns by 0.01 rad between."""


class Excess(NamedTuple):
    """Where a limit was exceeded, and the figures that say how."""

    where: NDArray[np.bool_]  # (k,)
    size: Array | None = None  # (k,), in `unit`
    unit: str = ""
    speed: Array | None = None  # (k,) m/s, of what touches


def excesses(ticks: Ticks, brief: Brief) -> dict[str, Excess]:
    """Each limit that was exceeded, of those that `brief` names.

    | name | limit | held against |
    |---|---|---|
    | `joint_position` | `q_min`, `q_max` (n,), rad | `truth.q` |
    | `joint_speed` | `qd_max` (n,), rad/s | how far `truth.q` moved in a tick |
    | `joint_torque` | `tau_max` (n,), N·m | `truth.tau`, which acted |
    | `torque_rate` | `torque_rate` (n,) or for all, N·m/s | `command.tau`, which was sent |
    | `singularity` | `sigma_min`, 1 | the Jacobian at `truth.q` |
    | `hinge_force` | `hinge_max`, N | `truth.hinge_force` |
    | `magnet_pull`, `magnet_shear` | `brief.hold` | see `grip` |
    | `arm_touched_…`, `plate_touched_…`, `uav_touched_…` | 0 N | see `contacts` |
    | `…_in_…` | 1 mm | the solids at `truth.q`, see `geometry` |
    | `uav_fell` | `FALL_M`, m | see `contacts.falls` |
    """
    found = {**_states(ticks, brief), **_grip(ticks, brief)}
    found |= {name: _touched(touch) for name, touch in touches(ticks, brief).items()}
    fell = falls(ticks, brief)
    found |= {name: Excess(inside.where, inside.depth, "mm") for name, inside in insides(ticks, brief).items()}
    found["uav_fell"] = Excess(fell > FALL_M, fell, "m")
    return {name: excess for name, excess in found.items() if excess.where.any()}


def limits_violated(ticks: Ticks, brief: Brief) -> list[str]:
    """Names of the limits that were exceeded, see `excesses`."""
    return list(excesses(ticks, brief))


def in_words(found: Mapping[str, Excess], ticks: Ticks, brief: Brief) -> str:
    """Names of the limits with phase, time, largest value and speed, in the order of their time."""
    first = {name: int(np.argmax(excess.where)) for name, excess in found.items()}
    return ", ".join(
        f"{name} ({_how(found[name], k, brief.phases[int(ticks['mission']['phase'][k])], brief)})"
        for name, k in sorted(first.items(), key=lambda item: item[1])
    )


def _how(excess: Excess, k: int, phase: str, brief: Brief) -> str:
    words = f"in {phase} at {k / brief.rate_hz:.2f} s"
    if excess.size is not None:
        size = float(excess.size[excess.where].max())
        words += f", up to {size:{'.0f' if size >= 10.0 else '.2g'}} {excess.unit}"
    if excess.speed is not None:
        words += f", at {float(excess.speed[max(k - BEFORE_TICKS, 0)]):.2f} m/s"
    return words


def _states(ticks: Ticks, brief: Brief) -> dict[str, Excess]:
    truth, k = ticks["truth"], len(ticks["truth"])
    most, least = defaultdict(lambda: np.inf, brief.limits), defaultdict(lambda: -np.inf, brief.limits)
    q, force = truth["q"], np.linalg.norm(truth["hinge_force"], axis=1)
    qd, rate = _rates(q, brief), np.abs(_rates(ticks["command"]["tau"], brief))
    singular = np.zeros(k, bool)
    if "sigma_min" in brief.limits:
        seen = smallest_singular_values(q[::SINGULAR_TICKS], brief.screws)
        singular[::SINGULAR_TICKS] = seen < brief.limits["sigma_min"]
    return {
        "joint_position": Excess(((q < least["q_min"]) | (q > most["q_max"])).any(axis=1)),
        "joint_speed": Excess((np.abs(qd) > most["qd_max"]).any(axis=1)),
        "joint_torque": Excess((np.abs(truth["tau"]) > most["tau_max"] * (1.0 + 1e-9)).any(axis=1)),
        "torque_rate": Excess((rate > most["torque_rate"] * 1.001).any(axis=1), rate.max(axis=1, initial=0.0), "N·m/s"),
        "singularity": Excess(singular),
        "hinge_force": Excess(force > most["hinge_max"], force, "N"),
    }


def _grip(ticks: Ticks, brief: Brief) -> dict[str, Excess]:
    if brief.hold is None:
        return {}
    pull, shear = loads(ticks)
    return {
        "magnet_pull": Excess(pull > brief.hold.share * brief.hold.rating_n, pull, "N"),
        "magnet_shear": Excess(shear_ratio(pull, shear, brief.hold) > brief.hold.share, shear, "N"),
    }


def _touched(touch: Touch) -> Excess:
    return Excess(touch.force > 0.0, touch.force, "N", touch.speed)


def _rates(values: Array, brief: Brief) -> Array:
    """How fast values (k, n) changed up to each tick, per s; 0 in the first one."""
    return np.diff(values, axis=0, prepend=values[:1]) * brief.rate_hz


def held_figures(ticks: Ticks, brief: Brief) -> dict[str, Any]:
    """Largest fall of the UAV, and largest loads of the magnet; None where there is no magnet."""
    out: dict[str, Any] = {"fall_m": float(falls(ticks, brief).max())}
    if brief.hold is None:
        return out | dict.fromkeys(("magnet_pull_max_n", "magnet_shear_max_n", "magnet_shear_max_ratio"))
    pull, shear = loads(ticks)
    most = {"magnet_pull_max_n": pull, "magnet_shear_max_n": shear}
    most["magnet_shear_max_ratio"] = np.minimum(shear_ratio(pull, shear, brief.hold), 1e3)
    return out | {name: float(values.max()) for name, values in most.items()}
