"""Actuator limits (X.4): what the rotors can give, and what the arm takes over.

A force dF of the arm at the pivot turns the UAV by ρ × (RᵀdF): any moment across ρ, none along it, as the hinge passes no
torque. Of all forces that make the same moment the shortest is along moment × ρ. It also pushes the UAV off its position,
which is why it has a limit: under a law with the stiffness K₁K₂ + k₃ it costs up to limit/(K₁K₂ + k₃) m.

| symbol | name | unit, frame |
|---|---|---|
| f_T, τ | `thrust`, `torque` (3,): asked for, or as given | N; N·m, body |
| Δf_T, Δτ | `lost_thrust`, `lost_torque` (3,) | N; N·m, body |
| R, ρ | `R` (3, 3), `lever` (3,) | 1, D<-B; m, CM → pivot, body |
| dF | `force` (3,) of the arm on the UAV at the pivot | N, D |

All functions are compiled and take one sample: float64 arrays, C-contiguous.
"""

import numpy as np
from numba import njit

from armland.models.airframe.allocation import share_out
from armland.records import Record
from armland.rotations import Array, cross, turned


@njit(cache=True)
def feasible(thrust: float, torque: Array, p: Record) -> tuple[float, Array]:
    """Thrust, N, and torque (3,), N·m, body, nearest to what is asked that the rotors can give, roll and pitch first.

    Args:
        thrust: asked for, N.
        torque: asked for (3,), N·m, body.
        p: fields of `airframe.allocation.allocation_layout`; the order of priority is that of `share_out` there.

    Source: (X.4).
    """
    rotor = share_out(thrust, torque, p)
    lift, given = 0.0, np.zeros(3)
    for k in range(p.rotors):
        lift += p.mixer[0, k] * rotor[k]
        for i in range(3):
            given[i] += p.mixer[1 + i, k] * rotor[k]  # (X.4)
    return lift, given


@njit(cache=True)
def takeover(R: Array, lost_thrust: float, lost_torque: Array, lever: Array, limit: float) -> tuple[Array, Array]:
    """Force dF (3,), N, D, with which the arm replaces what the rotors do not give, and the moment (3,), N·m, body, still lost.

    The thrust is replaced in full; `limit`, N, bounds only the part of dF that replaces torque. A law that is evaluated with the
    thrust given, and not with the one asked for, has replaced the thrust already: then `lost_thrust` is 0.

    Source: (X.4).
    """
    upright = np.array([0.0, 0.0, lost_thrust])
    wanted = lost_torque - cross(lever, upright)
    # A lever too short to turn anything gets no force.
    push, length = cross(wanted, lever), 1e-12 + lever[0] ** 2 + lever[1] ** 2 + lever[2] ** 2
    size = np.sqrt(push[0] ** 2 + push[1] ** 2 + push[2] ** 2) / length
    share = min(limit / size, 1.0) / length if size > 0.0 else 0.0
    for i in range(3):
        push[i] *= share  # (X.4)
    return turned(R, upright + push), wanted - cross(lever, push)
