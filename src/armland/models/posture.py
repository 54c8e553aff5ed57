"""Inverse kinematics: where the arm can hold its end effector, by damped Newton steps within the joints' ranges.

`home_poses` searches, `pose` and `lead` stay on the branch of the kinematics that they start on, `check_path` follows a path.

| symbol | name | unit |
|---|---|---|
| q | joint positions (n,) | rad |
| e | position error and weighted pointing or orientation error | m |
| 𝒥_w | its Jacobian, rotation rows weighted by `ROTATION_WEIGHT_M` | m/rad |
"""

from typing import NamedTuple

import numpy as np

from armland.errors import WorkspaceError
from armland.models.arm import ArmModel
from armland.rotations import Array, rotation_error

REACHED_M = 1e-4
"""Position error at which a point counts as reached."""

REACHED_RAD = 1e-3
"""Orientation error at which an orientation counts as held."""

ROTATION_WEIGHT_M = 0.3
"""Length at which a radian weighs as much as a metre."""

CLEARANCE_M = 0.15
"""Height above the base's plane below which an elbow or end effector counts as too low."""

STEPS = 60
"""Newton steps before a target is given up."""

STARTS = 48
"""Random starts of the search for home poses."""

CAUTION = 0.05
"""Damping over the squared error (1/m²) where a target may be far or out of reach; without it steps are those of least length."""

UPRIGHT = np.eye(3)
"""End effector's orientation: pointing up, its x axis along the base's."""


class Pose(NamedTuple):
    """A joint configuration and how well it meets what was asked."""

    q: Array  # (n,) rad
    distance: float  # m, to the wanted position
    tilt: float  # rad, to the wanted orientation

    @property
    def reached(self) -> bool:
        """Whether both errors are negligible."""
        return self.distance <= REACHED_M and self.tilt <= REACHED_RAD


def home_poses(arm: ArmModel, position: Array | None, near: Array | None, elbow: int, seed: int = 0) -> list[Pose]:
    """Poses with the end effector pointing to +z at `position` (3,), best first: elbow low, far from singularities and range ends.

    Args:
        arm: the arm model (its state is overwritten).
        position: (3,), m, D; None leaves it where `near` puts it, or open.
        near: joint positions (n,) to start from; None searches the whole joint space.
        elbow: index of the elbow's joint.
        seed: of the random starts.

    Raises:
        WorkspaceError: no pose reaches it; names the distance that remains.
    """
    rng = np.random.default_rng(seed)
    low, high = _bounds(arm, 0.1)
    starts = [np.clip(near, low, high)] if near is not None else [rng.uniform(low, high) for _ in range(STARTS)]
    if position is None and near is not None:
        arm.update(starts[0], np.zeros(arm.joints))
        position = arm.position.copy()
    ease = elbow if near is None else None
    poses = [_solve(arm, start, _Task(position, None, low, high, CAUTION, ease)) for start in starts]
    reached = sorted((p for p in poses if p.reached), key=lambda p: _unease(arm, p.q, elbow))
    if reached:
        return reached
    best = min(poses, key=lambda p: p.distance + ROTATION_WEIGHT_M * p.tilt)
    where = "" if position is None else f" at {_text(position)} m"
    raise WorkspaceError(
        f"the arm cannot hold its end effector upright{where}: the best pose misses it by {1e3 * best.distance:.1f} mm "
        f"and {np.rad2deg(best.tilt):.1f}°"
    )


def check_path(arm: ArmModel, q: Array, R_d: Array, points: Array, times: Array | None = None) -> float:
    """Follow a path; returns the smallest distance of a joint to its range's end on it, rad.

    Args:
        arm: the arm model (its state is overwritten).
        q: joint positions (n,), rad, from which it is followed.
        R_d: rotation (3, 3), D<-E, that is held.
        points: (k, 3), m, D, of the end effector.
        times: (k,), s, of a trajectory, for the message.

    Raises:
        WorkspaceError: names the time, and the joint at its limit or the distance that remains.
    """
    low, high = _bounds(arm, 0.0)
    margin = np.inf
    for i, point in enumerate(points):
        pose = _solve(arm, q, _Task(point, R_d, low, high, CAUTION, None))
        q = pose.q
        gap = np.minimum(q - low, high - q)
        margin = min(margin, float(gap.min()))
        if not pose.reached:
            text = _refusal(arm, pose, point, gap)
            if times is not None:
                text = f"the trajectory leaves the workspace at t = {times[i]:.2f} s: {text}"
                text += "; shorten the moves or change trajectory.start_m"
            raise WorkspaceError(text)
    return margin


def pose(arm: ArmModel, q: Array, point: Array, R_d: Array = UPRIGHT) -> Array:
    """Joint positions (n,), rad, near `q` (n,) with the end effector at `point` (3,), m, D, in the rotation `R_d` (3, 3), D<-E.

    Where the ranges or the arm's length do not allow it, as near as they do; the state of `arm` is that of the result.
    """
    low, high = _bounds(arm, 0.0)
    return _solve(arm, q, _Task(point, R_d, low, high, 0.0, None)).q


def lead(arm: ArmModel, q: Array, point: Array, steps: int = 12) -> Array:
    """Joint positions (n,), rad, upright at `point` (3,), m, D, reached from `q` (n,), rad, in `steps` steps along a straight line."""
    arm.update(q, np.zeros(arm.joints))
    for between in np.linspace(arm.position.copy(), point, steps):
        q = pose(arm, q, between)
    return q


def upright(R: Array) -> Array:
    """The rotation nearest to the rotation `R` (3, 3), D<-E, whose z axis points exactly to +z."""
    x = np.array([R[0, 0], R[1, 0], 0.0])
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross([0.0, 0.0, 1.0], x), [0.0, 0.0, 1.0]])


def _refusal(arm: ArmModel, pose: Pose, point: Array, gap: Array) -> str:
    text = f"{_text(point)} m is out of reach by {1e3 * pose.distance:.0f} mm and {np.rad2deg(pose.tilt):.1f}°"
    tight = int(gap.argmin())
    if gap[tight] < 1e-3:
        low, high = np.rad2deg(arm.q_min[tight]), np.rad2deg(arm.q_max[tight])
        text += f"; joint {arm.joint_names[tight]} is at the end of its range, {low:.0f}° to {high:.0f}°"
    return text


def _bounds(arm: ArmModel, margin: float) -> tuple[Array, Array]:
    low = np.where(np.isfinite(arm.q_min), arm.q_min + margin, -2.0 * np.pi)
    high = np.where(np.isfinite(arm.q_max), arm.q_max - margin, 2.0 * np.pi)
    return low, high


class _Task(NamedTuple):
    position: Array | None  # (3,) m; None: anywhere
    R_d: Array | None  # (3, 3); None: pointing up, turned about that as it likes
    low: Array  # (n,) rad
    high: Array
    caution: float
    elbow: int | None  # whether it drifts towards a pose at ease, and with which elbow


def _solve(arm: ArmModel, start: Array, task: _Task) -> Pose:
    still = np.zeros(arm.joints)
    q = np.clip(start, task.low, task.high)
    for step in range(STEPS):
        arm.update(q, still)
        e, J = _error(arm, task.position, task.R_d)
        drift = _towards_ease(arm, q, task) if step <= STEPS // 2 else np.zeros(arm.joints)
        if np.abs(e).max() < 1e-9 and not drift.any():
            break
        q = _newton(q, e, J, drift, task)
    arm.update(q, still)
    distance = 0.0 if task.position is None else float(np.linalg.norm(arm.position - task.position))
    return Pose(q, distance, float(np.linalg.norm(_tilt(arm.rotation, task.R_d))))


def _newton(q: Array, e: Array, J: Array, drift: Array, task: _Task) -> Array:
    # Joints that would leave their range are held at its end and the others solve again.
    free, low, high = np.ones(q.size, dtype=bool), task.low, task.high
    for _ in range(q.size):
        Jf = J * free
        # The damping fades with the error, so the last steps are full Newton steps.
        damping = 1e-9 + task.caution * min(float(e @ e), 0.2)
        inverse = np.linalg.solve(Jf @ Jf.T + damping * np.eye(len(e)), np.column_stack([e, Jf @ drift]))
        dq = Jf.T @ inverse[:, 0] + free * (drift - Jf.T @ inverse[:, 1])
        dq *= min(1.0, 0.5 / max(np.abs(dq).max(), 1e-12))
        out = free & (((q + dq < low) & (dq < 0.0)) | ((q + dq > high) & (dq > 0.0)))
        stuck = out & ((q <= low + 1e-12) | (q >= high - 1e-12))
        if not stuck.any():
            break
        free &= ~stuck
    return np.clip(q + dq, low, high)


def _error(arm: ArmModel, position: Array | None, R_d: Array | None) -> tuple[Array, Array]:
    # Without a wanted orientation only the pointing direction counts, and turning about it is free: two rows.
    rotation = ROTATION_WEIGHT_M * arm.jacobian[3:]
    e_rot = -ROTATION_WEIGHT_M * _tilt(arm.rotation, R_d)
    if R_d is None:
        rotation, e_rot = rotation[:2], e_rot[:2]
    if position is None:
        return e_rot, rotation.copy()
    return np.concatenate([position - arm.position, e_rot]), np.vstack([arm.jacobian[:3], rotation])


def _tilt(R: Array, R_d: Array | None) -> Array:
    # Rotation vector (3,), D, from where the end effector should point to where it points.
    if R_d is not None:
        return -rotation_error(R, R_d)
    z = R[:, 2]
    sine = np.hypot(z[0], z[1])
    if sine < 1e-9:
        return np.zeros(3) if z[2] > 0.0 else np.array([np.pi, 0.0, 0.0])
    return np.array([-z[1], z[0], 0.0]) * (np.arctan2(sine, z[2]) / sine)


def _towards_ease(arm: ArmModel, q: Array, task: _Task) -> Array:
    # Elbow down, joints towards the middle of their ranges; nothing where there is no elbow.
    if task.elbow is None:
        return np.zeros(arm.joints)
    axis, lever = arm.axis, arm.anchor[task.elbow] - arm.anchor
    raises = (axis[:, 0] * lever[:, 1] - axis[:, 1] * lever[:, 0]) * (np.arange(arm.joints) < task.elbow)
    return -0.3 * raises - 0.05 * (q - 0.5 * (task.low + task.high))


def _unease(arm: ArmModel, q: Array, elbow: int) -> float:
    arm.update(q, np.zeros(arm.joints))
    sigma = np.linalg.svd(arm.jacobian, compute_uv=False)[-1]
    low, high = _bounds(arm, 0.0)
    margin = np.minimum(q - low, high - q).min()
    # The arm stands on the floor: neither its elbow nor what it carries may come near.
    sunk = max(CLEARANCE_M - min(arm.anchor[elbow, 2], arm.position[2]), 0.0)
    return float(max(arm.anchor[elbow, 2], 0.0) - 3.0 * min(sigma, 0.15) - min(margin, 0.4) + 100.0 * sunk)


def _text(p: Array) -> str:
    return "(" + ", ".join(f"{x:.3f}" for x in p) + ")"
