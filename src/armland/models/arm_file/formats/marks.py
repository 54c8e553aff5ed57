"""Where the meshes of an MJCF stand: a small sphere in place of each, so that MuJoCo's compiler says its pose and opens no file."""

from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from armland.models.arm_file.tree import Mesh, Pose

MARK = "armland_mesh_"
"""How the names of the spheres begin."""

TINY_M = 1e-4
"""Their radius; they weigh nothing."""


class Mark(NamedTuple):
    """A mesh that a sphere stands for."""

    file: str
    scale: np.ndarray  # (3,)


def mark(spec: mujoco.MjSpec, path: Path) -> dict[str, Mark]:
    """Put a sphere beside each geom of a body that is a mesh of a file, and say which stands for which.

    A mesh that the file moves against its own axes (`refpos`, `refquat`), or whose points stand in the file itself, gets none.

    Args:
        spec: of the file, changed.
        path: of the file; its meshes stand near it.
    """
    out: dict[str, Mark] = {}
    for body in spec.bodies:
        for geom in [g for g in body.geoms if g.type == mujoco.mjtGeom.mjGEOM_MESH]:
            mesh = spec.mesh(geom.meshname)
            if mesh is None or not mesh.file or _moved(mesh):
                continue
            name = f"{MARK}{len(out)}"
            out[name] = Mark(str(path.parent / (spec.meshdir or "") / mesh.file), np.array(mesh.scale))
            sphere = body.add_geom(
                name=name,
                type=mujoco.mjtGeom.mjGEOM_SPHERE,
                size=[TINY_M, 0.0, 0.0],
                pos=geom.pos,
                quat=geom.quat,
                mass=0.0,
                contype=geom.contype,
                conaffinity=geom.conaffinity,
            )
            for field in ("type", "axisangle", "xyaxes", "zaxis", "euler"):
                setattr(sphere.alt, field, getattr(geom.alt, field))
    return out


def _moved(mesh: mujoco.MjsMesh) -> bool:
    return bool(np.any(mesh.refpos)) or not np.allclose(np.abs(mesh.refquat), [1.0, 0.0, 0.0, 0.0])


def meshes(model: mujoco.MjModel, body: int, marks: dict[str, Mark]) -> tuple[Mesh, ...]:
    """The meshes of a body of the compiled file.

    Args:
        model: compiled.
        body: its number.
        marks: what `mark` said.
    """
    first, count, out = int(model.body_geomadr[body]), int(model.body_geomnum[body]), []
    for g in range(first, first + count):
        if (found := marks.get(model.geom(g).name)) is not None:
            at = Pose(model.geom_pos[g].copy(), model.geom_quat[g].copy())
            out.append(Mesh(found.file, found.scale, at, bool(model.geom_contype[g] or model.geom_conaffinity[g])))
    return tuple(out)
