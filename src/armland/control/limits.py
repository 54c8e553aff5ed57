"""Actuator limits (X.4): what the four rotors can give, what the arm takes over, and integrators that do not wind up.

A force dF of the arm at the pivot turns the UAV by ρ × (RᵀdF): any moment across ρ, none along it, as the hinge passes no
torque. Of all forces that make the same moment the shortest is along moment × ρ. It also pushes the UAV off its position,
which is why it has a limit: under a law with the stiffness K₁K₂ + k₃ it costs up to limit/(K₁K₂ + k₃) m.

| symbol | name | unit, frame |
|---|---|---|
| f_T, τ | `thrust`, `torque` (3,): asked for, or as given | N; N·m, body |
| Δf_T, Δτ | `lost_thrust`, `lost_torque` (3,) | N; N·m, body |
| R, ρ | `R` (3, 3), `lever` (3,) | 1, body to world; m, CM → pivot, body |
| dF | `force` (3,) of the arm on the UAV at the pivot | N, world |

All functions are compiled and take one sample: float64 arrays, C-contiguous.
"""

import numpy as np
from numba import njit

from armland.models.uav import allocate
from armland.rotations import Array, cross


@njit(cache=True)
def feasible(thrust: float, torque: Array, inverse: Array, low: float, high: float) -> tuple[float, Array]:
    """Thrust and torque (3,) nearest to what is asked that rotors in [low, high] N give, roll and pitch first.

    `inverse` (4, 4) is that of `models.uav.mixer`; the order of priority is that of `models.uav.allocate`.

    Source: (X.4).
    """
    rotor = allocate(thrust, torque, inverse, low, high)
    wrench: Array = np.linalg.solve(inverse, rotor)  # type: ignore[assignment]
    return wrench[0], wrench[1:]  # (X.4)


@njit(cache=True)
def takeover(R: Array, lost_thrust: float, lost_torque: Array, lever: Array, limit: float) -> tuple[Array, Array]:
    """Force dF (3,) with which the arm replaces what the rotors do not give, and the moment (3,), N·m, body, still lost.

    The thrust is replaced whole; `limit`, N, bounds the part of dF that is there for the moment's sake. A law evaluated
    with the thrust given instead of the one asked for has replaced it by itself: then `lost_thrust` is 0.

    Source: (X.4).
    """
    upright = np.array([0.0, 0.0, lost_thrust])
    wanted = lost_torque - cross(lever, upright)
    # A lever too short to turn anything gets no force.
    push = cross(wanted, lever) / (1e-12 + np.square(lever).sum())  # (X.4)
    size = np.sqrt(np.square(push).sum())
    if size > limit:
        push *= limit / size
    return R @ (upright + push), wanted - cross(lever, push)  # (X.4)


@njit(cache=True)
def conditional(step: Array, asked: Array, given: Array) -> Array:
    """Integrator's step (n,) without the elements that drive a saturated actuator further beyond its limit.

    `asked` and `given` (n,) are the actuator's command before and after its limit; `step` enters it with a plus sign.
    `estimation.disturbance` needs no such thing as long as it is told what was given.

    Source: (X.4).
    """
    kept = step.copy()
    for i in range(step.shape[0]):
        # Allocation goes through the rotors and back and so does not return what it was given to the last digit.
        if step[i] * (asked[i] - given[i]) > 1e-9 * abs(step[i]) * max(1.0, abs(asked[i])):
            kept[i] = 0.0
    return kept  # (X.4)
