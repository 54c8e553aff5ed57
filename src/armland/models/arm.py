"""The controller's model of the arm: kinematics and dynamics of one configuration, from MuJoCo's arm-only model.

It is the controller's own `MjModel` and never the plant's: a wrong model is an experiment, not an accident.

| symbol | name | unit |
|---|---|---|
| φ, φ̇ (7) | `q`, `qd` (n,) | rad, rad/s |
| 𝒥 | `jacobian` (6, n): end effector point, world axes, linear rows first | m, 1 |
| M | `mass_matrix` (n, n), reflected motor inertia included | kg·m² |
| C φ̇ + g | `bias` (n,) | N·m |
| g | `gravity` (n,) | N·m |
| Λ = (𝒥 M⁻¹ 𝒥ᵀ)⁻¹ (4) | `lambda_ee` (6, 6) | kg, kg·m² |
"""

from pathlib import Path

import mujoco
import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.errors import ModelError
from armland.models.description import EE_SITE, Tool, compile_spec, mark_end_effector, read_spec
from armland.models.operational import operational_inertia
from armland.records import Record

Array = NDArray[np.float64]


def state_layout(joints: int) -> np.dtype:
    """What `ArmModel.update` evaluates, as one record of shape (1,) that compiled laws take."""
    return np.dtype(
        [
            ("jacobian", "f8", (6, joints)),
            ("mass_matrix", "f8", (joints, joints)),
            ("gravity", "f8", (joints,)),
            ("lambda_ee", "f8", (6, 6)),
            ("position", "f8", (3,)),
            ("rotation", "f8", (3, 3)),
            ("axis", "f8", (joints, 3)),  # joint axes, world
            ("anchor", "f8", (joints, 3)),  # a point on each axis, m, world
            ("coriolis", "f8", (joints,)),  # C φ̇, N·m; only where velocity terms are asked for
            ("acceleration_bias", "f8", (6,)),  # 𝒥̇ φ̇, m/s², rad/s², world; likewise
        ]
    )


class ArmModel:
    """Kinematics and dynamics of a serial arm at the configuration last given to `update`.

    The arrays are views of `state`, which `update` overwrites.
    """

    def __init__(self, spec: mujoco.MjSpec, what: str = "the arm", inertia_scale: float = 1.0) -> None:
        model = compile_spec(spec, what)
        _check_serial(model, what)
        _scale_inertia(model, inertia_scale)
        self.model = model
        self._data = mujoco.MjData(model)
        n = model.nv
        self.joints: int = n
        self.joint_names: tuple[str, ...] = tuple(model.joint(i).name for i in range(n))
        self.q_min, self.q_max = _ranges(model)
        self.tau_max: Array = _torque_limits(model)
        self.state: NDArray[np.void] = np.zeros(1, state_layout(n))
        self.jacobian: Array = self.state["jacobian"][0]
        self.mass_matrix: Array = self.state["mass_matrix"][0]
        self.gravity: Array = self.state["gravity"][0]
        self.lambda_ee: Array = self.state["lambda_ee"][0]
        self.position: Array = self.state["position"][0]
        self.rotation: Array = self.state["rotation"][0]
        self.axis: Array = self.state["axis"][0]
        self.anchor: Array = self.state["anchor"][0]
        self._bias = np.zeros(n)
        self._body = int(model.site_bodyid[model.site(EE_SITE).id])
        self._constants = _constants(model, self._body)
        d, site = self._data, model.site(EE_SITE).id
        self.qpos: Array = d.qpos
        self.qvel: Array = d.qvel
        pose = (d.site_xpos[site], d.site_xmat[site])
        self._sources = (d.xaxis, d.xanchor, *pose, d.subtree_com, d.M, self._bias, self.qvel)
        self.update(np.clip(np.zeros(n), self.q_min, self.q_max), np.zeros(n))

    @classmethod
    def load(cls, path: str | Path, ee_frame: str, tool: Tool | None = None) -> "ArmModel":
        """Load an arm from MJCF or URDF.

        Args:
            path: MJCF or URDF file of one serial arm.
            ee_frame: site, body or link that is the end effector; its z axis points out of the flange.
            tool: rigid tool mounted at `ee_frame`; the controlled point is then its tip.

        Raises:
            ModelError: missing or malformed file, unknown frame, unphysical inertia, not a serial arm.
        """
        spec = read_spec(path)
        mark_end_effector(spec, ee_frame, tool)
        return cls(spec, f"arm file {str(path)!r}")

    def update(self, q: Array, qd: Array) -> None:
        """Evaluate the model at joint positions `q` (n,) rad and velocities `qd` (n,) rad/s."""
        self.qpos[:] = q
        self.qvel[:] = qd
        self.refresh()

    def refresh(self, velocity_terms: bool = False) -> None:
        """Evaluate the model at what `qpos` and `qvel` hold now; `velocity_terms` adds C φ̇ and 𝒥̇ φ̇ to `state`."""
        m, d = self.model, self._data
        mujoco.mj_kinematics(m, d)
        mujoco.mj_comPos(m, d)
        mujoco.mj_makeM(m, d)
        if velocity_terms:
            mujoco.mj_comVel(m, d)
            mujoco.mj_rne(m, d, 0, self._bias)
        _evaluate(*self._sources, velocity_terms, self._constants, self.state)

    @property
    def bias(self) -> Array:
        """C(φ, φ̇) φ̇ + g, (n,) N·m, at the last update."""
        mujoco.mj_comVel(self.model, self._data)
        mujoco.mj_rne(self.model, self._data, 0, self._bias)
        return self._bias

    def coriolis_wrench(self, xd: Array) -> Array:
        """μ ẋ_d, (6,) N, N·m, world, for a desired twist `xd` (6,) m/s, rad/s, at the last update.

        μ = Λ (𝒥 M⁻¹ C − 𝒥̇) 𝒥̄ with C of Christoffel symbols: C(φ, φ̇) b = ½ [h(φ̇ + b) − h(φ̇) − h(b)], h the velocity-product torque.
        Source: (3); the factorisation is ours.
        """
        m, d = self.model, self._data
        b: Array = np.asarray(np.linalg.solve(self.mass_matrix, self.jacobian.T @ (self.lambda_ee @ xd)), dtype=float)
        qd: Array = d.qvel.copy()
        coriolis = 0.5 * (self._velocity_torque(qd + b) - self._velocity_torque(qd) - self._velocity_torque(b))
        d.qvel[:] = qd
        mujoco.mj_comVel(m, d)
        rate = np.zeros((6, self.joints))
        mujoco.mj_jacDot(m, d, rate[:3], rate[3:], self.position, self._body)
        return self.lambda_ee @ (self.jacobian @ np.linalg.solve(self.mass_matrix, coriolis) - rate @ b)

    def _velocity_torque(self, qd: Array) -> Array:
        m, d = self.model, self._data
        d.qvel[:] = qd
        mujoco.mj_comVel(m, d)
        out = np.zeros(self.joints)
        mujoco.mj_rne(m, d, 0, out)
        return out - self.gravity

    @property
    def data(self) -> mujoco.MjData:
        """The model's `MjData` at the last update, for reading."""
        return self._data


def _check_serial(model: mujoco.MjModel, what: str) -> None:
    hinge, slide = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)
    for i in range(model.njnt):
        name, body = model.joint(i).name, model.body(int(model.jnt_bodyid[i])).name
        if model.jnt_type[i] not in (hinge, slide):
            raise ModelError(
                f"{what}: joint {name!r} of body {body!r} is neither a hinge nor a slide, so it cannot be driven"
            )
        if not name:
            raise ModelError(f"{what}: the joint of body {body!r} has no name, or another joint's; name it in the file")
    n = model.nv
    if n < 6:
        raise ModelError(
            f"{what} has {n} joints; the end effector needs at least 6 to hold a position and an orientation"
        )
    moves = _ancestors(model, int(model.site_bodyid[model.site(EE_SITE).id]))
    loose = [model.joint(i).name for i in range(model.njnt) if not moves[i]]
    if loose:
        raise ModelError(
            f"{what} is not one serial chain to the end effector: joints {', '.join(loose)} do not move it; "
            "fix them in the file or choose an end effector behind them"
        )


def _scale_inertia(model: mujoco.MjModel, scale: float) -> None:
    # A deliberately wrong model: masses, rotational inertias and reflected motor inertias, all by one factor.
    if scale != 1.0:
        model.body_mass *= scale
        model.body_inertia *= scale
        model.dof_armature *= scale
        mujoco.mj_setConst(model, mujoco.MjData(model))


def _ancestors(model: mujoco.MjModel, body: int) -> NDArray[np.bool_]:
    moves = np.zeros(model.njnt, dtype=bool)
    while body > 0:
        start, count = model.body_jntadr[body], model.body_jntnum[body]
        if count:
            moves[start : start + count] = True
        body = int(model.body_parentid[body])
    return moves


def _ranges(model: mujoco.MjModel) -> tuple[Array, Array]:
    limited = model.jnt_limited.astype(bool)
    low = np.where(limited, model.jnt_range[:, 0], -np.inf)
    high = np.where(limited, model.jnt_range[:, 1], np.inf)
    return low, high


def _torque_limits(model: mujoco.MjModel) -> Array:
    limited = model.jnt_actfrclimited.astype(bool)
    return np.where(limited, np.abs(model.jnt_actfrcrange).min(axis=1), np.inf)


def _constants(model: mujoco.MjModel, ee_body: int) -> NDArray[np.void]:
    n, nnz = model.nv, model.nM
    layout = [("hinge", "i8", (n,)), ("moves_ee", "i8", (n,)), ("body", "i8", (n,)), ("weight", "f8", (n, 3))]
    layout += [("row", "i8", (nnz,)), ("column", "i8", (nnz,))]
    c = np.zeros(1, np.dtype(layout))
    c["hinge"] = model.jnt_type == int(mujoco.mjtJoint.mjJNT_HINGE)
    c["moves_ee"] = _ancestors(model, ee_body)
    c["body"] = model.jnt_bodyid
    # Force that holds up the subtree behind each joint, N, world.
    c["weight"] = -model.body_subtreemass[model.jnt_bodyid][:, None] * model.opt.gravity
    c["row"] = np.repeat(np.arange(n), model.M_rownnz)
    c["column"] = model.M_colind[:nnz]
    return c


@njit(cache=True)
def _evaluate(
    axis: Array,
    anchor: Array,
    position: Array,
    rotation: Array,
    subtree_com: Array,
    inertia: Array,
    bias: Array,
    qd: Array,
    velocity_terms: bool,
    c_: NDArray[np.void],
    s_: NDArray[np.void],
) -> None:
    # 𝒥 and gravity from the joints' axes and anchors in the world, M from MuJoCo's sparse lower triangle, Λ from both.
    c, s = c_[0], s_[0]
    for i in range(axis.shape[0]):
        for k in range(3):
            s.axis[i, k] = axis[i, k]
            s.anchor[i, k] = anchor[i, k]
    for i in range(3):
        s.position[i] = position[i]
        for k in range(3):
            s.rotation[i, k] = rotation[3 * i + k]
    for i in range(c.row.shape[0]):
        s.mass_matrix[c.row[i], c.column[i]] = inertia[i]
        s.mass_matrix[c.column[i], c.row[i]] = inertia[i]
    for i in range(axis.shape[0]):
        # Written out: a 3-vector in compiled code is an allocation, and this runs for every joint of every tick.
        a0, a1, a2 = axis[i, 0], axis[i, 1], axis[i, 2]
        o0, o1, o2 = anchor[i, 0], anchor[i, 1], anchor[i, 2]
        b, moves = c.body[i], c.moves_ee[i]
        f0, f1, f2 = c.weight[i, 0], c.weight[i, 1], c.weight[i, 2]
        if c.hinge[i]:
            d0, d1, d2 = subtree_com[b, 0] - o0, subtree_com[b, 1] - o1, subtree_com[b, 2] - o2
            s.gravity[i] = f0 * (a1 * d2 - a2 * d1) + f1 * (a2 * d0 - a0 * d2) + f2 * (a0 * d1 - a1 * d0)
            d0, d1, d2 = position[0] - o0, position[1] - o1, position[2] - o2
            s.jacobian[0, i] = moves * (a1 * d2 - a2 * d1)
            s.jacobian[1, i] = moves * (a2 * d0 - a0 * d2)
            s.jacobian[2, i] = moves * (a0 * d1 - a1 * d0)
            s.jacobian[3, i], s.jacobian[4, i], s.jacobian[5, i] = moves * a0, moves * a1, moves * a2
        else:
            s.gravity[i] = f0 * a0 + f1 * a1 + f2 * a2
            s.jacobian[0, i], s.jacobian[1, i], s.jacobian[2, i] = moves * a0, moves * a1, moves * a2
            s.jacobian[3, i], s.jacobian[4, i], s.jacobian[5, i] = 0.0, 0.0, 0.0
    operational_inertia(s.mass_matrix, s.jacobian, s.lambda_ee)
    if velocity_terms:
        _velocity_terms(bias, qd, c, s)


@njit(cache=True)
def _velocity_terms(bias: Array, qd: Array, c: Record, s: Record) -> None:
    # 𝒥̇ φ̇ is the end effector's acceleration with φ̈ = 0, carried from joint to joint along the chain. Written out:
    # every 3-vector would be an allocation.
    w0 = w1 = w2 = b0 = b1 = b2 = a0 = a1 = a2 = 0.0
    n = qd.shape[0]
    for i in range(n + 1):
        if i > 0:
            d0, d1, d2 = -s.anchor[i - 1, 0], -s.anchor[i - 1, 1], -s.anchor[i - 1, 2]
            if i < n:
                d0, d1, d2 = d0 + s.anchor[i, 0], d1 + s.anchor[i, 1], d2 + s.anchor[i, 2]
            else:
                d0, d1, d2 = d0 + s.position[0], d1 + s.position[1], d2 + s.position[2]
            # α × d + ω × (ω × d) = α × d + ω (ω·d) − d |ω|²
            along, square = w0 * d0 + w1 * d1 + w2 * d2, w0 * w0 + w1 * w1 + w2 * w2
            a0 += b1 * d2 - b2 * d1 + w0 * along - d0 * square
            a1 += b2 * d0 - b0 * d2 + w1 * along - d1 * square
            a2 += b0 * d1 - b1 * d0 + w2 * along - d2 * square
        if i == n:
            break
        s.coriolis[i] = bias[i] - s.gravity[i]
        r0, r1, r2 = s.axis[i, 0] * qd[i], s.axis[i, 1] * qd[i], s.axis[i, 2] * qd[i]
        x0, x1, x2 = w1 * r2 - w2 * r1, w2 * r0 - w0 * r2, w0 * r1 - w1 * r0
        if c.hinge[i]:
            b0, b1, b2 = b0 + x0, b1 + x1, b2 + x2
            w0, w1, w2 = w0 + r0, w1 + r1, w2 + r2
        else:
            a0, a1, a2 = a0 + 2.0 * x0, a1 + 2.0 * x1, a2 + 2.0 * x2
    s.acceleration_bias[0], s.acceleration_bias[1], s.acceleration_bias[2] = a0, a1, a2
    s.acceleration_bias[3], s.acceleration_bias[4], s.acceleration_bias[5] = b0, b1, b2
