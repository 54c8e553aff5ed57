"""Gains by rule: from wanted bandwidth and damping ratio to K₁, K₂, k₃ of (X.1) and to a PD on board (X.6).

About a reference at rest `exact_law` makes of each axis a spring and a damper, in position and, with A = K₁/4, in attitude:
m r̈_e + (mK₁ + K₂) ṙ_e + (K₁K₂ + k₃) r_e = 0 and J φ̈ + (JA + K₂) φ̇ + (AK₂ + k₃/4) φ = 0.
Three gains make two coefficients. The third is spent on the proof: with the poles given, V₂ decays fastest, at twice
min(K₁, K₂/m), where K₁ = K₂/m. That needs ζ < 1; above it k₃ gets `LEAST_SHARE` of the stiffness.

| symbol | name | unit |
|---|---|---|
| ω_n, ζ | `bandwidth`, `damping` of `Wanted` | rad/s, 1 |
| k_p, k_d | `kp`, `kd` (3,), spring and damper of the attitude | N·m/rad, N·m·s/rad |
| K₁, K₂, k₃ | `gains` | as in `control.laws.rigid_body` |
| T, τ | `delays.attitude`, `delays.rotor_lag` | s |

Not compiled: called once. The margins behind every refusal are those of `margins`.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from armland.control.design.margins import (
    Delays,
    Loop,
    Margins,
    attitude_loops,
    margins,
    onboard_loops,
    pendulum,
    position_loop,
    sensitivity,
)
from armland.control.laws.rigid_body import BacksteppingGains, ExactGains, UavParameters, check
from armland.errors import ConfigurationError
from armland.rotations import Array

MAX_SENSITIVITY = 2.5
"""Largest |1/(1 + L)| accepted: leaves 23° of phase and a gain free to rise by 1.67 or fall to 0.71, or more."""

LEAST_SHARE = 0.04
"""Least share of k₃ in the stiffness; the published gains have 0.037. k₃ ties the attitude to the position error."""

DERIVATIVE_LAG_S = 0.01
"""Low pass of the derivative with which a cascade on board makes up for rotor lag, s."""

_LONGEST = 0.5  # s, longest delay searched for what a bandwidth allows

Loops = Callable[[float, float], tuple[Loop, ...]]
"""The loops that a rule makes for a bandwidth, rad/s, and a delay, s; none where it has no gains to offer."""


class Wanted(NamedTuple):
    """Two poles: natural frequency, rad/s, and damping ratio."""

    bandwidth: float
    damping: float


class Design(NamedTuple):
    """What a rule found."""

    gains: ExactGains
    """For `exact_law`."""
    kp: Array
    """Attitude's spring (3,), N·m/rad: what a PD on board needs to be the attitude feedback of `gains`."""
    kd: Array
    """Its damper (3,), N·m·s/rad."""
    attitude: tuple[Margins, ...]
    """Margins about roll, pitch and yaw."""
    position: Margins
    """Margins of the position, the same along each axis."""


def rule(position: Wanted, attitude: Wanted, uav: UavParameters, delays: Delays) -> Design:
    """Gains of `exact_law` that sends all its torque over the link: `delays.attitude` and the rotor lag lie in the loop.

    The axis of least inertia gets the attitude's bandwidth, the others the same stiffness and damping ratio.

    Source: (X.1), linearised; the rule is ours.

    Raises:
        ConfigurationError: a value out of its range, or a bandwidth that a delay does not allow, with what it allows.
    """
    _check(position, attitude, uav, delays)
    inertia = np.diag(uav.inertia)

    def pd(bandwidth: float) -> tuple[Array, Array]:
        # One k₃ serves all axes of the attitude, so they share a stiffness and not a bandwidth.
        kp = np.full(3, inertia.min() * bandwidth**2)
        return kp, 2.0 * attitude.damping * np.sqrt(inertia * kp)

    def loops(bandwidth: float, delay: float) -> tuple[Loop, ...]:
        return attitude_loops(exact_gains(position, *pd(bandwidth), uav), uav, delays._replace(attitude=delay))

    setting = f"behind a rotor lag of {1e3 * delays.rotor_lag:.3g} ms"
    _accept("attitude", setting, attitude.bandwidth, delays.attitude, loops, "or keep the feedback on board")
    return _design(position, *pd(attitude.bandwidth), uav, delays, loops(attitude.bandwidth, delays.attitude))


def onboard_rule(
    position: Wanted, attitude: Wanted, uav: UavParameters, delays: Delays, feed_forward: float | None = None
) -> Design:
    """Gains of a PD on board under rotor lag, with the pivot held, and those of `exact_law` that count on the same PD.

    Body, rotors and PD have three poles: the wanted pair, on all axes, and −(1/(τ + T) − 2ζω_n). Bandwidths above
    1/(3ζ(τ + T)) are refused: there the third pole is no faster than the pair, and kp − fall has its maximum. Refused too is
    one so low that kp, most of which then holds the pendulum, differs too much between tilt and yaw for one k₃.

    Args:
        position: wanted poles of the pivot's position.
        attitude: wanted poles.
        uav: rigid body.
        delays: `attitude` is the delay on board, at least half its sample period.
        feed_forward: its delay, s, as in `onboard_loops`.

    Source: (X.6); the rule is ours.

    Raises:
        ConfigurationError: as for `rule`.
    """
    _check(position, attitude, uav, delays)

    def loops(bandwidth: float, delay: float) -> tuple[Loop, ...]:
        lag = delays.rotor_lag + delay
        kp, kd = _placed(attitude._replace(bandwidth=bandwidth), uav, lag)
        third_pole_leads = 3.0 * attitude.damping * bandwidth * lag <= 1.0 + 1e-9
        if not third_pole_leads or _split(np.diag(uav.inertia), kp, kd)[2] >= kp.min():
            return ()
        return onboard_loops(kp, kd, uav, delays._replace(attitude=delay), feed_forward)

    setting = f"on board behind a rotor lag of {1e3 * delays.rotor_lag:.3g} ms"
    otherwise = "or compensate the rotor lag"
    if feed_forward is not None:
        setting += f", beside a feed-forward that is {1e3 * feed_forward:.3g} ms late"
        otherwise = "or make the feed-forward of reference values"
    _accept("attitude", setting, attitude.bandwidth, delays.attitude, loops, otherwise)
    pd = _placed(attitude, uav, delays.rotor_lag + delays.attitude)
    return _design(position, *pd, uav, delays, loops(attitude.bandwidth, delays.attitude))


def exact_gains(position: Wanted, kp: Array, kd: Array, uav: UavParameters) -> ExactGains:
    """Gains of `exact_law` for poles of the position and spring and damper kp, kd (3,) of the attitude.

    Source: (X.1), linearised.

    Raises:
        ConfigurationError: no single k₃ serves the three axes of the attitude.
    """
    inertia, mass = np.diag(uav.inertia), np.full(3, uav.mass)
    stiffness = mass * position.bandwidth**2
    rate, k2_attitude, share = _split(inertia, kp, kd)
    K1, K2, k3_position = _split(mass, stiffness, 2.0 * position.damping * np.sqrt(mass * stiffness))
    if share >= kp.min():
        raise ConfigurationError(
            f"kp {kp.round(3).tolist()} N·m/rad and kd {kd.round(4).tolist()} N·m·s/rad leave no gains of the law: its one "
            f"k3_attitude serves all axes only if the least kp is above {share:.3g}; damp more or bring the axes closer"
        )
    return ExactGains(np.append(4.0 * rate, K1), np.append(k2_attitude, K2), 4.0 * share, k3_position)


def _split(mass: Array, spring: Array, damper: Array) -> tuple[Array, Array, float]:
    """K₁, K₂ (3,) and k₃ with mK₁ + K₂ = damper, K₁K₂ + k₃ = spring, and the largest min(K₁, K₂/m) that one k₃ allows."""
    k3 = max(LEAST_SHARE * float(spring.max()), float(np.max(spring - damper**2 / (4.0 * mass))))
    half = damper / (2.0 * mass)
    apart = np.sqrt(np.maximum(half**2 - (spring - k3) / mass, 0.0))
    return half - apart, mass * (half + apart), k3


def _placed(wanted: Wanted, uav: UavParameters, lag: float) -> tuple[Array, Array]:
    """kp, kd (3,) that give (J's² − fall)(lag s + 1) + kd s + kp, with J', fall of `pendulum`, the wanted pair of roots."""
    w, decay = wanted.bandwidth, 2.0 * wanted.damping * wanted.bandwidth
    swung, fall = np.array([pendulum(axis, uav) for axis in range(3)]).T
    kp = fall + swung * w**2 * (1.0 - lag * decay)
    kd = lag * fall + swung * (lag * w**2 + decay * (1.0 - lag * decay))
    return kp, kd


def _design(
    position: Wanted, kp: Array, kd: Array, uav: UavParameters, delays: Delays, attitude: tuple[Loop, ...]
) -> Design:
    def loops(bandwidth: float, delay: float) -> tuple[Loop, ...]:
        gains = exact_gains(position._replace(bandwidth=bandwidth), kp, kd, uav)
        return (position_loop(gains, uav, delays._replace(position=delay)),)

    _accept("position", "through the arm", position.bandwidth, delays.position, loops, "")
    (held,) = loops(position.bandwidth, delays.position)
    return Design(exact_gains(position, kp, kd, uav), kp, kd, tuple(map(margins, attitude)), margins(held))


def _accept(what: str, setting: str, bandwidth: float, delay: float, loops: Loops, otherwise: str) -> None:
    """Refuse a bandwidth without loops, or with one more sensitive than `MAX_SENSITIVITY`; say what would be accepted."""

    def fits(bandwidth: float, delay: float) -> bool:
        made = loops(bandwidth, delay)
        return bool(made) and all(sensitivity(loop) <= MAX_SENSITIVITY for loop in made)

    if fits(bandwidth, delay):
        return
    tried = np.geomspace(0.5, 500.0, 61)
    good = [b for b in tried if fits(b, delay)]
    advice = [f"no bandwidth from {tried[0]:g} to {tried[-1]:g} rad/s is feasible at this delay"]
    if good:
        low, high = (_edge(lambda b: fits(b, delay), b, b * step) for b, step in ((good[0], 0.8), (good[-1], 1.25)))
        advice = [f"feasible at this delay are {low:.3g} to {high:.3g} rad/s"]
    longest = _edge(lambda t: fits(bandwidth, t), 0.0, _LONGEST) if fits(bandwidth, 0.0) else 0.0
    advice.append(f"at this bandwidth at most {1e3 * longest:.3g} ms" if longest else "and no delay at this bandwidth")
    raise ConfigurationError(
        f"{what} bandwidth {bandwidth:.3g} rad/s is not feasible with a delay of {1e3 * delay:.3g} ms {setting}: no gains "
        f"make it with |1/(1 + L)| below {MAX_SENSITIVITY:g}; " + ", ".join(filter(None, [*advice, otherwise]))
    )


def _edge(fits: Callable[[float], bool], good: float, bad: float) -> float:
    """Last value between `good` and `bad` that fits."""
    for _ in range(20):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if fits(middle) else (good, middle)
    return good


def _check(position: Wanted, attitude: Wanted, uav: UavParameters, delays: Delays) -> None:
    check(uav, BacksteppingGains(np.ones(6), np.ones(6), 1.0))
    for what, wanted in (("position", position), ("attitude", attitude)):
        for name, value in wanted._asdict().items():
            if not (np.isfinite(value) and value > 0.0):
                raise ConfigurationError(f"{what} {name} is {value}; it must be a finite number above 0")
    for name, value in delays._asdict().items():
        if not 0.0 <= value <= _LONGEST:
            raise ConfigurationError(f"delays.{name} is {value} s; it must be from 0 to {_LONGEST} s")
