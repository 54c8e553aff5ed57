"""How well a UAV on the hinge follows its path, from recorded ticks: always the truth against the reference."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from armland.experiments.judge.brief import Ticks
from armland.mission.reference.path import Leg
from armland.rotations import Array

MOVED_M = 1e-3  # A leg moves along an axis if its end points differ by more than this


@dataclass(frozen=True)
class Metrics:
    """Figures of one experiment; three values are x, y, z of the world."""

    attitude_max_deg: float
    attitude_rms_deg: float
    position_max_m: list[float]
    position_rms_m: list[float]
    overshoot_m: list[float]
    delta_tau_max_nm: float
    hinge_force_max_n: float


def measure(ticks: Ticks, legs: Sequence[Leg], rate_hz: int) -> Metrics:
    """Measure recorded `ticks` (of `tick_layout`) from the first leg's start to the end.

    `delta_tau_max_nm` is the largest component of Δτ_att that was asked for, before the UAV's own limit.
    """
    judged = slice(round(legs[0].start_s * rate_hz), None)
    truth, reference = ticks["truth"][judged], ticks["reference"][judged]
    attitude = np.rad2deg(deviation(truth["quat"], reference["quat"]))
    error = reference["r"] - truth["r"]
    return Metrics(
        attitude_max_deg=float(attitude.max()),
        attitude_rms_deg=float(np.sqrt(np.mean(attitude**2))),
        position_max_m=[float(x) for x in np.abs(error).max(axis=0)],
        position_rms_m=[float(x) for x in np.sqrt(np.mean(error**2, axis=0))],
        overshoot_m=[float(x) for x in overshoot(ticks["truth"]["r"], legs, rate_hz)],
        delta_tau_max_nm=float(np.abs(ticks["command"]["delta_tau"][judged]).max()),
        hinge_force_max_n=float(np.linalg.norm(truth["hinge_force"], axis=1).max()),
    )


def deviation(quat: Array, quat_d: Array) -> Array:
    """Rotation angle (k,), rad, between attitudes (k, 4) and desired attitudes (k, 4), each up to sign."""
    cosine = np.abs(np.sum(quat * quat_d, axis=1))
    # The sine from the difference of the nearer pair keeps its digits at small angles, where the cosine has lost them.
    sign = np.where(np.sum(quat * quat_d, axis=1) < 0.0, -1.0, 1.0)
    half_chord = 0.5 * np.linalg.norm(quat - sign[:, None] * quat_d, axis=1)
    return np.where(
        cosine > 0.5, 4.0 * np.arcsin(np.minimum(half_chord, 1.0)), 2.0 * np.arccos(np.minimum(cosine, 1.0))
    )


def overshoot(r: Array, legs: Sequence[Leg], rate_hz: int) -> Array:
    """Largest excursion (3,), m, of positions r (ticks, 3) beyond the end point of a leg, in its direction, per axis.

    A leg counts on the axes along which it moves, from its start to the start of the next.
    """
    largest = np.zeros(3)
    for leg in legs:
        during = r[round(leg.start_s * rate_hz) : round(leg.end_s * rate_hz)]
        if not len(during):
            # The record ends before this leg.
            break
        move = leg.target - leg.origin
        beyond = np.sign(move) * (during - leg.target)
        moved = np.abs(move) > MOVED_M
        largest[moved] = np.maximum(largest[moved], beyond.max(axis=0)[moved])
    return largest
