"""States of the UAV over many ticks, from the record, and the paper's law, V₂ and geometry along them."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.control.laws.attitude import QuaternionPdGains
from armland.control.laws.backstepping import lyapunov, paper_law
from armland.control.laws.lyapunov import error_gradient
from armland.control.laws.rigid_body import BacksteppingGains, Gravity
from armland.experiments.proof.subsystem import onboard_torque
from armland.models.uav import UavParameters
from armland.rotations import Array, error, matrix


class Pose(NamedTuple):
    """States of the UAV at k ticks, and where it shall be; C-contiguous."""

    q: Array  # (k, 4)
    omega: Array  # (k, 3) rad/s, body
    r: Array  # (k, 3) m, world, pivot
    v: Array  # (k, 3) m/s, world
    q_d: Array  # (k, 4)
    r_d: Array  # (k, 3) m, world


def poses(ticks: NDArray[np.void], message: str, speed: str) -> Pose:
    """The states at recorded `ticks` (k,) of `tick_layout` by `message`, true or estimated, with its field `speed` as v."""
    state, goal = ticks[message], ticks["reference"]
    fields = (*(state[name] for name in ("quat", "omega", "r", speed)), goal["quat"], goal["r"])
    return Pose(*(np.ascontiguousarray(x) for x in fields))


def mean_poses(a: Pose, b: Pose) -> Pose:
    """The states halfway between `a` and `b`, which must be close."""
    # q and −q are the same attitude.
    b = b._replace(**{n: _on_the_side_of(getattr(a, n), getattr(b, n)) for n in ("q", "q_d")})
    mean = Pose(*(0.5 * (x + y) for x, y in zip(a, b, strict=True)))
    q, q_d = (x / np.linalg.norm(x, axis=1)[:, None] for x in (mean.q, mean.q_d))
    return mean._replace(q=q, q_d=q_d)


def _on_the_side_of(a: Array, b: Array) -> Array:
    return np.where(np.sum(a * b, axis=1) < 0.0, -1.0, 1.0)[:, None] * b


@njit(cache=True)
def law_along(
    pose: Pose, thrust: Array, tau_att: Array, uav: UavParameters, gains: BacksteppingGains, gravity: Gravity
) -> tuple[Array, Array]:
    """Δτ_att (k, 3) and F_EE (k, 3) of (29) along `pose`, with thrust (k,) and tau_att (k, 3) under `gravity`. Source: (29)."""
    torque, force = np.empty_like(pose.r), np.empty_like(pose.r)
    for k in range(pose.r.shape[0]):
        q, omega, r, v, q_d, r_d = pose.q[k], pose.omega[k], pose.r[k], pose.v[k], pose.q_d[k], pose.r_d[k]
        torque[k], force[k] = paper_law(q, omega, r, v, q_d, r_d, thrust[k], tau_att[k], uav, gains, gravity)
    return torque, force


@njit(cache=True)
def storage_along(pose: Pose, uav: UavParameters, gains: BacksteppingGains) -> Array:
    """V₂, N·m, and the rate of (30), W, (k, 2), along `pose`. Source: (26), (30)."""
    out = np.empty((pose.r.shape[0], 2))
    for k in range(pose.r.shape[0]):
        out[k] = lyapunov(pose.q[k], pose.omega[k], pose.r[k], pose.v[k], pose.q_d[k], pose.r_d[k], uav, gains)
    return out


@njit(cache=True)
def geometry_along(pose: Pose, onboard: QuaternionPdGains, k1: Array) -> tuple[Array, Array, Array]:
    """R (k, 3, 3), the onboard controller's τ_att (k, 3) towards level, and z₂ (k, 6) of the paper's law along `pose`."""
    n, level, y = pose.r.shape[0], np.array([1.0, 0.0, 0.0, 0.0]), np.empty(7)
    R, tau_att, z2 = np.empty((n, 3, 3)), np.empty((n, 3)), np.empty((n, 6))
    for k in range(n):
        y[:4], y[4:] = pose.q[k], pose.omega[k]
        R[k], tau_att[k] = matrix(pose.q[k]), onboard_torque(y, level, onboard)
        gradient = error_gradient(error(pose.q_d[k], pose.q[k]), pose.r_d[k] - pose.r[k])
        for i in range(3):
            z2[k, i] = pose.omega[k, i] + k1[i] * gradient[i]
            z2[k, 3 + i] = pose.v[k, i] + k1[3 + i] * gradient[3 + i]
    return R, tau_att, z2
