"""Balancing a UAV without thrust on its hinge by moving the pivot, as one balances a broomstick; compiled.

| symbol | name | unit, frame |
|---|---|---|
| θ, θ̇ | `tilt`, `tilt_rate` (2,): horizontal part of the body's z axis, about the angle to the vertical; its rate | 1, 1/s, world |
| x, ẋ | `sway`, `sway_v` (2,): pivot's way from its anchor | m, m/s, world |
| u | `push` (2,): the pivot's acceleration, what is commanded | m/s², world |
| ω₀ | `fall_rate`: √(m g l/(J + m l²)) | rad/s |
| ξ | capture point, as an angle | 1 |
| k_x, k_v, k_θ, k_ω | `BalanceGains` | 1/s², 1/s, m/s², m/s |

About each horizontal axis (J + m l²) θ̈ = m g l θ − m l ẍ, so

    θ̈ = ω₀² (θ − u/g)                                        (B.1)
    ξ = θ + θ̇/ω₀,  ξ̇ = ω₀ (ξ − u/g)                          (B.2)

ξ is the part of the motion that grows: without a push it is multiplied by e every 1/ω₀. Feedback of the whole state,

    u = k_x x + k_v ẋ + k_θ θ + k_ω θ̇                        (B.3)

gives s⁴ + (ω₀²k_ω/g − k_v) s³ + (ω₀²k_θ/g − k_x − ω₀²) s² + ω₀² k_v s + ω₀² k_x, so that four wanted poles with the polynomial
s⁴ + a₃s³ + a₂s² + a₁s + a₀ take

    k_x = a₀/ω₀²,  k_v = a₁/ω₀²,  k_ω = (a₃ + k_v) g/ω₀²,  k_θ = (a₂ + k_x + ω₀²) g/ω₀²      (B.4)

The attitude arrives T late, carried on to the present with its rates: θ_c. What the pivot did since is known, and so, by (B.1),

    Δ = ω₀² (T θ_c − (ẋ(t) − ẋ(t − T))/g),  θ̇ ≈ θ̇(t − T) + Δ,  θ ≈ θ_c + ½ T Δ        (B.5)

All four gains are positive: a pivot that stands too far to one side first moves further out, and the body leans back.

Assumptions: small angles, the same inertia about both axes, the body's spin about its z axis of no consequence.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.control.backstepping import GRAVITY, UavParameters
from armland.control.margins import Loop, pendulum
from armland.errors import ConfigurationError
from armland.rotations import Array

POLES = (2.0, 1.5, 2.0 / 3.0, 2.0 / 3.0)
"""Wanted poles over −ω₀: two that right the body as fast as the arm's delays allow, two that bring the pivot back."""


class BalanceGains(NamedTuple):
    """Gains of (B.3)."""

    position: float
    speed: float
    tilt: float
    tilt_rate: float


def fall_rate(uav: UavParameters) -> float:
    """ω₀, rad/s, of a body whose pivot is below its centre of mass, by the mean of its two axes.

    Raises:
        ConfigurationError: a body that hangs from its pivot needs no balancing.
    """
    swung, fall = np.mean([pendulum(axis, uav) for axis in range(2)], axis=0)
    if fall <= 0.0:
        raise ConfigurationError(f"the pivot lies {uav.lever[2]:g} m above the centre of mass; it must lie below it")
    return float(np.sqrt(fall / swung))


def balance_gains(rate: float, poles: tuple[float, ...] = POLES) -> BalanceGains:
    """Gains of (B.3) for ω₀ = `rate`, rad/s, and four poles at −ω₀ times `poles`. Source: (B.4)."""
    a3, a2, a1, a0 = np.poly(-rate * np.asarray(poles))[1:]
    w2 = rate**2
    position, speed = a0 / w2, a1 / w2
    tilt, tilt_rate = (a2 + position + w2) * GRAVITY / w2, (a3 + speed) * GRAVITY / w2
    return BalanceGains(float(position), float(speed), float(tilt), float(tilt_rate))  # (B.4)


def balance_loop(gains: BalanceGains, rate: float, delay: float, arm: float = 0.0, predicts: bool = True) -> Loop:
    """Loop of (B.1) under (B.3), broken at u.

    Args:
        gains: of `balance_gains`.
        rate: ω₀, rad/s.
        delay: T of (B.5), s.
        arm: by which the arm's push is later than (B.5) takes it to be, s.
        predicts: with (B.5), or with attitude and rates as they arrive.
    """
    k, w2 = gains, rate**2
    pivot: Array = -np.polymul([k.speed, k.position], [1.0, 0.0, -w2]).astype(np.float64)
    denominator = np.array([1.0, 0.0, -w2, 0.0, 0.0])
    if not predicts:
        plain = np.array([k.tilt_rate, k.tilt, 0.0, 0.0]) * w2 / GRAVITY
        return Loop((pivot, plain), (0.0, arm + delay), denominator)
    carried, step = np.array([delay, 1.0]), k.tilt_rate + 0.5 * delay * k.tilt
    late = np.polyadd(np.array([k.tilt_rate, 0.0]), (k.tilt + step * w2 * delay) * carried)
    body: Array = np.polymul(late, [1.0, 0.0, 0.0]).astype(np.float64) * w2 / GRAVITY
    known: Array = step * w2 / GRAVITY * np.array([1.0, 0.0, -w2, 0.0])
    return Loop((pivot, body, known, -known), (0.0, arm + delay, 0.0, delay), denominator)  # (B.5)


@njit(cache=True)
def lean_of(quat: Array, omega: Array) -> tuple[float, float, float, float]:
    """θ_x, θ_y, θ̇_x, θ̇_y of an attitude (4,), world<-body, and an angular velocity (3,), rad/s, body."""
    a, b, c, d = quat[0], quat[1], quat[2], quat[3]
    # d(R e₃)/dt = R (ω × e₃), and ω × e₃ = (ω_y, −ω_x, 0).
    x_rate = (1.0 - 2.0 * (c * c + d * d)) * omega[1] - 2.0 * (b * c - a * d) * omega[0]
    y_rate = 2.0 * (b * c + a * d) * omega[1] - (1.0 - 2.0 * (b * b + d * d)) * omega[0]
    return 2.0 * (b * d + a * c), 2.0 * (c * d - a * b), x_rate, y_rate


@njit(cache=True)
def capture_angle(quat: Array, omega: Array, rate: float) -> float:
    """|ξ| of both axes together. Source: (B.2)."""
    x, y, x_rate, y_rate = lean_of(quat, omega)
    return float(np.hypot(x + x_rate / rate, y + y_rate / rate))  # (B.2)


@njit(cache=True)
def predicted(tilt: float, tilt_rate: float, gained: float, delay: float, rate: float) -> tuple[float, float]:
    """θ and θ̇ now of θ_c and a rate `delay` s old, the pivot having `gained` m/s since. Source: (B.5)."""
    change = rate * rate * (delay * tilt - gained / GRAVITY)
    return tilt + 0.5 * delay * change, tilt_rate + change  # (B.5)


@njit(cache=True)
def push(
    tilt: float, tilt_rate: float, sway: float, sway_v: float, gains: BalanceGains, strongest: float, reach: float
) -> float:
    """Acceleration of the pivot along one axis, m/s²: (B.3) within what the arm gives.

    Args:
        tilt: θ.
        tilt_rate: θ̇, 1/s.
        sway: x, m.
        sway_v: ẋ, m/s.
        gains: of `balance_gains`.
        strongest: largest acceleration, m/s².
        reach: largest |x|, m, before which there must be room to stop.
    """
    u = gains.position * sway + gains.speed * sway_v + gains.tilt * tilt + gains.tilt_rate * tilt_rate  # (B.3)
    u = min(max(u, -strongest), strongest)
    # Braking begins where half of the strongest push is just enough to stop in time.
    ahead = sway_v * sway_v / strongest
    if sway_v > 0.0 and sway + ahead > reach:
        u = min(u, -0.5 * strongest)
    elif sway_v < 0.0 and sway - ahead < -reach:
        u = max(u, 0.5 * strongest)
    return u
