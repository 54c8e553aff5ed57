"""Desired path of the pivot: point-to-point moves with rests, septic in time, so that r_d(t) is C³ throughout."""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.mission.reference.septic import septic
from armland.records import Record
from armland.rotations import Array
from armland.scenario.mission import Trajectory


class Leg(NamedTuple):
    """One move in time: it starts at `start_s`, arrives at `arrive_s`, and rests until `end_s`."""

    start_s: float
    arrive_s: float
    end_s: float
    origin: Array  # (3,) m, deck
    target: Array  # (3,) m, deck


def legs(trajectory: Trajectory, start: Array, settle_s: float, tail_s: float) -> list[Leg]:
    """The moves of a trajectory from `start` (3,) m; the first begins after `settle_s`, the last rests `tail_s` longer."""
    t, here, out = settle_s, np.array(start, dtype=float), []
    for i, move in enumerate(trajectory.moves):
        target = np.asarray(start) + move.to_m
        rest = move.rest_s + (tail_s if i == len(trajectory.moves) - 1 else 0.0)
        arrive = t + move.duration_s
        out.append(Leg(t, arrive, arrive + rest, here, target))
        t, here = arrive + rest, target
    return out


def sample(path: list[Leg], rate_hz: int) -> Array:
    """r_d, ṙ_d and r̈_d at each tick, (ticks, 9), m, m/s, m/s², deck. Before the first leg it rests at its origin."""
    times = np.arange(round(path[-1].end_s * rate_hz)) / rate_hz
    out = np.zeros((len(times), 9))
    out[:, :3] = path[0].origin
    for leg in path:
        duration = leg.arrive_s - leg.start_s
        moving = (times >= leg.start_s) & (times < leg.arrive_s)
        shape = np.array([septic(u, duration) for u in (times[moving] - leg.start_s) / duration]).reshape(-1, 3)
        for k in range(3):
            out[moving, 3 * k : 3 * k + 3] = np.outer(shape[:, k], leg.target - leg.origin)
        out[moving, :3] += leg.origin
        out[times >= leg.arrive_s, :3] = leg.target
    return out


@njit(cache=True)
def follow(path: Array, tick: int, r: Record) -> float:
    """Fill r_d, ṙ_d, r̈_d of the reference from row `tick` of `path` (k, 9); past its end the last row holds.

    Returns how far along the path the tick is, 0 to 1.
    """
    last = path.shape[0] - 1
    row = min(tick, last)
    for i in range(3):
        r.r[i], r.v[i], r.a[i] = path[row, i], path[row, 3 + i], path[row, 6 + i]
    return float(row / max(last, 1))
