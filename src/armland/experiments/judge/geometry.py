"""Whether the arm went through something: its true joint positions held against the solids of the scene, whatever the plant lets touch.

The plant computes forces for a few pairs of shapes only; this looks at all of them, and takes MuJoCo's word for the depth alone.
"""

from functools import lru_cache
from itertools import product
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.experiments.judge.brief import Brief, Ticks
from armland.rotations import Array, matrix

RATE_HZ = 50
"""How often poses are looked at: at 0.4 m/s, the fastest move of a landing, a link moves by 8 mm between."""

DEEP_M = 1e-3
"""Depth from which a link is inside something: contacts give way by less."""

ARM, CRADLE = ("arm/", "armland_"), ("stand", "cradle")
"""How the names of the arm's bodies begin, and names of those of the cradle."""


class Inside(NamedTuple):
    """How deep a link was in something."""

    where: NDArray[np.bool_]  # (k,)
    depth: Array  # (k,) mm; 0 between the ticks that were looked at


def insides(ticks: Ticks, brief: Brief) -> dict[str, Inside]:
    """Each pair of solids of which one went into the other, by `link_in_what`; none where the log has no solids."""
    if not brief.solids:
        return {}
    model, (q, quat, cm) = _model(brief.solids), (ticks["truth"][name] for name in ("q", "quat", "r_cm"))
    data, every, depths = mujoco.MjData(model), max(brief.rate_hz // RATE_HZ, 1), dict[str, Array]()
    for name, deep in _standing(model).items():
        depths[name] = np.zeros(len(q))
        depths[name][::every] = deep
    for k in range(0, len(q), every):
        data.qpos[:], data.mocap_quat[0] = q[k], quat[k]
        data.mocap_pos[0] = cm[k] - matrix(quat[k]) @ brief.uav_cm
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        for at in np.flatnonzero(data.contact.dist < -DEEP_M):
            depth = depths.setdefault(_name(model, data.contact.geom[at]), np.zeros(len(q)))
            depth[k] = max(depth[k], -1e3 * data.contact.dist[at])
    return {name: Inside(depth > 0.0, depth) for name, depth in depths.items()}


@lru_cache(maxsize=8)
def _model(solids: str) -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(solids)


def _standing(model: mujoco.MjModel) -> dict[str, float]:
    # Depth, mm, of what is fixed to the arm's base in the cradle: MuJoCo lets what stands still meet nothing that stands still.
    data, depths = mujoco.MjData(model), dict[str, float]()
    mujoco.mj_kinematics(model, data)
    still = [g for g in range(model.ngeom) if model.body_weldid[model.geom_bodyid[g]] == 0]
    base = [g for g in still if model.body(model.geom_bodyid[g]).name.startswith(ARM)]
    stand = [g for g in still if model.body(model.geom_bodyid[g]).name in CRADLE]
    for pair in product(base, stand):
        apart = mujoco.mj_geomDistance(model, data, *pair, DEEP_M, None)
        if apart < -DEEP_M:
            name = _name(model, np.array(pair, np.int32))
            depths[name] = max(depths.get(name, 0.0), -1e3 * apart)
    return depths


def _name(model: mujoco.MjModel, geoms: NDArray[np.int32]) -> str:
    # The arm's own first, and of two of them the outer one.
    bodies = sorted((int(model.geom_bodyid[g]) for g in geoms), reverse=True)
    names = [model.body(b).name or "floor" for b in bodies]
    names.sort(key=lambda n: not n.startswith(ARM))
    return "_in_".join(_told(n) for n in names)


def _told(name: str) -> str:
    return {"uav/uav": "uav", "world": "floor", "stand": "cradle", "armland_tool": "tool"}.get(
        name, name.removeprefix("arm/")
    )
