"""Whether the arm went through something: its true joint positions held against the solids of the scene, whatever the plant lets touch.

The plant computes forces for a few pairs of shapes only; this looks at all of them, and takes MuJoCo's word for the depth. Of a mesh
MuJoCo looks at the convex hull: where that meets something, `depth` says how deep the mesh itself is in it.
"""

from functools import lru_cache
from itertools import product
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.experiments.judge.brief import Brief, Ticks
from armland.experiments.judge.depth import MESH, Depths
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
    model, deeper = _model(brief.solids)
    q, quat, cm = (ticks["truth"][name] for name in ("q", "quat", "r_cm"))
    data, every, depths = mujoco.MjData(model), max(brief.rate_hz // RATE_HZ, 1), dict[str, Array]()
    for name, deep in _standing(model, deeper).items():
        depths[name] = np.zeros(len(q))
        depths[name][::every] = deep
    for k in range(0, len(q), every):
        data.qpos[:], data.mocap_quat[0] = q[k], quat[k]
        data.mocap_pos[0] = cm[k] - matrix(quat[k]) @ brief.uav_cm
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        for name, deep in _met(model, data, deeper).items():
            depth = depths.setdefault(name, np.zeros(len(q)))
            depth[k] = max(depth[k], 1e3 * deep)
    return {name: Inside(depth > 0.0, depth) for name, depth in depths.items() if depth.any()}


def _met(model: mujoco.MjModel, data: mujoco.MjData, deeper: Depths) -> dict[str, float]:
    # Depths, m, of what is deeper than `DEEP_M` in something.
    out: dict[str, float] = {}
    pairs: dict[tuple[int, int], float] = {}
    for at in np.flatnonzero(data.contact.dist < -DEEP_M):
        one, two = (int(g) for g in data.contact.geom[at])
        pairs[one, two] = max(pairs.get((one, two), 0.0), -float(data.contact.dist[at]))
    for pair, hulls in pairs.items():
        deep = deeper.of(data, *pair) if MESH in model.geom_type[list(pair)] else hulls
        if deep > DEEP_M:
            name = _name(model, np.array(pair, np.int32))
            out[name] = max(out.get(name, 0.0), deep)
    return out


@lru_cache(maxsize=8)
def _model(solids: str) -> tuple[mujoco.MjModel, Depths]:
    model = mujoco.MjModel.from_xml_string(solids)
    return model, Depths(model)


def _standing(model: mujoco.MjModel, deeper: Depths) -> dict[str, float]:
    # Depth, mm, of what is fixed to the arm's base in the cradle: MuJoCo lets what stands still meet nothing that stands still.
    data, depths = mujoco.MjData(model), dict[str, float]()
    mujoco.mj_kinematics(model, data)
    still = [g for g in range(model.ngeom) if model.body_weldid[model.geom_bodyid[g]] == 0]
    base = [g for g in still if model.body(model.geom_bodyid[g]).name.startswith(ARM)]
    stand = [g for g in still if model.body(model.geom_bodyid[g]).name in CRADLE]
    for pair in product(base, stand):
        apart = mujoco.mj_geomDistance(model, data, *pair, DEEP_M, None)
        if apart < -DEEP_M and MESH in model.geom_type[list(pair)]:
            apart = -deeper.of(data, *pair)
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
