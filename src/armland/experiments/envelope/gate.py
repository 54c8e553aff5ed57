"""Landings as flown, with all imperfections: their state at the gate, to stand in the map beside the bounds."""

from typing import NamedTuple

import numpy as np

from armland.experiments.episode import fly
from armland.experiments.judge.brief import Ticks
from armland.experiments.judge.whereabouts import tilt_deg
from armland.models.capture import GATE_M
from armland.scenario import Scenario


class Flown(NamedTuple):
    """State at the gate of a landing."""

    seed: int
    offset: float  # m
    speed: float  # m/s, horizontal
    closing: float  # m/s
    tilt: float  # deg, of the UAV
    plate: float  # deg


def flown_landing(scenario: Scenario, seed: int) -> Flown | None:
    """A landing flown with `seed`; None where it never came to the gate."""
    episode = fly(scenario, "landing", seed)
    state = at_the_gate(episode.ticks, episode.metadata["phases"].split(",").index("close"))
    return None if state is None else Flown(seed, *state)


def at_the_gate(ticks: Ticks, close: int) -> tuple[float, float, float, float, float] | None:
    """Offset, speed, closing speed, UAV's and plate's tilt where a landing last passed the gate in its phase `close`; None if never."""
    truth, phase = ticks["truth"], ticks["mission"]["phase"]
    apart, v = truth["r"] - truth["ee"], truth["v"] - truth["ee_v"]
    passed = np.flatnonzero((apart[1:, 2] < GATE_M) & (apart[:-1, 2] >= GATE_M) & (phase[:-1] == close))
    if not len(passed):
        return None
    k = int(passed[-1]) + 1
    offset, speed = float(np.hypot(*apart[k, :2])), float(np.hypot(*v[k, :2]))
    return offset, speed, float(-v[k, 2]), float(tilt_deg(truth["quat"][k])), float(tilt_deg(truth["plate_quat"][k]))
