"""V̇₂ along the vector field, from V₂ alone, against what (30) states.

V₂ is polynomial in the state while η_e keeps its sign: quadratic for the paper's law, of degree 12 or less for (X.1). An
eighth-order central difference along the straight line y ± k h ẏ, with the reference at t ± k h, therefore leaves hardly
anything but rounding. ẏ comes from Newton and Euler in `subsystem.motion`, and no formula of (30) enters.

| symbol | name | unit |
|---|---|---|
| y, ẏ | `y`, `rate` (13,) | SI, see `subsystem` |
| h | `h` | s |
"""

from collections.abc import Callable

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.experiments.proof.subsystem import Setting, asked, motion, onboard_torque, reference_at, storage
from armland.records import Record
from armland.rotations import Array

Law = Callable[..., tuple[Array, Array]]
"""As `subsystem.asked`: (y, reference, thrust, tau_att, setting) -> (delta_tau, force)."""

LARGEST_STEP_S, TURN_RAD = 1e-3, 0.01
"""A step of the difference is at most this long, and at most this turn of body and reference together."""

NARROW = 1e-3

WEIGHTS = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])


def rate_gaps(problems: NDArray[np.void], times: Array, states: Array, setting: Setting, law: Law = asked) -> Array:
    """|V̇₂ along the vector field − (30)| / |(30)|, (k,), of each problem's state (k, 13) at its time (k,), s.

    NaN where |η_e| < `NARROW`: a difference that keeps its sign there has too short a step to be exact.

    Args:
        problems: (k,) of `PROBLEM`.
        times: when, s.
        states: the states then.
        setting: the case.
        law: what closes the loop; by default the setting's own law.
    """
    gaps, rate = np.empty(len(problems)), np.empty(13)
    for k, (problem, t, y) in enumerate(zip(problems, times, np.ascontiguousarray(states), strict=True)):
        reference = reference_at(t, problem)
        tau_att = onboard_torque(y, reference.q_d, setting.onboard)
        delta_tau, force = law(y, reference, problem["thrust"], tau_att, setting)
        motion(y, delta_tau, force, problem["thrust"], tau_att, setting, rate)
        stated = storage(t, y, problem, setting)[1]
        gaps[k] = abs(measured_rate(t, y, rate, problem, setting) - stated) / abs(stated)
        if abs(reference.q_d @ y[:4]) < NARROW:
            gaps[k] = np.nan
    return gaps


@njit(cache=True)
def measured_rate(t: float, y: Array, rate: Array, problem: Record, setting: Setting) -> float:
    """Derivative of V₂, W, at time t, s, in state y (13,) along `rate` (13,) and the moving reference."""
    reference = reference_at(t, problem)
    turning = np.sqrt((y[4:7] ** 2).sum()) + np.sqrt((reference.omega_d**2).sum())
    eta = (reference.q_d * y[:4]).sum()
    # |η̇_e| is at most half of `turning`: over all eight points η_e keeps its sign.
    h = LARGEST_STEP_S if turning == 0.0 else min(LARGEST_STEP_S, min(TURN_RAD, 0.4 * abs(eta)) / turning)
    slope = 0.0
    for k in range(4):
        s = (k + 1) * h
        ahead, _ = storage(t + s, y + s * rate, problem, setting)
        behind, _ = storage(t - s, y - s * rate, problem, setting)
        slope += WEIGHTS[k] * (ahead - behind)
    return slope / h
