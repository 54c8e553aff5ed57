"""Wind that is known tick by tick before a flight: single gusts, and a recorded trace at the ticks of the run.

A recorded wind is taken as linear between its samples, and a tick has its mean over the tick. So nothing is added: the mean of a
tick is never beyond the samples around it, the variance never above theirs, and what is faster than a tick is averaged and not folded
down.
"""

from pathlib import Path

import numpy as np

from armland.plant.wind.profile import passing_speed, towards
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.environment import Gust
from armland.scenario.files.trace import read_trace


def timed_wind(scenario: Scenario) -> Array:
    """Gusts and recorded wind (k, 3), m/s, W, of each tick of the run; (0, 3) where there are none.

    Raises:
        ConfigurationError: a recorded wind that cannot be one.
    """
    air, run = scenario.air, scenario.run
    if not air.gusts and air.trace is None:
        return np.zeros((0, 3))
    ticks = round(run.duration_s * run.rate_hz)
    edges = np.arange(ticks + 1) / run.rate_hz
    out = np.zeros((ticks, 3))
    if air.trace is not None:
        out += resampled(*read_trace(Path(air.trace), run.duration_s), edges)
    for gust in air.gusts:
        along = towards(scenario) if gust.direction is None else np.array(gust.direction)
        out += gust_speed(gust, edges[:-1], passing_speed(scenario))[:, None] * along / np.linalg.norm(along)
    return out


def gust_speed(gust: Gust, times: Array, speed: float) -> Array:
    """Speed (k,), m/s, of a gust.

    Args:
        gust: which.
        times: (k,), s.
        speed: m/s, at which the field passes.
    """
    x = speed * (times - gust.at_s) / gust.length_m
    return np.where((x > 0.0) & (x < 1.0), 0.5 * gust.peak_mps * (1.0 - np.cos(2.0 * np.pi * x)), 0.0)


def resampled(times: Array, values: Array, edges: Array) -> Array:
    """Means (k, 3) between edges of what is linear between samples.

    Args:
        times: of the samples, (m,), s.
        values: (m, 3) m/s.
        edges: (k + 1,), s, within `times`.
    """
    steps = np.diff(times)[:, None]
    whole = np.vstack([np.zeros(values.shape[1]), np.cumsum(0.5 * steps * (values[1:] + values[:-1]), axis=0)])
    at = np.clip(np.searchsorted(times, edges, side="right") - 1, 0, len(times) - 2)
    past = (edges - times[at])[:, None]
    integral = whole[at] + past * values[at] + 0.5 * past**2 * (np.diff(values, axis=0) / steps)[at]
    return np.diff(integral, axis=0) / np.diff(edges)[:, None]
