"""How a UAV that keeps its station above a deck goes along with the deck: with its slow motion and not with its fast one; compiled.

| symbol | name | unit, frame |
|---|---|---|
| r_s, v_s | station, and its velocity as one with the deck | m, D; m/s, W |
| δ, v̄, ā | `ride.apart`, `.v`, `.a` (3,): of what is followed, from the station; its velocity and acceleration | m, m/s, m/s², W |
| d, ḋ, d̈ | `ride.aside`, `.aside_v`, `.aside_a` (3,): δ as seen from the deck | m, m/s, m/s², D |
| λ₀, τ | `told.rides`, the fastest; `told.lags` (3,): by how much the UAV answers late, along each axis of W | rad/s, s |
| V, A | `ride.speed2`, `.push2`: means of |v_s|² and |v̇_s|² over `SEEN_S` | m²/s², m²/s⁴ |

No UAV follows what is faster than its attitude: with the deck's own acceleration fed forward it leans by 10 degrees, late, where
the deck rolls by one in half a second, and is further from its station than without. What is followed is the station behind a low pass
without an error of place at a constant speed,

    ā˙ = −λ³ δ + 3λ² (v_s − v̄) − 3λ ā,  δ˙ = v̄ − v_s,   p̄/p_s = (3λ² s + λ³)/(s + λ)³            (K.2)

so a constant error of the velocity does no harm, and no place of the deck need be known. Seen from the deck, with γ of (X.5) at
r_s + d and R W<-D: d = Rᵀδ, ḋ = Rᵀ(v̄ − v_s) − ω_b × d, d̈ = Rᵀā − g + γ(r_s + d, ḋ). In K.1 the deck's acceleration then cancels.

How fast that is, the deck's motion says by itself: where it swings at ω_c = √(A/V) a UAV that answers τ late follows with the error
ω_c τ of what it follows, so

    λ = λ₀/(1 + (ω_c τ)²)                                                                              (K.3)

a hull at 1.5 rad/s is followed nearly as fast as can be, a platform at 10 rad/s hardly. And since ā˙ is known, the acceleration that is
asked for is the one of τ later, ā + τ ā˙: `ride.aside_lead` (3,), m/s², D, in place of d̈.

A UAV on the arm is to stand on the deck at any moment, by an attitude that is as late. With R̄ the deck's mean attitude, `ride.mean`,
and R_τ the one that it will have τ later, by ω_b and ω̇_b, its level is

    R̄ turned by σ of the way to R_τ,  σ = 1/(1 + (ω_c τ)²)                                            (K.4)

At 2 rad/s that is what the deck does; at 10 rad/s, where a UAV on its hinge answers a third of a period late and half as far again, it
is the deck's mean.
"""

import numpy as np
from numba import njit

from armland.models.environment import apparent_gravity
from armland.records import Record
from armland.rotations import Array, cross, from_rotation_vector, matrix, multiply, rotation_error, turned, turned_back

SEEN_S = 4.0
"""Over which the deck's motion is looked at."""

LIKELY_MPS = 0.1
"""Speed of the station that is assumed, slow, before it has been: that of a hull in sea state 2."""


def told_layout() -> list[tuple]:
    """Of what commanding the UAV is told, what going along needs."""
    # rad/s, at most; s, by which the UAV answers late, along each axis of W; share of it that is looked ahead
    return [("rides", "f8"), ("lags", "f8", (3,)), ("ahead", "f8")]


def kept_layout() -> np.dtype:
    """What going along is remembered by; zeros on land."""
    names = ("apart", "v", "a", "aside", "aside_v", "aside_a", "aside_lead")
    seen = [("begun", "i8"), ("speed2", "f8"), ("push2", "f8"), ("share", "f8"), ("mean", "f8", (4,))]
    return np.dtype([*seen, *((name, "f8", (3,)) for name in names)])


@njit(cache=True)
def ride(
    station: Array, fastest: float, lags: Array, ahead: float, tick_s: float, environment: Record, s: Record
) -> None:
    """One tick of (K.2) and (K.3).

    Args:
        station: r_s (3,), m, D.
        fastest: λ₀, rad/s.
        lags: τ (3,), s, W.
        ahead: share of τ, a ratio, of which later the acceleration is that is asked for; 1, or 0 without prediction.
        tick_s: s.
        environment: of `models.environment.environment_layout`, of a deck that moves.
        s: of `kept_layout`, updated.
    """
    R, carried = matrix(environment.base_quat), cross(environment.base_omega, station)
    for i in range(3):
        carried[i] += environment.base_v[i]
    along = turned(R, carried)
    if not s.begun:
        s.begun, s.speed2 = 1, LIKELY_MPS**2
        for i in range(4):
            s.mean[i] = environment.base_quat[i]
        for i in range(3):
            s.v[i] = along[i]
    _look_at(station, lags[0], tick_s, carried, environment, s)
    rate = fastest * s.share  # (K.3)
    apart_v, lead = np.empty(3), np.empty(3)
    for i in range(3):
        jerk = rate**2 * (3.0 * (along[i] - s.v[i]) - rate * s.apart[i]) - 3.0 * rate * s.a[i]  # (K.2)
        s.a[i] += jerk * tick_s
        lead[i] = s.a[i] + ahead * lags[i] * jerk
        s.v[i] += s.a[i] * tick_s
        apart_v[i] = s.v[i] - along[i]
        s.apart[i] += apart_v[i] * tick_s
    aside, aside_v, aside_a = turned_back(R, s.apart), turned_back(R, apart_v), turned_back(R, s.a)
    aside_lead = turned_back(R, lead)
    turns = cross(environment.base_omega, aside)
    for i in range(3):
        aside_v[i] -= turns[i]
    gravity = apparent_gravity(environment, station + aside, aside_v)
    for i in range(3):
        s.aside[i], s.aside_v[i] = aside[i], aside_v[i]
        s.aside_a[i] = aside_a[i] - environment.gravity[i] + gravity[i]
        s.aside_lead[i] = aside_lead[i] - environment.gravity[i] + gravity[i]


@njit(cache=True)
def deck_ahead(ahead_s: float, environment: Record, s: Record) -> Array:
    """The level (4,), W<-D, at which a UAV on the arm is held that answers `ahead_s`, s, late; `s` of `kept_layout`."""
    turn, w, h = np.empty(3), environment.base_omega, environment.base_alpha
    for i in range(3):
        turn[i] = (w[i] + 0.5 * h[i] * ahead_s) * ahead_s
    coming = multiply(environment.base_quat.copy(), from_rotation_vector(turn))
    mean = s.mean.copy()
    return multiply(from_rotation_vector(s.share * rotation_error(matrix(mean), matrix(coming))), mean)  # (K.4)


@njit(cache=True)
def _look_at(station: Array, late: float, tick_s: float, carried: Array, environment: Record, s: Record) -> None:
    # V, A, σ and R̄, from the station's velocity `carried` (3,), m/s, D, and its acceleration.
    still, gain, speed2, push2 = np.zeros(3), tick_s / SEEN_S, 0.0, 0.0
    gravity = apparent_gravity(environment, station, still)
    for i in range(3):
        speed2 += carried[i] ** 2
        push2 += (environment.gravity[i] - gravity[i]) ** 2
    s.speed2 += gain * (speed2 - s.speed2)
    s.push2 += gain * (push2 - s.push2)
    s.share = 1.0 / (1.0 + s.push2 / s.speed2 * late**2)
    before = s.mean.copy()
    back = rotation_error(matrix(before), matrix(environment.base_quat.copy()))
    mean = multiply(from_rotation_vector(gain * back), before)
    for i in range(4):
        s.mean[i] = mean[i]
