"""What a seed draws of the ranges of `[deviation]`: each from a stream of its own, so that one range moves no other's number."""

import numpy as np

from armland.models.airframe.size import size_of
from armland.plant.noise import stream
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.deviation import ranges, rows
from armland.scenario.deviation.spread import Spread

GROWS = {
    "uav.cm_m": "reach",
    "hinge.friction_nm": "mass",
    "hinge.damping_nms": "mass",
    "hinge.stiffness_nm": "mass",
    "magnet.residual_n": "rating",
    "wrench.drift_nps": "mass",
    "wrench.drift_nmps": "mass",
}
"""Ranges in metres and newtons that stand for the AR.Drone's parts: with which ratio of `airframe.size` smaller ones shrink."""

Values = dict[str, Array]
"""Deviations that are not zero, by `device.key`: arrays in the unit of the key, one number for each part that deviates by itself."""


def drawn(scenario: Scenario, joints: int) -> Values:
    """The deviations of the scenario's seed for an arm with `joints` joints.

    Twice a range is twice the number that is drawn of it, so a margin can be searched for along the range.
    """
    sizes = {row.path: row.told.size for row in rows()}
    out = {}
    for path, spread in ranges(scenario.deviation).items():
        size = joints if sizes[path] == "n" else int(sizes[path])
        out[path] = share_of(path, scenario) * _draw(spread, stream(scenario.run.seed, f"deviation.{path}"), size)
    return out


def share_of(path: str, scenario: Scenario) -> float:
    """Share of the published range of `path` that counts for the scenario's UAV: below 1 for one smaller than the AR.Drone."""
    device, entry = path.split(".")
    if path not in GROWS or getattr(getattr(scenario.deviation, device), entry) is not None:
        return 1.0
    return min(float(getattr(size_of(scenario), GROWS[path])), 1.0)


def direction(seed: int) -> Array:
    """Horizontal direction (3,) of the mean wind of `seed`, W, 1."""
    angle = stream(seed, "deviation.air.direction").uniform(-np.pi, np.pi)
    return np.array([np.cos(angle), np.sin(angle), 0.0])


def _draw(spread: Spread, generator: np.random.Generator, size: int) -> Array:
    middle, half = 0.5 * (spread.low + spread.high), 0.5 * (spread.high - spread.low)
    if spread.normal:
        return middle + half * np.clip(0.5 * generator.standard_normal(size), -1.0, 1.0)
    uniform = generator.uniform(-1.0, 1.0, size)
    return middle + half * (np.sign(uniform) if spread.ends else uniform)
