"""What (29) and V₂ do where η_e changes sign, half a turn away from the goal (Remark 1).

There sgn(η_e) ε_e jumps from ε_e to −ε_e, and with it α, u and z₂. V₂ jumps too: under (29) by −s ωᵀJK₁ε_e, s the sign
before, on a path that goes across with s ωᵀε_e > 0. With J K₁ a multiple of the identity that is a fall; with any other it
may be a rise.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.proof.subsystem import PROBLEM, Setting, asked, onboard_torque, reference_at, storage
from armland.rotations import Array, from_rotation_vector, multiply

NARROW = 1e-13  # |η_e| at which the two sides of the change of sign are looked at


class Sweep(NamedTuple):
    """(29) about half a turn around one body axis, the rest of the state at the goal."""

    angle: Array  # (k,) rad
    delta_tau: Array  # (k,) N·m about the axis
    v2: Array  # (k,) N·m


def sweep(setting: Setting, axis: int, rate: float, angle: Array) -> Sweep:
    """The law at `angle` (k,), rad, around a body axis, at `rate`, rad/s, about it."""
    problem, torque, v2 = np.zeros(1, PROBLEM), np.empty(len(angle)), np.empty(len(angle))
    problem["q_d"][0, 0] = 1.0
    unit, y = np.eye(3)[axis], np.zeros(13)
    for k, phi in enumerate(angle):
        y[:4], y[4:7] = from_rotation_vector(phi * unit), rate * unit
        reference = reference_at(0.0, problem[0])
        tau_att = onboard_torque(y, reference.q_d, setting.onboard)
        torque[k] = asked(y, reference, 0.0, tau_att, setting)[0][axis] + tau_att[axis]
        v2[k] = storage(0.0, y, problem[0], setting)[0]
    return Sweep(angle, torque, v2)


def across(problems: NDArray[np.void], setting: Setting) -> tuple[Array, Array, Array]:
    """Jump of V₂, relative, and of u: |Δτ_att|, N·m, and |F_EE|, N, (k,) each, of the problems' states put at half a turn.

    Each attitude is turned about its own error axis until |η_e| = `NARROW`, on either side; each path crosses the way
    that its body rate takes it.
    """
    rise, torque, force = (np.empty(len(problems)) for _ in range(3))
    for k, problem in enumerate(problems):
        reference = reference_at(0.0, problem)
        y = problem["start"].copy()
        eps = multiply(reference.q_d * [1, -1, -1, -1], y[:4])[1:]
        eps /= np.linalg.norm(eps)
        before = np.sign(eps @ (y[4:7] - reference.omega_d))
        sides = []
        for eta in (before * NARROW, -before * NARROW):
            y[:4] = multiply(reference.q_d, np.concatenate([[eta], eps]))
            tau_att = onboard_torque(y, reference.q_d, setting.onboard)
            sides.append(
                (storage(0.0, y, problem, setting)[0], *asked(y, reference, problem["thrust"], tau_att, setting))
            )
        (v2_a, torque_a, force_a), (v2_b, torque_b, force_b) = sides
        rise[k], torque[k] = v2_b / v2_a - 1.0, np.linalg.norm(torque_b - torque_a)
        force[k] = np.linalg.norm(force_b - force_a)
    return rise, torque, force
