"""What touched what that should not: arm, plate and UAV against cradle and floor, and from what height the UAV fell on it.

Two pairs are not recorded, because the plant has no such contact: a link of the arm with another one, and the plate with a link.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.judge.brief import Brief, Ticks
from armland.rotations import Array

FOUL = ("arm_touched_cradle", "arm_touched_floor", "arm_touched_uav", "plate_touched_cradle", "uav_touched_floor")
"""What each number of `truth.foul` is about."""

EARLY = "uav_touched_cradle"

BEFORE_TICKS = 2
"""Ticks before a contact's first force at which what meets has still the speed with which it meets."""


class Touch(NamedTuple):
    """Contact forces that are a fault, and how fast what touches is."""

    force: Array  # (k,) N; 0 where nothing is at fault
    speed: Array  # (k,) m/s


def touches(ticks: Ticks, brief: Brief) -> dict[str, Touch]:
    """Each kind of contact that no flight may have, by name."""
    truth = ticks["truth"]
    arm, uav = truth["ee_v"], truth["v"]
    speeds = (arm, arm, arm - uav, uav, uav)
    found = {
        name: Touch(truth["foul"][:, k], np.linalg.norm(v, axis=1))
        for k, (name, v) in enumerate(zip(FOUL, speeds, strict=True))
    }
    rails = np.linalg.norm(truth["cradle_force"], axis=1)
    return {**found, EARLY: Touch(np.where(may_touch(ticks, brief), 0.0, rails), np.linalg.norm(uav, axis=1))}


def may_touch(ticks: Ticks, brief: Brief) -> NDArray[np.bool_]:
    """Ticks (k,) in which rails may touch the UAV: those of the phases in `brief.on_cradle`, and of an end but `done`.

    A mission that ended early is a failure anyhow; where its UAV then is, `whereabouts` says.
    """
    allowed = [name in brief.on_cradle or (name in brief.finals and name != "done") for name in brief.phases]
    return np.array(allowed)[ticks["mission"]["phase"]]


def falls(ticks: Ticks, brief: Brief) -> Array:
    """Height (k,), m, v²/2g, of a fall from rest to the speed at which the UAV sinks where something stops it; 0 elsewhere.

    v is the sink speed of the UAV's centre of mass when rails, floor or arm begin to touch it. The last tick counts as one: a UAV
    that is still falling then has fallen.
    """
    truth = ticks["truth"]
    rails = np.linalg.norm(truth["cradle_force"], axis=1)
    touched = (rails > 0.0) | (truth["foul"][:, 2] > 0.0) | (truth["foul"][:, 4] > 0.0)
    stopped = np.flatnonzero(touched & ~np.append(False, touched[:-1]))
    out, sink = np.zeros(len(touched)), np.maximum(-truth["v_cm"][:, 2], 0.0)
    for k in (*stopped, len(touched) - 1):
        out[k] = sink[max(k - BEFORE_TICKS, 0) : k + 1].max() ** 2 / (2.0 * brief.gravity)
    return out
