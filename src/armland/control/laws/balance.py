"""Balancing a UAV without thrust on its hinge by moving the pivot, as one balances a broomstick; compiled.

| symbol | name | unit, frame |
|---|---|---|
| θ, θ̇ | `tilt`, `tilt_rate`: horizontal part of the body's z axis, about the angle to the vertical; its rate | 1, 1/s, D |
| x, ẋ | `sway`, `sway_v`: pivot's displacement from its anchor | m, m/s, D |
| u | `push`: the pivot's acceleration, what is commanded | m/s², D |
| ω₀ | `rate`: √(m g l/(J + m l²)) | rad/s |
| ξ | capture point, as an angle | 1 |
| k_x, k_v, k_θ, k_ω | `BalanceGains` | 1/s², 1/s, m/s², m/s |
| g | `gravity` | m/s² |
| θ₀ | `upright`: θ at which nothing makes the body fall | 1 |
| w, ŵ | θ̇ + ω₀² ẋ/g, and its estimate `carried` | 1/s |
| p | `pole` of the observer | 1/s |

About each horizontal axis (J + m l²) θ̈ = m g l θ − m l ẍ, so

    θ̈ = ω₀² (θ − u/g)                                        (B.1)
    ξ = θ + θ̇/ω₀,  ξ̇ = ω₀ (ξ − u/g)                          (B.2)

ξ is the part of the motion that grows: without a push it is multiplied by e every 1/ω₀. Feedback of the whole state,

    u = k_x x + k_v ẋ + k_θ θ + k_ω θ̇                        (B.3)

has the gains of `control.design.balance`. The attitude arrives T late, carried on to the present with its rates: θ_c. What the pivot
did since is known, and so, by (B.1),

    Δ = ω₀² (T θ_c − (ẋ(t) − ẋ(t − T))/g),  θ̇ ≈ θ̇(t − T) + Δ,  θ ≈ θ_c + ½ T Δ        (B.5)

Where wind presses on the body, or its attitude is biased, it stands at θ₀ and not at 0: in all of the above θ − θ₀ stands for θ.
By (B.1) w' = ω₀² (θ − θ₀), whatever the pivot does, so an observer of w finds θ₀ without a second derivative:

    ŵ' = ω₀² (θ − θ₀) + 2p (w − ŵ),  θ₀' = −(p²/ω₀²) (w − ŵ)      (B.6)

The error of θ₀ decays with both poles at −p. It begins with the angle at which the body hovered: that held against the wind, too.

Assumptions: small angles, the same inertia about both axes, the body's spin about its z axis of no consequence.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.models.environment import STANDARD_GRAVITY
from armland.rotations import Array


class BalanceGains(NamedTuple):
    """Feedback of the whole state by (B.3); designed in `control.design.balance`."""

    position: float
    """k_x, 1/s²."""
    speed: float
    """k_v, 1/s."""
    tilt: float
    """k_θ, m/s²."""
    tilt_rate: float
    """k_ω, m/s."""


@njit(cache=True)
def fall(tilt: float, push: float, rate: float, gravity: float = STANDARD_GRAVITY) -> float:
    """θ̈, 1/s², at θ = `tilt` under u = `push`, m/s², with ω₀ = `rate`, rad/s, and g = `gravity`, m/s². Source: (B.1)."""
    return rate * rate * (tilt - push / gravity)  # (B.1)


@njit(cache=True)
def lean_of(quat: Array, omega: Array) -> tuple[float, float, float, float]:
    """θ_x, θ_y, 1, and θ̇_x, θ̇_y, 1/s.

    Args:
        quat: attitude (4,), scalar first, D<-B.
        omega: angular velocity (3,), rad/s, body.
    """
    a, b, c, d = quat[0], quat[1], quat[2], quat[3]
    # d(R e₃)/dt = R (ω × e₃), and ω × e₃ = (ω_y, −ω_x, 0).
    x_rate = (1.0 - 2.0 * (c * c + d * d)) * omega[1] - 2.0 * (b * c - a * d) * omega[0]
    y_rate = 2.0 * (b * c + a * d) * omega[1] - (1.0 - 2.0 * (b * b + d * d)) * omega[0]
    return 2.0 * (b * d + a * c), 2.0 * (c * d - a * b), x_rate, y_rate


@njit(cache=True)
def capture_angle(quat: Array, omega: Array, rate: float, upright: Array) -> float:
    """|ξ| of both axes together, 1, beyond θ₀ = `upright` (2,), 1.

    Args:
        quat: attitude (4,), scalar first, D<-B.
        omega: angular velocity (3,), rad/s, body.
        rate: ω₀, rad/s.
        upright: θ₀ (2,), 1.

    Source: (B.2).
    """
    x, y, x_rate, y_rate = lean_of(quat, omega)
    return float(np.hypot(x - upright[0] + x_rate / rate, y - upright[1] + y_rate / rate))  # (B.2)


@njit(cache=True)
def predicted(
    tilt: float, tilt_rate: float, gained: float, delay: float, rate: float, gravity: float = STANDARD_GRAVITY
) -> tuple[float, float]:
    """θ, 1, and θ̇, 1/s, now.

    Args:
        tilt: θ_c.
        tilt_rate: θ̇ as it was `delay` ago, 1/s.
        gained: by which the pivot's velocity has changed since, m/s.
        delay: T, s.
        rate: ω₀, rad/s.
        gravity: g, m/s².

    Source: (B.5).
    """
    change = rate * rate * (delay * tilt - gained / gravity)
    return tilt + 0.5 * delay * change, tilt_rate + change  # (B.5)


@njit(cache=True)
def observed(
    upright: float, carried: float, tilt: float, w: float, step: float, rate: float, pole: float
) -> tuple[float, float]:
    """θ₀, 1, and ŵ, 1/s, one sample of the attitude further.

    Args:
        upright: θ₀ so far.
        carried: ŵ so far.
        tilt: θ when it was sampled.
        w: by `falling` then, 1/s.
        step: time since the sample before, s.
        rate: ω₀, rad/s.
        pole: p, 1/s.

    Source: (B.6).
    """
    w2 = rate * rate
    beyond = w - carried
    carried += step * (w2 * (tilt - upright) + 2.0 * pole * beyond)
    return upright - step * pole * pole / w2 * beyond, carried  # (B.6)


@njit(cache=True)
def falling(tilt_rate: float, speed: float, rate: float, gravity: float = STANDARD_GRAVITY) -> float:
    """w = θ̇ + ω₀² ẋ/g, 1/s, at θ̇ = `tilt_rate`, 1/s, ẋ = `speed`, m/s, ω₀ = `rate`, rad/s, and g = `gravity`, m/s²."""
    return tilt_rate + rate * rate * speed / gravity


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
        gains: of `control.design.balance`.
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
