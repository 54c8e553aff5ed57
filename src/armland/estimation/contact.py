"""Who carries the UAV: magnet contact, shares of its weight, touchdown on the cradle, release; compiled.

| symbol | name | unit |
|---|---|---|
| F | `force` (3,) of the end effector on the UAV | N, world |
| m g | `weight` of the UAV | N |
| s_a = F_z/(m g) | `arm_share` | 1 |
| s_r = f_T b_z/(m g) | `rotor_share`: the thrust's vertical part | 1 |
| s_g = 1 − s_a − s_r | `ground_share`: what is left for cradle or ground | 1 |

The shares hold at rest: an upward acceleration of the UAV of 1 m/s² adds 0.1 to s_a + s_r, which the low pass and the triggers'
debouncing take out where it does not last.

A trigger switches on where its value has stayed above `on` for `on_ticks` ticks, and off where it has stayed below `off` for
`off_ticks`. Gaussian noise of standard deviation σ on each component of F exceeds `on` at a given tick with the probability
P(χ₃ > on/σ), whatever its correlation in time; each false alarm needs at least one such tick, hence a rate of at most P times the
tick rate (C.1).
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.records import Record
from armland.rotations import Array

TRIGGER = np.dtype([("on", "f8"), ("off", "f8"), ("on_ticks", "i8"), ("off_ticks", "i8")])
SWITCH = np.dtype([("active", "i8"), ("count", "i8")])  # count: ticks in a row that speak for switching over

PARAMETERS = np.dtype(
    [
        ("weight", "f8"),
        ("share_gain", "f8"),  # of the shares' low pass, per tick
        ("clearance", "f8"),  # m
        ("contact", TRIGGER),  # on |F|, N
        ("touchdown", TRIGGER),  # on s_g
        ("resting", TRIGGER),  # on s_g
        ("release", TRIGGER),  # on |F|, N; `off` and `off_ticks` count
    ]
)

MEMORY = np.dtype(
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

LOAD = np.dtype(
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


class Switching(NamedTuple):
    """Thresholds and debouncing of one trigger."""

    on: float
    off: float
    on_s: float
    off_s: float


class Contact(NamedTuple):
    """Settings; the thresholds are assumptions."""

    weight_n: float = 0.480 * 9.81
    share_time_s: float = 0.02
    """Time constant of the shares' low pass."""
    clearance_m: float = 0.01
    """Way back of the end effector after which a magnet without force has surely let go."""
    contact_n: Switching = Switching(0.6, 0.3, 0.005, 0.10)
    """|F|. The upper one is above what 1 m/s² of unmodelled acceleration makes of a tool of 0.3 kg."""
    touchdown: Switching = Switching(0.15, 0.05, 0.03, 0.10)
    """s_g."""
    resting: Switching = Switching(0.85, 0.70, 0.10, 0.05)
    """s_g."""
    release_n: Switching = Switching(0.6, 0.4, 0.0, 0.10)
    """|F|; above the magnet's residual force."""


def contact_parameters(settings: Contact, tick_s: float) -> NDArray[np.void]:
    """`PARAMETERS` (1,) for a loop with ticks of `tick_s` seconds.

    Raises:
        ValueError: a trigger whose upper threshold is not above its lower one.
    """
    p: NDArray[np.void] = np.zeros(1, PARAMETERS)
    p["weight"], p["clearance"] = settings.weight_n, settings.clearance_m
    p["share_gain"] = 1.0 - np.exp(-tick_s / settings.share_time_s)
    for name, s in (
        ("contact", settings.contact_n),
        ("touchdown", settings.touchdown),
        ("resting", settings.resting),
        ("release", settings.release_n),
    ):
        if not s.on > s.off:
            raise ValueError(f"trigger {name}: on = {s.on:g} must be above off = {s.off:g}")
        p[name] = (s.on, s.off, max(round(s.on_s / tick_s), 1), max(round(s.off_s / tick_s), 1))
    return p


def false_alarm_bound(threshold: float, sigma: float, rate_hz: float) -> float:
    """Most false contacts per second that noise of `sigma` N per component makes at `threshold` N. Source: (C.1)."""
    from scipy.special import gammaincc

    # The noise's length has a chi distribution of three degrees of freedom.
    return float(rate_hz * gammaincc(1.5, 0.5 * (threshold / sigma) ** 2))


def contact_threshold(sigma: float, rate_hz: float, alarms_per_s: float) -> float:
    """Lowest threshold, N, with at most `alarms_per_s` false contacts for noise of `sigma` N per component. Source: (C.1)."""
    from scipy.special import gammainccinv

    return float(sigma * np.sqrt(2.0 * gammainccinv(1.5, alarms_per_s / rate_hz)))


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
    magnet: bool,
    retreat: float,
    p_: NDArray[np.void],
    s_: NDArray[np.void],
    load_: NDArray[np.void],
) -> None:
    """One tick.

    Args:
        force: of the end effector on the UAV (3,), N, world, bias and tool removed.
        thrust_z: vertical part of the thrust that acts, as far as is known, N.
        magnet: whether the magnet is commanded on.
        retreat: how far the end effector has moved away since the magnet was switched off, m.
        p_: `PARAMETERS` (1,).
        s_: `MEMORY` (1,), zeros at first, updated.
        load_: `LOAD` (1,), written.
    """
    p, s, load = p_[0], s_[0], load_[0]
    gain = p.share_gain if s.begun else 1.0
    s.begun = 1
    s.arm_share += gain * (force[2] / p.weight - s.arm_share)
    s.rotor_share += gain * (thrust_z / p.weight - s.rotor_share)
    magnitude = np.sqrt(force[0] ** 2 + force[1] ** 2 + force[2] ** 2)
    load.arm_share, load.rotor_share = s.arm_share, s.rotor_share
    load.ground_share = 1.0 - s.arm_share - s.rotor_share
    load.contact = switched(magnitude, p.contact, s.contact)
    load.touchdown = switched(load.ground_share, p.touchdown, s.touchdown)
    load.resting = switched(load.ground_share, p.resting, s.resting)
    # No force alone proves nothing: a UAV that hovers on the magnet pulls at nothing either. The way back does.
    if magnet or retreat < p.clearance:
        s.held.active, s.held.count = 1, 0
    load.released = 1 - switched(magnitude, p.release, s.held)
