"""Disturbance observer (X.3): force and moment on the UAV that nothing in the model explains, from its momentum.

Wind, thrust error and model error act as d_f and d_τ: ṗ = f_T R e₃ + F_EE − m g e₃ + d_f with p = m v, and
L̇ = −ω × L + τ + ρ × (RᵀF_EE) + d_τ with L = Jω. What the momentum gained beyond the impulse of all that is known is the
disturbance's impulse; no velocity is differentiated. In continuous time d̂ = K/(s + K) d: a low-pass of the first order.

| symbol | name | unit, frame |
|---|---|---|
| q, ω | `q` (4,), `omega` (3,) | 1, body to world; rad/s, body |
| v, p; L | `v` (3,), `linear` (3,); `before`, `after` (3,) | m/s, N·s, world, centre of mass (CM); N·m·s, body |
| f_T, τ | `thrust`, `torque` (3,): what the rotors give | N; N·m, body |
| F_EE | `hinge_force` (3,) on the UAV at the pivot | N, world |
| d̂_f, d̂_τ | `force` (3,), `moment` (3,) | N, world, at the CM; N·m, body, about the CM |
| d̃ = d − d̂, d₁, n | `force_error`, `moment_error`; `rate`, `noise` | N, N·m; per s; times s |
| K | `force_bandwidth`, `moment_bandwidth` | rad/s |
| λ, s = √(2W) | `decay`, `size` of attitude, position | 1/s, √J |

A sample of the UAV that comes late is used with what was known when it came, so the estimate of a moment lags by its age;
give `torque` and `hinge_force` the same age where that matters. They must be what was given and not what was asked:
where rotors saturate, the rest would be taken for a disturbance.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.rotations import Array, cross, matrix, turned, turned_back


class ObserverParameters(NamedTuple):
    """The rigid body as in the laws, gravity, m/s², the time between two calls, s, and the observer's own."""

    mass: float
    inertia: Array
    lever: Array
    gravity: float
    period: float
    force_bandwidth: float
    moment_bandwidth: float
    force_limit: float
    """Largest |d̂_f|, N; the estimate does not grow beyond it."""
    moment_limit: float
    """Largest |d̂_τ|, N·m."""


class ObserverMemory(NamedTuple):
    """What the observer keeps from call to call. Start it with `initial_observer`."""

    force: Array
    moment: Array
    linear: Array
    """Momentum p at the last call, N·s."""
    omega: Array
    """Angular velocity of the last sample of the UAV, rad/s."""
    impulse: Array
    """Impulse of rotors and hinge since that sample came, N·m·s, body."""
    gathered: float
    """Time since then, s."""


class UltimateBound(NamedTuple):
    """What errors under `exact_law` shrink to: z₂ of ω, rad/s, and of v, m/s; attitude, rad; position, m."""

    omega: float
    velocity: float
    attitude: float
    position: float


@njit(cache=True)
def initial_observer(omega: Array, v: Array, p: ObserverParameters) -> ObserverMemory:
    """Memory before the first call, from ω (3,) and v (3,); the estimates start at zero."""
    return ObserverMemory(np.zeros(3), np.zeros(3), p.mass * v, omega.copy(), np.zeros(3), 0.0)


@njit(cache=True)
def observe(
    q: Array,
    omega: Array,
    v: Array,
    thrust: float,
    torque: Array,
    hinge_force: Array,
    elapsed: float,
    p: ObserverParameters,
    memory: ObserverMemory,
) -> tuple[Array, Array, ObserverMemory]:
    """Force d̂_f (3,) and moment d̂_τ (3,), one `p.period` after the call before. All inputs must be finite.

    Args:
        q: attitude, as last received.
        omega: angular velocity, as last received.
        v: velocity of the CM.
        thrust: mean over the period.
        torque: mean over the period.
        hinge_force: mean over the period.
        elapsed: from the sample of the UAV in use a call before to the one in use now, s, by its clock; 0: still the same.
        p: parameters.
        memory: from the call before.

    Source: (X.3); the momentum observer of De Luca and Mattone, "Actuator failure detection and isolation using
    generalized momenta", 2003. Departs from it by discrete time, for samples that come when they come.
    """
    R = matrix(q)
    force = thrust * R[:, 2] + hinge_force
    force[2] -= p.mass * p.gravity
    linear = p.mass * v
    d_f = _learnt(memory.force, linear - memory.linear - force * p.period, p.period, p.force_bandwidth, p.force_limit)
    impulse = memory.impulse + (torque + cross(p.lever, turned_back(R, hinge_force))) * p.period
    gathered = memory.gathered + p.period
    if elapsed <= 0.0:
        return d_f, memory.moment, ObserverMemory(d_f, memory.moment, linear, memory.omega, impulse, gathered)
    before, after = turned(p.inertia, memory.omega), turned(p.inertia, omega)
    gyroscopic = 0.5 * (cross(memory.omega, before) + cross(omega, after))
    # Samples may come at another pace than they were taken: the mean of what was known stands for the time between them.
    unknown = after - before + gyroscopic * elapsed - impulse * (elapsed / gathered)
    d_tau = _learnt(memory.moment, unknown, elapsed, p.moment_bandwidth, p.moment_limit)
    return d_f, d_tau, ObserverMemory(d_f, d_tau, linear, omega.copy(), np.zeros(3), 0.0)


@njit(cache=True)
def compensate(delta_tau: Array, force: Array, q: Array, lever: Array, d_f: Array, d_tau: Array) -> tuple[Array, Array]:
    """u − B̄⁻¹(d̂_τ, d̂_f): a law's delta_tau (3,), force (3,) with the estimates added to its a_uav. Source: (X.3), (13)."""
    return delta_tau - d_tau + cross(lever, matrix(q).T @ d_f), force - d_f  # (X.3)


@njit(cache=True)
def _learnt(estimate: Array, unknown: Array, time: float, bandwidth: float, limit: float) -> Array:
    """Estimate after `time`, s, in which an impulse `unknown` came that nothing known explains. Source: (X.3).

    The gain is `bandwidth`, made exact for a step of finite length: no gap between samples makes it unstable.
    """
    gain = -np.expm1(-bandwidth * time) / time
    learnt = estimate + gain * (unknown - estimate * time)  # (X.3)
    size = np.sqrt(np.square(learnt).sum())
    return learnt * (limit / size) if size > limit else learnt


def settling_bandwidth(time: float, share: float = 0.01) -> float:
    """K, rad/s, with which the estimate of a constant disturbance is within `share` of it after `time`, s."""
    return float(np.log(1.0 / share) / time)


def quietest_bandwidth(rate: float, noise: float) -> float:
    """K, rad/s, with the least `error_bound`: √(d₁/(2n))."""
    return float(np.sqrt(rate / (2.0 * noise)))


def error_bound(rate: float, noise: float, bandwidth: float) -> float:
    """Ultimate bound of |d̃|, N or N·m, where |ḋ| ≤ rate, N/s or N·m/s, and the momentum is wrong by at most noise, N·s, N·m·s.

    d̃ = s/(s + K) d − Ks/(s + K) n, whose impulse responses have the norms 1/K, on ḋ, and 2K: |d̃| ≤ d₁/K + 2Kn. Source: (X.3).
    """
    return rate / bandwidth + 2.0 * bandwidth * noise  # (X.3)


def bound(
    force_error: float,
    moment_error: float,
    mass: float,
    inertia: Array,
    lever: Array,
    k1: Array,
    k2: Array,
    k3_attitude: float,
    k3_position: float,
) -> UltimateBound:
    """What remains under `exact_law` with `compensate` where |d̃_f| ≤ force_error, N, and |d̃_τ| ≤ moment_error, N·m.

    With d̃, (30) becomes V̇₂ = −k₃z₁ᵀQK₁Qᵀz₁ − z₂ᵀK₂z₂ + z₂ᵀd̃ ≤ −2λV₂ + √(2V₂) |M^(−½)d̃|, λ = min(K₁(1 + |η_e|)/8 of the
    attitude, K₁ of the position, K₂/M). Hence √(2V₂) → at most |M^(−½)d̃|/λ, and the errors with it. Cut into W of attitude
    and of position, V₂ = W_a + W_p, the same holds for each with its own λ, plus c = |ρ|√(k₃/J) times the other's √(2W),
    which is often less. The lesser one counts. Arguments otherwise as in `exact_law`. An attitude of π is no bound.

    Source: (X.3), (30).
    """
    least = np.linalg.eigvalsh(inertia)[0]
    scaled = np.linalg.eigvals(np.linalg.solve(inertia, np.diag(k2[:3]))).real.min()
    driven = np.array([moment_error / np.sqrt(least), force_error / np.sqrt(mass)])
    c = np.linalg.norm(lever) * np.sqrt(k3_position / least)
    eta, size = 0.0, np.full(2, np.inf)
    # Once inside a bound of the attitude, (1 + |η_e|) is known better, which in turn gives a lesser bound.
    for _ in range(50):
        decay = np.array([min(k1[:3].min() * (1.0 + eta) / 8.0, scaled), min(k1[3:].min(), k2[3:].min() / mass)])
        size = np.minimum(size, np.linalg.norm(driven) / decay.min())
        if decay[0] * decay[1] > c**2:
            size = np.minimum(size, np.linalg.solve(np.array([[decay[0], -c], [-c, decay[1]]]), driven))
        eta = max(0.0, 1.0 - size[0] ** 2 / (2.0 * k3_attitude))
    # 1 − |η_e| = 2 sin²(θ/4), which keeps its digits where the arc cosine of |η_e| loses them.
    attitude = 4.0 * np.arcsin(min(size[0] / (2.0 * np.sqrt(k3_attitude)), np.sqrt(0.5)))
    return UltimateBound(
        float(size[0] / np.sqrt(least)),
        float(size[1] / np.sqrt(mass)),
        float(attitude),
        float(size[1] / np.sqrt(k3_position)),
    )  # (X.3)
