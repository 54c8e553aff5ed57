"""The UAV on its hinge (11), (13): one rigid body with an input, and what the laws and their proof know of it; compiled.

| symbol | name | unit, frame |
|---|---|---|
| R | `R` (3, 3) | 1, D<-B |
| ω, v, ν = (ω, v) | `omega`, `v` (3,); `nu_dot` (6,) is ν̇ | rad/s, body; m/s, D, centre of mass (CM) |
| m, J, ρ | `uav.mass`, `uav.inertia` (3, 3), `uav.lever` (3,) | kg; kg·m² about the CM, body; m, CM → pivot, body |
| f_T, τ_att | `thrust`, `tau_att` (3,) | N along the body's z; N·m, body |
| u = (Δτ_att, F_EE) | `delta_tau`, `force` (3,) | N·m, body; N, D, on the UAV at the pivot |
| γ | `gravity`: three numbers, on land (0, 0, −9.81) | m/s², D |
| a_uav, M_uav ν̇, B̄⁻¹ | `drift`, `inertial` (6,), `input_for` | N·m, N |

Compiled functions take one sample: float64 arrays, C-contiguous. Parameters are checked once, by `check`, and not at every sample.
On a moving deck, rates and velocities are relative to it, γ is its apparent gravity, and the apparent moment that its rotation
puts on the body is part of τ_att, see `models.environment`.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.errors import ConfigurationError, ModelError
from armland.models.uav import UavParameters
from armland.rotations import Array, cross, turned, turned_back

Gravity = tuple[float, float, float]


class BacksteppingGains(NamedTuple):
    """The paper's gains: k1 (6,), 1/s, and k2 (6,), N·m·s/rad and N·s/m, rotation first; k3, N·m/rad and N/m, for both blocks."""

    k1: Array
    k2: Array
    k3: float


class ExactGains(NamedTuple):
    """As `BacksteppingGains`, with k₃ apart for attitude, N·m/rad, and position, N/m. Source: (X.6)."""

    k1: Array
    k2: Array
    k3_attitude: float
    k3_position: float


@njit(cache=True)
def drift(R: Array, omega: Array, thrust: float, tau_att: Array, uav: UavParameters, gravity: Gravity) -> Array:
    """a_uav (6,), N·m in body axes and N in deck axes: all that acts on the UAV except u. Source: (11), (13)."""
    load, gyroscopic = np.empty(6), cross(omega, turned(uav.inertia, omega))
    for i in range(3):
        load[i], load[3 + i] = tau_att[i] - gyroscopic[i], thrust * R[i, 2] + uav.mass * gravity[i]  # (13)
    return load


@njit(cache=True)
def inertial(nu_dot: Array, uav: UavParameters) -> Array:
    """M_uav ν̇ (6,), N·m in body axes and N in deck axes, of `nu_dot` (6,), rad/s² and m/s². Source: (13)."""
    load = np.empty(6)
    for i in range(3):
        load[i] = uav.inertia[i, 0] * nu_dot[0] + uav.inertia[i, 1] * nu_dot[1] + uav.inertia[i, 2] * nu_dot[2]
        load[3 + i] = uav.mass * nu_dot[3 + i]  # (13)
    return load


@njit(cache=True)
def input_for(load: Array, R: Array, uav: UavParameters) -> tuple[Array, Array]:
    """u = B̄⁻¹ load: delta_tau (3,), N·m, and force (3,), N, that put `load` (6,) on the CM. Source: (13), inverted by hand."""
    delta_tau, force = load[:3].copy(), load[3:].copy()
    turn = cross(uav.lever, turned_back(R, force))
    for i in range(3):
        delta_tau[i] -= turn[i]  # (13)
    return delta_tau, force


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
