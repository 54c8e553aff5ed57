"""The controller's model of the arm: kinematics and dynamics of one configuration, from MuJoCo's arm-only model.

It is the controller's own `MjModel` and never the plant's: a wrong model is an experiment, not an accident.
Symbols, names and units: `armland.models.chain`, which evaluates it.
"""

from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.errors import ModelError
from armland.models.arm_file.reading import read_arm
from armland.models.arm_file.spec import PREFIX
from armland.models.arm_file.table import Asked, Row
from armland.models.chain import (
    Views,
    bias,
    constants_layout,
    coriolis_wrench,
    refresh,
    state_layout,
)
from armland.models.description import EE_SITE, compile_spec, mark_end_effector, without_shapes
from armland.records import Records
from armland.rotations import Array
from armland.scenario.arm import Tool

EARTH = (0.0, 0.0, -9.81)
"""Gravity at rest on land, m/s²."""


@njit(cache=True)
def _refresh(views: Views, state: Records, velocity_terms: bool) -> None:
    refresh(views, state[0], velocity_terms)


@njit(cache=True)
def _coriolis_wrench(views: Views, state: Records, twist: Array, wrench: Array) -> None:
    coriolis_wrench(views, state[0], twist, wrench)


class ArmModel:
    """Kinematics and dynamics of a serial arm at the configuration last given to `update`.

    The arrays are views of `state`, which `update` overwrites.
    """

    def __init__(
        self,
        spec: mujoco.MjSpec,
        what: str = "the arm",
        inertia_scale: float = 1.0,
        gravity: tuple[float, float, float] = EARTH,
        rows: Sequence[Row] | None = None,
    ) -> None:
        """Compile `spec`.

        Args:
            spec: a serial arm with its end effector marked.
            what: its name in messages.
            inertia_scale: factor on all its masses and inertias: a deliberately wrong model.
            gravity: (3,) m/s², axes of the arm's base.
            rows: the arm's table, for what a spec has no place for; no limit of speed and torque rate if absent.

        Raises:
            ModelError: unphysical inertia, or not a serial arm.
        """
        model = compile_spec(without_shapes(spec), what)
        _check_serial(model, what)
        _scale_inertia(model, inertia_scale)
        model.opt.gravity[:] = gravity
        self.model = model
        self.data = mujoco.MjData(model)
        """The model's `MjData` at the last update, for reading."""
        n = model.nv
        self.joints: int = n
        self.joint_names: tuple[str, ...] = tuple(model.joint(i).name.removeprefix(PREFIX) for i in range(n))
        self.q_min, self.q_max = _ranges(model)
        self.tau_max: Array = _torque_limits(model)
        self.qd_max: Array = np.array([r.speed.number for r in rows]) if rows else np.full(n, np.inf)
        """Rated speed of each joint (n,), rad/s or m/s."""
        self.torque_rate: Array = np.array([r.torque_rate.number for r in rows]) if rows else np.full(n, np.inf)
        """Largest rate of each joint's torque (n,), N·m/s or N/s."""
        self.state: NDArray[np.void] = np.zeros(1, state_layout(n))
        self.jacobian: Array = self.state["jacobian"][0]
        self.mass_matrix: Array = self.state["mass_matrix"][0]
        self.gravity: Array = self.state["gravity"][0]
        self.lambda_ee: Array = self.state["lambda_ee"][0]
        self.position: Array = self.state["position"][0]
        self.rotation: Array = self.state["rotation"][0]
        self.axis: Array = self.state["axis"][0]
        self.anchor: Array = self.state["anchor"][0]
        self.views = _views(model, self.data)
        """For compiled code."""
        self.qpos: Array = self.views.qpos
        self.qvel: Array = self.views.qvel
        self.update(np.clip(np.zeros(n), self.q_min, self.q_max), np.zeros(n))

    @classmethod
    def load(cls, path: str | Path, ee_frame: str, tool: Tool | None = None) -> "ArmModel":
        """Load an arm from MJCF or URDF, without reflected inertia of motors where the file has none.

        Args:
            path: MJCF or URDF file.
            ee_frame: site, body or link that is the end effector, its z axis pointing out of the flange; `FRAME:x` where x does.
            tool: rigid tool mounted at `ee_frame`; the controlled point is then its tip.

        Raises:
            ModelError: missing or malformed file, unknown frame, unphysical inertia, not a serial arm.
        """
        file = read_arm(path, Asked(ee_frame, armature=0.0))
        spec = file.spec()
        mark_end_effector(spec, file.frame, tool)
        return cls(spec, f"arm file {str(path)!r}", rows=file.rows)

    @property
    def friction(self) -> Array:
        """Coulomb friction of each joint (n,), N·m, as the arm's file has it; M, C and g know nothing of it."""
        return self.model.dof_frictionloss

    @property
    def damping(self) -> Array:
        """Viscous friction of each joint (n,), N·m·s/rad, likewise."""
        return self.model.dof_damping

    def update(self, q: Array, qd: Array) -> None:
        """Evaluate the model at joint positions `q` (n,) rad and velocities `qd` (n,) rad/s."""
        self.qpos[:] = q
        self.qvel[:] = qd
        self.refresh()

    def refresh(self, velocity_terms: bool = False) -> None:
        """Evaluate the model at what `qpos` and `qvel` hold now; `velocity_terms` adds C φ̇ and 𝒥̇ φ̇ to `state`."""
        _refresh(self.views, self.state, velocity_terms)

    @property
    def bias(self) -> Array:
        """C(φ, φ̇) φ̇ + g, (n,) N·m, at the last update."""
        bias(self.views)
        return self.views.bias

    def coriolis_wrench(self, xd: Array) -> Array:
        """μ ẋ_d, (6,) N, N·m, for a desired twist `xd` (6,) m/s, rad/s, at the last update: `chain.coriolis_wrench`."""
        wrench = np.zeros(6)
        _coriolis_wrench(self.views, self.state, np.asarray(xd, dtype=float), wrench)
        return wrench


def _check_serial(model: mujoco.MjModel, what: str) -> None:
    hinge, slide = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)
    for i in range(model.njnt):
        name, body = (n.removeprefix(PREFIX) for n in (model.joint(i).name, model.body(int(model.jnt_bodyid[i])).name))
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


def _views(model: mujoco.MjModel, data: mujoco.MjData) -> Views:
    site = model.site(EE_SITE).id
    pose = (data.site_xpos[site], data.site_xmat[site])
    where = (model._address, data._address, data.qpos, data.qvel, model.opt.gravity, data.xaxis, data.xanchor)
    of_bodies = data.xipos, data.ximat, model.body_mass, model.body_inertia, _behind(model)
    return Views(*where, *pose, data.subtree_com, data.M, np.zeros(model.nv), _constants(model, site), *of_bodies)


def _behind(model: mujoco.MjModel) -> Array:
    return np.stack([_ancestors(model, body) for body in range(model.nbody)], axis=1).astype(float)


def _constants(model: mujoco.MjModel, site: int) -> Records:
    n, nonzeros = model.nv, model.nM
    c = np.zeros(1, constants_layout(n, nonzeros))
    c["ee_body"] = model.site_bodyid[site]
    c["hinge"] = model.jnt_type == int(mujoco.mjtJoint.mjJNT_HINGE)
    c["moves_ee"] = _ancestors(model, int(model.site_bodyid[site]))
    c["body"] = model.jnt_bodyid
    c["mass"] = model.body_subtreemass[model.jnt_bodyid]
    c["row"] = np.repeat(np.arange(n), model.M_rownnz)
    c["column"] = model.M_colind[:nonzeros]
    return c
