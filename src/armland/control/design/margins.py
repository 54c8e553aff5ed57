"""The loops that delay and rotor lag can break, and their gain, phase and delay margins. Not compiled: called once.

| symbol | name | unit |
|---|---|---|
| L(s) | `Loop`, broken where the torque (the force) acts | 1 |
| T, τ | `delays.attitude`, `delays.position`; `delays.rotor_lag` | s |
| φ, r | tilt; pivot's position across it | rad, m |
| A = K₁/4 | `rate`: what K₁ of the attitude is at small angles | 1/s |
| λ = −ρ_z | `arm`: height of the CM above the pivot | m |
| J + mλ², m g λ | `swung`, `fall`: inertia and falling torque per angle about a pivot at rest | kg·m², N·m/rad |

Left out of the loops: products of inertia, parts of the lever across z. The thrust cancels.
"""

from typing import NamedTuple

import numpy as np

from armland.control.laws.backstepping import spring_and_damper
from armland.control.laws.rigid_body import BacksteppingGains, ExactGains, UavParameters
from armland.models.environment import STANDARD_GRAVITY
from armland.rotations import Array

_FREQUENCY = np.geomspace(1e-2, 1e4, 2001)  # rad/s


class Delays(NamedTuple):
    """Pure delays of the attitude and position feedback, there and back plus half a sample period, and the rotors' lag, s."""

    attitude: float
    position: float
    rotor_lag: float


class Margins(NamedTuple):
    """What a loop bears: factors on its gain, 1; phase, rad; added delay, s; and its largest sensitivity |1/(1 + L)|, 1.

    Of an unstable loop gains and phase are NaN, the sensitivity is infinite, and the delay is negative: what is too much.
    """

    gain_down: float
    gain_up: float
    phase: float
    delay: float
    sensitivity: float


class Loop(NamedTuple):
    """L(s) = Σ numerator(s) e^(−s delay) / denominator(s), strictly proper; polynomials, highest power first."""

    numerators: tuple[Array, ...]
    delays: tuple[float, ...]
    denominator: Array


def attitude_loops(gains: BacksteppingGains | ExactGains, uav: UavParameters, delays: Delays) -> tuple[Loop, ...]:
    """Loops of `exact_law` about roll, pitch and yaw, broken at its torque; its force acts at once.

    Source: (X.1) and (11), linearised about a reference at rest.
    """
    # Roll moves the pivot along y, pitch along x; yaw moves it nowhere.
    return tuple(_attitude_loop(axis, position, gains, uav, delays) for axis, position in ((0, 4), (1, 3), (2, 5)))


def onboard_loops(
    kp: Array, kd: Array, uav: UavParameters, delays: Delays, feed_forward: float | None = None
) -> tuple[Loop, ...]:
    """Loops of a PD on board, kp, kd (3,), about roll, pitch and yaw, with the pivot at rest.

    Args:
        kp: N·m/rad.
        kd: N·m·s/rad.
        uav: rigid body.
        delays: `attitude` is the delay on board.
        feed_forward: delay, s, of −ρ × (RᵀF) where it is made on the ground with the attitude received, which closes a
            second loop. None: it is made of reference values, or not at all.

    Source: (X.6).
    """
    loops = []
    for axis in range(3):
        swung, fall = pendulum(axis, uav)
        numerators, times = [np.array([kd[axis], kp[axis]])], [delays.attitude]
        if feed_forward is not None:
            # The hinge's moment on the body is (fall − mλ² s²) φ; the feed-forward takes it away, but late.
            numerators.append(np.array([uav.inertia[axis, axis] - swung, 0.0, fall]))
            times.append(feed_forward)
        body = np.array([swung, 0.0, -fall])
        loops.append(Loop(tuple(numerators), tuple(times), np.polymul(body, np.array([delays.rotor_lag, 1.0]))))
    return tuple(loops)


def position_loop(gains: BacksteppingGains | ExactGains, uav: UavParameters, delays: Delays) -> Loop:
    """Loop of the position along x, broken at the force, attitude held. Source: (33)."""
    stiffness, damping = spring_and_damper(uav, BacksteppingGains(gains.k1, gains.k2, gains[-1]))
    return Loop((np.array([damping[0], stiffness[0]]),), (delays.position,), np.array([uav.mass, 0.0, 0.0]))


def pendulum(axis: int, uav: UavParameters) -> tuple[float, float]:
    """Inertia, kg·m², about a pivot at rest and the torque per angle, N·m/rad, with which the body falls off it."""
    arm = -uav.lever[2] if axis < 2 else 0.0
    return float(uav.inertia[axis, axis] + uav.mass * arm**2), float(uav.mass * STANDARD_GRAVITY * arm)


def margins(loop: Loop) -> Margins:
    """Margins of a loop, each for a change of this kind alone; `sensitivity` bounds them together."""
    if not stable(loop):
        return Margins(np.nan, np.nan, np.nan, -_excess(loop), np.inf)
    numerator, denominator = _sampled(loop)
    L = numerator / denominator
    phase = np.pi + np.unwrap(np.angle(L))
    crossover = _zeros(np.abs(L) - 1.0)
    lead = np.interp(crossover, _FREQUENCY, phase) % (2.0 * np.pi)
    real = np.interp(_zeros(L.imag), _FREQUENCY, L.real)
    if loop.denominator[-1] != 0.0:
        real = np.append(real, sum(n[-1] for n in loop.numerators) / loop.denominator[-1])
    factor = -1.0 / real[real < 0.0]
    return Margins(
        gain_down=float(np.max(factor[factor < 1.0], initial=0.0)),
        gain_up=float(np.min(factor[factor > 1.0], initial=np.inf)),
        phase=float(np.min(np.minimum(lead, 2.0 * np.pi - lead), initial=np.pi)),
        delay=float(np.min(lead / crossover, initial=np.inf)),
        sensitivity=sensitivity(loop),
    )


def sensitivity(loop: Loop) -> float:
    """Largest |1/(1 + L)|, infinite where the closed loop is unstable."""
    numerator, denominator = _sampled(loop)
    return float(np.max(np.abs(denominator / (numerator + denominator)))) if stable(loop) else np.inf


def stable(loop: Loop) -> bool:
    """Whether all closed-loop poles are in the left half plane: (d + n)/(s + c)ᵏ then does not turn about the origin.

    Source: Mikhailov's criterion, which holds with delays in n where n/d is strictly proper.
    """
    numerator, denominator = _sampled(loop)
    order = len(loop.denominator) - 1
    turned = np.unwrap(np.angle((numerator + denominator) / (1j * _FREQUENCY + 10.0) ** order))
    return bool(abs(turned[-1]) < 1.0 and abs(turned[0]) < 1.0)


def _attitude_loop(
    axis: int, position: int, gains: BacksteppingGains | ExactGains, uav: UavParameters, delays: Delays
) -> Loop:
    """One loop of `attitude_loops` from the states φ, φ̇, r, ṙ of CM and their rates under force and torque: (11), (X.1), linearised."""
    m, J = uav.mass, uav.inertia[axis, axis]
    arm = -uav.lever[2] if axis < 2 else 0.0
    rate, K1, K2, k3 = gains.k1[axis] / 4.0, gains.k1[position], gains.k2[position], gains[-1]
    # ṙ = v + λ φ̇, and the law's force and torque per state, without the thrust's part, which the body's own takes away.
    push = np.array([K2 * rate, m * rate + K2, 0.0, 0.0]) * arm
    push -= np.array([0.0, (m * K1 + K2) * arm, K1 * K2 + k3, m * K1 + K2])
    torque = -arm * push - np.array([arm * m * STANDARD_GRAVITY, 0.0, arm * k3, 0.0])
    torque -= np.array([gains.k2[axis] * rate + gains[2] / 4.0, J * rate + gains.k2[axis], 0.0, 0.0])
    plant = np.zeros((4, 4))
    plant[0, 1] = plant[2, 3] = 1.0
    plant[2, 1] = arm
    plant[1] = arm * (push + np.array([m * STANDARD_GRAVITY, 0.0, 0.0, 0.0])) / J
    plant[3] = push / m
    opened = np.poly(plant)
    plant[1] += torque / J
    numerator = np.poly(plant) - opened
    return Loop((numerator[1:],), (delays.attitude,), np.polymul(opened, [delays.rotor_lag, 1.0]))


def _sampled(loop: Loop) -> tuple[Array, Array]:
    """Numerator with its delays and denominator, both over the leading coefficient, at s = jω."""
    s = 1j * _FREQUENCY
    terms = [np.polyval(n, s) * np.exp(-s * t) for n, t in zip(loop.numerators, loop.delays, strict=True)]
    # A lag of zero leaves a zero in front.
    lead = loop.denominator[np.flatnonzero(loop.denominator)[0]]
    return sum(terms) / lead, np.polyval(loop.denominator, s) / lead


def _zeros(values: Array) -> Array:
    """Frequencies, rad/s, at which `values` change sign, between the samples by a straight line."""
    i = np.flatnonzero(np.signbit(values[:-1]) != np.signbit(values[1:]))
    share = values[i] / (values[i] - values[i + 1])
    return _FREQUENCY[i] + share * (_FREQUENCY[i + 1] - _FREQUENCY[i])


def _excess(loop: Loop) -> float:
    """Time, s, by which all delays of an unstable loop have to become shorter, none below zero; infinite: no delay will do."""

    def shortened(by: float) -> Loop:
        return loop._replace(delays=tuple(max(t - by, 0.0) for t in loop.delays))

    little, enough = 0.0, max(loop.delays)
    if not stable(shortened(enough)):
        return np.inf
    for _ in range(40):
        middle = 0.5 * (little + enough)
        little, enough = (little, middle) if stable(shortened(middle)) else (middle, enough)
    return enough
