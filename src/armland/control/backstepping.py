"""The backstepping law of the paper for the UAV on the robot's hinge, (14)–(33), with its proof as a function.

| symbol | name | unit, frame |
|---|---|---|
| q, q_d, q_e | `q`, `q_d`, `q_e` (4,) | 1, body to world; q_e = q_d⁻¹ ⊗ q |
| ω, v, ν | `omega` (3,), `v` (3,), `nu` (6,) | rad/s, body; m/s, world, centre of mass (CM); ν = (ω, v) |
| r, r_d, r_e | `r`, `r_d`, `r_e` (3,) | m, world, pivot; r_e = r_d − r |
| z₁, Q | `z1` (7,), `Q` (7, 6) | 1, m |
| α, z₂ | `alpha`, `z2` (6,) | rad/s, m/s |
| f_T, τ_att | `thrust`, `tau_att` (3,) | N along the body's z; N·m, body |
| m, J, ρ | `uav.mass`, `uav.inertia` (3, 3), `uav.lever` (3,) | kg; kg·m² about the CM, body; m, CM → pivot, body |
| K₁, K₂, k₃ | `gains.k1`, `gains.k2` (6,), `gains.k3` | 1/s; N·m·s/rad, N·s/m; N·m/rad, N/m |
| u = (Δτ_att, F_EE) | `delta_tau`, `force` (3,) | N·m, body; N, world, on the UAV at the pivot |
| V₂, V̇₂ | `v2`, `v2_rate` | N·m, W |

All functions but `check` are compiled and take one sample: float64 arrays, C-contiguous. Their parameters are checked
once, by `check`, and not at every sample. The exact law (X.1) is in `exact` and can be had from here too.
"""

import numpy as np
from numba import njit

from armland.control.exact import (
    GRAVITY,
    BacksteppingGains,
    ExactGains,
    Reference,
    UavParameters,
    drift,
    exact_law,
    exact_lyapunov,
    implied_acceleration,
    inertial,
    input_for,
    stacked,
)
from armland.errors import ConfigurationError, ModelError
from armland.rotations import Array, error, matrix, sgn, skew

__all__ = [
    "GRAVITY",
    "BacksteppingGains",
    "ExactGains",
    "Reference",
    "UavParameters",
    "check",
    "error_jacobian",
    "exact_law",
    "exact_lyapunov",
    "impedance_force",
    "implied_acceleration",
    "lyapunov",
    "paper_law",
    "support_force",
]


@njit(cache=True)
def error_jacobian(q_e: Array) -> Array:
    """Q (7, 6) with ż₁ = Q ν, of the attitude error q_e (4,). Source: (17); holds for ṙ_e = −v and q_d, r_d at rest."""
    Q = np.zeros((7, 6))
    Q[0, :3] = 0.5 * sgn(q_e[0]) * q_e[1:]
    Q[1:4, :3] = 0.5 * skew(q_e[1:])
    for i in range(3):
        Q[1 + i, i] += 0.5 * q_e[0]
        Q[4 + i, 3 + i] = -1.0
    return Q  # (17)


@njit(cache=True)
def paper_law(
    q: Array,
    omega: Array,
    r: Array,
    v: Array,
    q_d: Array,
    r_d: Array,
    thrust: float,
    tau_att: Array,
    uav: UavParameters,
    gains: BacksteppingGains,
) -> tuple[Array, Array]:
    """Extra torque delta_tau (3,), N·m, body, for the UAV and force (3,), N, world, of the end effector on it.

    Shapes, units and frames as in the module's table. q and −q give the same output; it may jump where η_e changes sign
    (Remark 1). `force` is the whole of (33): `impedance_force` plus `support_force`.

    Source: (29). As published it drops ω × ρ in ṙ and takes q_d, r_d as constant. Departs from the published (31),
    which lacks the factor ½ in front of sgn(η_e) ε_e: Qᵀz₁ of (17) has it, and without it (30) does not hold.
    """
    R = matrix(q)
    q_e, _, Q, gradient, z2 = _errors(q, omega, r, v, q_d, r_d, gains)
    z1_dot = Q @ stacked(omega, v)  # (17)
    alpha_dot = -gains.k1 * stacked(0.5 * sgn(q_e[0]) * z1_dot[1:4], -z1_dot[4:])  # (31), with the ½
    a_uav = drift(R, omega, thrust, tau_att, uav)
    load = inertial(alpha_dot, uav) - gains.k2 * z2 - a_uav - gains.k3 * gradient
    return input_for(load, R, uav)  # (29)


@njit(cache=True)
def lyapunov(
    q: Array, omega: Array, r: Array, v: Array, q_d: Array, r_d: Array, uav: UavParameters, gains: BacksteppingGains
) -> tuple[float, float]:
    """V₂, N·m, and the rate V̇₂ ≤ 0, W, that `paper_law` gives it; arguments as there.

    Source: (26) and the right side of (30), on the paper's kinematics.
    """
    _, z1, _, gradient, z2 = _errors(q, omega, r, v, q_d, r_d, gains)
    v2 = 0.5 * gains.k3 * (z1 @ z1) + 0.5 * (z2 @ inertial(z2, uav))  # (19), (26)
    v2_rate = -gains.k3 * (gradient @ (gains.k1 * gradient)) - z2 @ (gains.k2 * z2)  # (30)
    return float(v2), float(v2_rate)


@njit(cache=True)
def impedance_force(r_e: Array, v: Array, uav: UavParameters, gains: BacksteppingGains) -> Array:
    """Spring and damper of the end effector's force (3,), N, world, of r_e = r_d − r (3,), m, and v (3,), m/s.

    Source: (33) without its last two terms, which are `support_force`. With the published gains 935 N/m and 44.4 N·s/m.
    """
    k1, k2 = gains.k1[3:], gains.k2[3:]
    return (k1 * k2 + gains.k3) * r_e - (uav.mass * k1 + k2) * v  # (33)


@njit(cache=True)
def support_force(q: Array, thrust: float, uav: UavParameters) -> Array:
    """Static part m g e₃ − f_T R e₃ (3,), N, world: the weight that the UAV's thrust leaves to the end effector.

    Source: the last two terms of (33). Experiments E1 and E2 put zero in its place, E3 the measured force along z.
    """
    lift = thrust * matrix(q)[:, 2]
    return np.array([-lift[0], -lift[1], uav.mass * GRAVITY - lift[2]])  # (33)


@njit(cache=True)
def _errors(
    q: Array, omega: Array, r: Array, v: Array, q_d: Array, r_d: Array, gains: BacksteppingGains
) -> tuple[Array, Array, Array, Array, Array]:
    """q_e, z₁, Q, Qᵀz₁ and z₂: what the law and its Lyapunov function share."""
    q_e = error(q_d, q)  # (15)
    r_e = r_d - r
    z1 = np.array([1.0 - abs(q_e[0]), q_e[1], q_e[2], q_e[3], r_e[0], r_e[1], r_e[2]])  # (16)
    Q = error_jacobian(q_e)
    gradient = Q.T @ z1
    alpha = -gains.k1 * gradient  # (22)
    return q_e, z1, Q, gradient, stacked(omega, v) - alpha  # (21)


def check(uav: UavParameters, gains: BacksteppingGains | ExactGains) -> None:
    """Refuse parameters for which the proof does not hold. Plain Python, to be called once.

    Raises:
        ModelError: mass, inertia or lever of the UAV (a ConfigurationError).
        ConfigurationError: a gain of wrong shape, not finite or not positive.
    """
    _require_finite("uav.mass", uav.mass, (), ModelError)
    _require_finite("uav.inertia", uav.inertia, (3, 3), ModelError)
    _require_finite("uav.lever", uav.lever, (3,), ModelError)
    if uav.mass <= 0.0:
        raise ModelError(f"uav.mass is {uav.mass} kg; it must be above 0, the paper's UAV has 0.48 kg")
    inertia = np.asarray(uav.inertia)
    if np.abs(inertia - inertia.T).max() > 1e-9 * np.abs(inertia).max():
        raise ModelError(f"uav.inertia is {inertia.tolist()} kg·m²; it must be symmetric to 1e-9 of itself")
    small, middle, large = np.linalg.eigvalsh(inertia)
    moments = f"uav.inertia has the principal moments {small:.4g}, {middle:.4g}, {large:.4g} kg·m²"
    if small <= 0.0:
        raise ModelError(f"{moments}; all must be above 0")
    # A flat plate meets the bound exactly, so rounding gets room.
    if large > (small + middle) * (1.0 + 1e-9):
        raise ModelError(f"{moments}; the largest must not exceed the sum of the others, {small + middle:.4g}")
    for name, value in gains._asdict().items():
        _require_finite(f"gains.{name}", value, (6,) if name in ("k1", "k2") else (), ConfigurationError)
        if np.min(value) <= 0.0:
            raise ConfigurationError(f"gains.{name} is {np.asarray(value).tolist()}; every element must be above 0")


def _require_finite(name: str, value: object, shape: tuple[int, ...], refusal: type[ConfigurationError]) -> None:
    array = np.asarray(value, dtype=float)
    if array.shape != shape:
        raise refusal(f"{name} has the shape {array.shape}; it must have the shape {shape}")
    if not np.isfinite(array).all():
        raise refusal(f"{name} is {array.tolist()}; every element must be a finite number")
