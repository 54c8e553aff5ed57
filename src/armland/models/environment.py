"""What surrounds arm and UAV: gravity and the motion of the deck, and what they are to who moves with the deck; compiled.

| symbol | name | unit, frame |
|---|---|---|
| g | `gravity` (3,) | m/s², D |
| q_b | `base_quat` (4,): the deck's attitude, scalar first | 1, W<-D |
| v_b, ω_b | `base_v`, `base_omega` (3,): of the deck's origin | m/s, rad/s, D |
| a_b, ω̇_b | `base_a`, `base_alpha` (3,) | m/s², rad/s², D |
| r, v | `r`, `v` (3,): a point and its velocity as seen from the deck | m, m/s, D |
| γ | apparent gravity at r | m/s², D |

A point that the deck sees at r, v with the acceleration a has the inertial acceleration a + g − γ, with

    γ(r, v) = g − a_b − 2 ω_b × v − ω̇_b × r − ω_b × (ω_b × r)        (X.5)

so that Newton's law on the deck is that on land with γ for gravity. Euler's law of a body that turns at ω against the deck has the
inertial rate ω_I = ω + Rᵀω_b: J ω̇ = τ − ω × Jω + τ_b, τ_b of `apparent_moment`. On land all of the base's motion is zero, γ is g and
τ_b is zero, to the last bit.

An arm on the base, of whose bodies each has its centre of mass at c with the velocity v and turns at ω as the base sees it, takes the
torques h_b beside M φ̈ + C φ̇ + g, where g has a_b already (`chain.feel`):

    h_b = −Σ (𝒥_vᵀ F + 𝒥_ωᵀ T),  F = m (γ − g + a_b) at c,  T = τ_b in the base's axes
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.models.chain import Views
from armland.records import Record, Records
from armland.rotations import Array, cross, matrix, turned, turned_back

STANDARD_GRAVITY = 9.81
"""m/s², for closed forms on land."""

DOWN = (0.0, 0.0, -STANDARD_GRAVITY)
"""Gravity on land (3,), m/s²."""


# Kept, so that equal layouts are one object, which compiled code recognises fastest.
@lru_cache
def environment_layout() -> np.dtype:
    """Gravity and the deck's motion, as one record; `moves` is 1 where there is any, 0 on land."""
    motion = [(name, "f8", (3,)) for name in ("gravity", "base_v", "base_omega", "base_a", "base_alpha")]
    return np.dtype([*motion, ("base_quat", "f8", (4,)), ("moves", "i8")])


def on_land(gravity: tuple[float, float, float] = DOWN) -> Records:
    """The environment (1,) of a deck at rest under `gravity` (3,), m/s², deck axes."""
    environment: Records = np.zeros(1, environment_layout())
    environment["gravity"] = gravity
    environment["base_quat"][0, 0] = 1.0
    return environment


@njit(cache=True)
def apparent_gravity(environment: Record, r: Array, v: Array) -> tuple[float, float, float]:
    """γ, m/s², D, of a point at r (3,), m, that moves with v (3,), m/s, both D. Source: theory.md 8, (X.5)."""
    g, a, w, h = environment.gravity, environment.base_a, environment.base_omega, environment.base_alpha
    # ω × (ω × r) = ω (ω·r) − r |ω|²
    along, square = w[0] * r[0] + w[1] * r[1] + w[2] * r[2], w[0] * w[0] + w[1] * w[1] + w[2] * w[2]
    return (
        g[0] - a[0] - 2.0 * (w[1] * v[2] - w[2] * v[1]) - (h[1] * r[2] - h[2] * r[1]) - (w[0] * along - r[0] * square),
        g[1] - a[1] - 2.0 * (w[2] * v[0] - w[0] * v[2]) - (h[2] * r[0] - h[0] * r[2]) - (w[1] * along - r[1] * square),
        g[2] - a[2] - 2.0 * (w[0] * v[1] - w[1] * v[0]) - (h[0] * r[1] - h[1] * r[0]) - (w[2] * along - r[2] * square),
    )  # (X.5)


@njit(cache=True)
def climb(environment: Record, r: Array, v: Array) -> float:
    """Velocity upwards in W, m/s, of a point at r (3,), m, that the deck sees move with v (3,), m/s, both D.

    A deck that rises below a UAV is no UAV that sinks.
    """
    if not environment.moves:
        return float(v[2])
    carried, up = cross(environment.base_omega, r), matrix(environment.base_quat)[2]
    upwards = 0.0
    for i in range(3):
        upwards += up[i] * (v[i] + environment.base_v[i] + carried[i])
    return upwards


@njit(cache=True)
def apparent_moment(environment: Record, R: Array, omega: Array, inertia: Array) -> Array:
    """τ_b (3,), N·m, body: what the deck's rotation seems to do to a body that turns against it.

    Args:
        environment: of `environment_layout`.
        R: rotation (3, 3), D<-B.
        omega: ω (3,), rad/s, body, against the deck.
        inertia: J (3, 3), kg·m², body.

    Source: (X.5); J (Rᵀω̇_b − ω × Rᵀω_b) is what the inertial rate's change holds beyond Jω̇.
    """
    deck = turned_back(R, environment.base_omega)
    inertial = omega + deck
    carried = turned(inertia, turned_back(R, environment.base_alpha) - cross(omega, deck))
    return cross(omega, turned(inertia, omega)) - cross(inertial, turned(inertia, inertial)) - carried  # (X.5)


@njit(cache=True)
def carry_along(views: Views, environment: Record, s: Record) -> None:
    """Add h_b to the gravity torques of `s`, at the positions last refreshed and the velocities in `views.qvel`.

    Args:
        views: of the arm model, which feels the same `environment`.
        environment: of `models.environment.environment_layout`.
        s: of `chain.state_layout`, whose `gravity` (n,), N·m, is changed.
    """
    hinge = views.constants[0].hinge
    for body in range(1, views.mass.shape[0]):
        if views.mass[body] == 0.0 and views.moments[body].sum() == 0.0:
            continue
        c, v, omega = views.com[body].copy(), np.zeros(3), np.zeros(3)
        for j in range(hinge.shape[0]):
            if views.behind[j, body]:
                axis = views.axis[j].copy() * views.qvel[j]
                if hinge[j]:
                    v += cross(axis, c - views.anchor[j])
                    omega += axis
                else:
                    v += axis
        force, moment = _apparent(environment, views, body, v, omega)
        for j in range(hinge.shape[0]):
            if views.behind[j, body]:
                work = cross(c - views.anchor[j], force) + moment if hinge[j] else force
                for i in range(3):
                    s.gravity[j] -= views.axis[j, i] * work[i]  # h_b


@njit(cache=True)
def _apparent(environment: Record, views: Views, body: int, v: Array, omega: Array) -> tuple[Array, Array]:
    # F and T of the body.
    R, moments, force = views.principal[body].copy().reshape(3, 3), np.zeros((3, 3)), np.empty(3)
    gamma = apparent_gravity(environment, views.com[body], v)
    for i in range(3):
        force[i] = views.mass[body] * (gamma[i] - environment.gravity[i] + environment.base_a[i])
        moments[i, i] = views.moments[body, i]
    return force, turned(R, apparent_moment(environment, R, turned_back(R, omega), moments))
