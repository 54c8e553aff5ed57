"""Disturbance observer (X.3): force and moment on the UAV that nothing in the model explains, from its momentum; compiled.

Wind, thrust error and model error act as d_f and d_τ: ṗ = f_T R e₃ + F_EE + m γ + d_f with p = m v, and L̇ = −ω × L + τ + d_τ with
L = Jω. The disturbance's impulse is the change of momentum less the impulse of all known forces; no velocity is
differentiated. In continuous time d̂ = K/(s + K) d: a low-pass of the first order. The ground observes the force, the UAV's own
controller the moment.

| symbol | name | unit, frame |
|---|---|---|
| R | `R` (3, 3) | 1, D<-B |
| v, p; L | `v` (3,), `kept.linear`, `momentum` (3,) | m/s, N·s, D, centre of mass (CM); N·m·s, body |
| f_T | `thrust`: what the rotors give | N |
| F_EE | `hinge_force` (3,) on the UAV at the pivot | N, D |
| γ | `gravity`, on land (0, 0, −9.81) | m/s², D |
| d̂_f, d̂_τ | `kept.force`, `estimate` (3,) | N, D, at the CM; N·m, body, about the CM |
| d̃ = d − d̂ | `force_error`, `moment_error` | N, N·m |
| λ, s = √(2W) | `decay`, `size` of attitude, position | 1/s, √J |
| K | `bandwidth`, of which `gain` is what a step of finite length makes | rad/s, 1/s |

Thrust and torque must be those given and not those asked for: where rotors saturate, the difference would be taken for a disturbance.
|d̃| is bounded by d₁/K + 2Kn, where |ḋ| ≤ d₁ and the momentum is wrong by at most n. `ultimate_bound` says which motion errors remain.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numba import njit

from armland.models.uav import UavParameters
from armland.records import Record, Records
from armland.rotations import Array


@lru_cache
def told_layout() -> np.dtype:
    """What `observe_force` is told."""
    return np.dtype(
        [
            ("period", "f8"),  # s, between two calls
            ("mass", "f8"),  # kg
            ("gain", "f8"),  # 1/s; 0: nothing is learnt
            ("limit", "f8"),  # N, of d̂_f
            ("by_axis", "i8"),  # 1: of each component; 0: of the length
        ]
    )


@lru_cache
def kept_layout() -> np.dtype:
    """What `observe_force` keeps; zeros at first, and where it shall begin anew."""
    return np.dtype([("force", "f8", (3,)), ("linear", "f8", (3,)), ("begun", "i8")])


def told(mass: float, bandwidth: float, limit: float, period: float, by_axis: bool = False) -> Records:
    """The record (1,) of `told_layout`.

    Args:
        mass: kg, that the hinge carries.
        bandwidth: K, rad/s; 0: no observer.
        limit: largest d̂_f, N.
        period: between two calls, s.
        by_axis: limit each component, and take K itself as the gain, as the observer of a load does; else limit the length, with a
            gain that makes the low pass exact for a step of any length.
    """
    p: Records = np.zeros(1, told_layout())
    gain = bandwidth if by_axis else -np.expm1(-bandwidth * period) / period
    p["period"], p["mass"], p["gain"], p["limit"], p["by_axis"] = period, mass, gain, limit, by_axis
    return p


@njit(cache=True)
def learn(estimate: Array, missed: Array, time: float, gain: float) -> None:
    """Update `estimate` (3,), N or N·m, by one step of length `time`, s, with the unexplained impulse `missed` (3,) of that step.

    Args:
        estimate: d̂, updated.
        missed: N·s or N·m·s.
        time: s.
        gain: 1/s.

    Source: (X.3); the momentum observer of De Luca and Mattone, "Actuator failure detection and isolation using generalized
    momenta", 2003, in discrete time.
    """
    for i in range(3):
        estimate[i] += gain * (missed[i] - estimate[i] * time)  # (X.3)


@njit(cache=True)
def observe_force(
    R: Array,
    thrust: float,
    hinge_force: Array,
    v: Array,
    gravity: tuple[float, float, float],
    learns: bool,
    p: Record,
    s: Record,
) -> None:
    """Bring d̂_f up to date, one period after the call before. All inputs must be finite.

    Args:
        R: (3, 3), D<-B.
        thrust: f_T, N, over the period.
        hinge_force: (3,), N, D, over the period.
        v: (3,), m/s, D, of the CM.
        gravity: γ, m/s², D.
        learns: whether what is missed is learnt; else the momentum is noted only.
        p: of `told_layout`.
        s: of `kept_layout`, updated.

    Source: (X.3).
    """
    missed = np.empty(3)
    for i in range(3):
        known, linear = R[i, 2] * thrust + hinge_force[i] + p.mass * gravity[i], p.mass * v[i]
        missed[i] = linear - s.linear[i] - known * p.period
        s.linear[i] = linear
    if s.begun and learns:
        learn(s.force, missed, p.period, p.gain)
        _limit(s.force, p.limit, p.by_axis == 1)
    s.begun = 1


@njit(cache=True)
def _limit(force: Array, limit: float, by_axis: bool) -> None:
    size = np.sqrt(force[0] ** 2 + force[1] ** 2 + force[2] ** 2)
    for i in range(3):
        if by_axis:
            force[i] = min(max(force[i], -limit), limit)
        elif size > limit:
            force[i] *= limit / size


@njit(cache=True)
def observe_moment(momentum: Array, impulse: Array, time: float, gain: float, before: Array, estimate: Array) -> None:
    """Bring d̂_τ up to date on board, one sample of `time`, s, after the one before.

    Args:
        momentum: L (3,), N·m·s, body, by the gyros.
        impulse: (3,), N·m·s, body: of rotors and −ω × L since the sample before.
        time: s.
        gain: 1/s.
        before: L at the sample before (3,), N·m·s, replaced by `momentum`.
        estimate: d̂_τ (3,), N·m, body, updated.

    Source: (X.3).
    """
    missed = np.empty(3)
    for i in range(3):
        missed[i] = momentum[i] - before[i] - impulse[i]
        before[i] = momentum[i]
    learn(estimate, missed, time, gain)


class UltimateBound(NamedTuple):
    """What errors under `exact_law` shrink to: z₂ of ω, rad/s, and of v, m/s; attitude, rad; position, m."""

    omega: float
    velocity: float
    attitude: float
    position: float


def ultimate_bound(
    force_error: float,
    moment_error: float,
    uav: UavParameters,
    k1: Array,
    k2: Array,
    k3_attitude: float,
    k3_position: float,
) -> UltimateBound:
    """What remains under `exact_law` with u − B̄⁻¹(d̂_τ, d̂_f) where |d̃_f| ≤ force_error, N, and |d̃_τ| ≤ moment_error, N·m.

    With d̃, (30) becomes V̇₂ = −k₃z₁ᵀQK₁Qᵀz₁ − z₂ᵀK₂z₂ + z₂ᵀd̃ ≤ −2λV₂ + √(2V₂) |M^(−½)d̃|, λ = min(K₁(1 + |η_e|)/8 of the
    attitude, K₁ of the position, K₂/M). Hence √(2V₂) → at most |M^(−½)d̃|/λ, and the errors with it. Cut into W of attitude
    and of position, V₂ = W_a + W_p, the same holds for each with its own λ, plus c = |ρ|√(k₃/J) times the other's √(2W),
    which is often less. The lesser one counts. An attitude of π is no bound.

    Args:
        force_error: N.
        moment_error: N·m.
        uav: rigid body.
        k1: diagonal of K₁ (6,), 1/s.
        k2: diagonal of K₂ (6,), N·m·s/rad and N·s/m.
        k3_attitude: N·m/rad.
        k3_position: N/m.
    """
    least = np.linalg.eigvalsh(uav.inertia)[0]
    scaled = np.linalg.eigvals(np.linalg.solve(uav.inertia, np.diag(k2[:3]))).real.min()
    driven = np.array([moment_error / np.sqrt(least), force_error / np.sqrt(uav.mass)])
    c = np.linalg.norm(uav.lever) * np.sqrt(k3_position / least)
    eta, size = 0.0, np.full(2, np.inf)
    # Once inside a bound of the attitude, (1 + |η_e|) is known better, which in turn gives a lesser bound.
    for _ in range(50):
        decay = np.array([min(k1[:3].min() * (1.0 + eta) / 8.0, scaled), min(k1[3:].min(), k2[3:].min() / uav.mass)])
        size = np.minimum(size, np.linalg.norm(driven) / decay.min())
        if decay[0] * decay[1] > c**2:
            size = np.minimum(size, np.linalg.solve(np.array([[decay[0], -c], [-c, decay[1]]]), driven))
        eta = max(0.0, 1.0 - size[0] ** 2 / (2.0 * k3_attitude))
    # 1 − |η_e| = 2 sin²(θ/4), which keeps its digits where the arc cosine of |η_e| loses them.
    attitude = 4.0 * np.arcsin(min(size[0] / (2.0 * np.sqrt(k3_attitude)), np.sqrt(0.5)))
    return UltimateBound(
        float(size[0] / np.sqrt(least)),
        float(size[1] / np.sqrt(uav.mass)),
        float(attitude),
        float(size[1] / np.sqrt(k3_position)),
    )
