"""What the motion of its base does to an arm beyond the apparent gravity of its base, compiled.

| symbol | name | unit, frame |
|---|---|---|
| ω_b, ω̇_b | `base_omega`, `base_alpha` of the environment | rad/s, rad/s², D |
| c, v; ω | of each body: centre of mass and its velocity, angular velocity as the base sees them | m, m/s; rad/s, D |
| F = −m (2 ω_b × v + ω̇_b × c + ω_b × (ω_b × c)) | apparent force at c | N, D |
| T = ω × Iω − ω_I × Iω_I − I(ω̇_b + ω_b × ω), ω_I = ω + ω_b | apparent moment | N·m, D |
| h_b = −Σ (𝒥_vᵀ F + 𝒥_ωᵀ T) | joint torques that it takes to go along, beside M φ̈ + C φ̇ + g | N·m |

Newton and Euler on a moving base (X.5); `chain.feel` has the base's acceleration in g already.
"""

import numpy as np
from numba import njit

from armland.models.chain import Views
from armland.models.environment import apparent_gravity
from armland.records import Record
from armland.rotations import cross


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
def _apparent(environment: Record, views: Views, body: int, v: np.ndarray, omega: np.ndarray) -> tuple:
    c, R = views.com[body].copy(), views.principal[body].copy().reshape(3, 3)
    gamma, force = apparent_gravity(environment, c, v), np.empty(3)
    for i in range(3):
        force[i] = views.mass[body] * (gamma[i] - environment.gravity[i] + environment.base_a[i])
    inertia = np.zeros((3, 3))
    for i in range(3):
        for k in range(3):
            for p in range(3):
                inertia[i, k] += R[i, p] * views.moments[body, p] * R[k, p]
    base = environment.base_omega.copy()
    total, turned = omega + base, environment.base_alpha + cross(base, omega)
    own, whole, rest = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in range(3):
        for k in range(3):
            own[i] += inertia[i, k] * omega[k]
            whole[i] += inertia[i, k] * total[k]
            rest[i] += inertia[i, k] * turned[k]
    return force, cross(omega, own) - cross(total, whole) - rest
