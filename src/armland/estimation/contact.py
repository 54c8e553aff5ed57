"""Who carries the UAV: magnet contact, shares of its weight, touchdown on the cradle, release; compiled.

| symbol | name | unit |
|---|---|---|
| F | `force` (3,) of the end effector on the UAV | N, D |
| m g | `weight` of the UAV | N |
| s_a = F_z/(m g) | `arm_share` | 1 |
| s_r = f_T b_z/(m g) | `rotor_share`: the thrust's vertical part | 1 |
| s_g = 1 − s_a − s_r | `ground_share`: what is left for cradle or ground | 1 |

The shares are exact at rest only: an upward acceleration of the UAV of 1 m/s² adds 0.1 to s_a + s_r. The low pass and the triggers'
debouncing remove that where it does not last.

A trigger switches on where its value has stayed above `on` for `on_ticks` ticks, and off where it has stayed below `off` for
`off_ticks`. Gaussian noise of standard deviation σ on each component of F exceeds `on` at a given tick with the probability
P(χ₃ > on/σ), whatever its correlation in time; each false alarm needs at least one such tick, hence a rate of at most P times the
tick rate.
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.records import Record, Records
from armland.rotations import Array
from armland.scenario import Scenario

TRIGGER = np.dtype([("on", "f8"), ("off", "f8"), ("on_ticks", "i8"), ("off_ticks", "i8")])
SWITCH = np.dtype([("active", "i8"), ("count", "i8")])  # count: ticks in a row that speak for switching over


@lru_cache
def told_layout() -> np.dtype:
    """What `detect` is told."""
    return np.dtype(
        [
            ("share_gain", "f8"),  # of the shares' low pass, per tick
            ("clearance", "f8"),  # m
            ("contact", TRIGGER),  # on |F|, N
            ("touchdown", TRIGGER),  # on s_g
            ("resting", TRIGGER),  # on s_g
            ("release", TRIGGER),  # on |F|, N; `off` and `off_ticks` count
        ]
    )


@lru_cache
def kept_layout() -> np.dtype:
    """What it keeps; zeros at first."""
    return np.dtype(
        [
            ("begun", "i8"),
            ("arm_share", "f8"),
            ("rotor_share", "f8"),
            ("contact", SWITCH),
            ("touchdown", SWITCH),
            ("resting", SWITCH),
            ("held", SWITCH),
        ]
    )


@lru_cache
def load_layout() -> np.dtype:
    """Who carries the UAV, as `detect` finds it."""
    return np.dtype(
        [
            ("arm_share", "f8"),
            ("rotor_share", "f8"),
            ("ground_share", "f8"),
            ("contact", "i8"),  # end effector and UAV push or pull each other
            ("touchdown", "i8"),  # cradle or ground has begun to carry
            ("resting", "i8"),  # cradle or ground carries nearly all
            ("released", "i8"),  # magnet off, end effector away, no force left
        ]
    )


def told(scenario: Scenario) -> Records:
    """The record (1,) of `told_layout` for the settings of a scenario."""
    c, tick_s = scenario.estimation.contact, 1.0 / scenario.run.rate_hz
    p: Records = np.zeros(1, told_layout())
    p["clearance"] = c.clearance_m
    p["share_gain"] = 1.0 - np.exp(-tick_s / c.share_s)
    for name, t in (
        ("contact", c.contact_n),
        ("touchdown", c.touchdown),
        ("resting", c.resting),
        ("release", c.release_n),
    ):
        p[name] = (t.on, t.off, max(round(t.on_s / tick_s), 1), max(round(t.off_s / tick_s), 1))
    return p


@njit(cache=True)
def switched(value: float, trigger: Record, switch: Record) -> int:
    """One tick of a trigger: its state, 0 or 1, after `value`; `switch` is updated."""
    against = value < trigger.off if switch.active else value > trigger.on
    switch.count = switch.count + 1 if against else 0
    if switch.count >= (trigger.off_ticks if switch.active else trigger.on_ticks):
        switch.active, switch.count = 1 - switch.active, 0
    return switch.active


@njit(cache=True)
def detect(
    force: Array,
    thrust_z: float,
    weight: float,
    magnet: bool,
    retreat: float,
    p: Record,
    s: Record,
    load: Record,
) -> None:
    """One tick.

    Args:
        force: of the end effector on the UAV (3,), N, D, bias and tool removed.
        thrust_z: vertical part of the thrust that acts, as far as is known, N.
        weight: of all that flies, N.
        magnet: whether the magnet is commanded on.
        retreat: how far the end effector has moved away since the magnet was switched off, m.
        p: of `told_layout`.
        s: of `kept_layout`, updated.
        load: of `load_layout`, written.
    """
    gain = p.share_gain if s.begun else 1.0
    s.begun = 1
    s.arm_share += gain * (force[2] / weight - s.arm_share)
    s.rotor_share += gain * (thrust_z / weight - s.rotor_share)
    magnitude = np.sqrt(force[0] ** 2 + force[1] ** 2 + force[2] ** 2)
    load.arm_share, load.rotor_share = s.arm_share, s.rotor_share
    load.ground_share = 1.0 - s.arm_share - s.rotor_share
    load.contact = switched(magnitude, p.contact, s.contact)
    load.touchdown = switched(load.ground_share, p.touchdown, s.touchdown)
    load.resting = switched(load.ground_share, p.resting, s.resting)
    # A force of zero does not prove the release: a UAV that hovers on the magnet exerts none either. The retreat does.
    if magnet or retreat < p.clearance:
        s.held.active, s.held.count = 1, 0
    load.released = 1 - switched(magnitude, p.release, s.held)
