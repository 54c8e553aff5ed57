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
from numpy.typing import NDArray

from armland.errors import ModelError
from armland.models.chain import evaluate
from armland.models.description import EE_SITE, Tool, compile_spec, mark_end_effector, read_spec

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
        evaluate(*self._sources, velocity_terms, self._constants, self.state)

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
