"""MuJoCo's shapes as triangles, joined for each body and colour: a browser draws few large meshes sooner than many small ones."""

from collections import defaultdict
from functools import lru_cache
from hashlib import sha256
from typing import NamedTuple

import mujoco
import numpy as np
import trimesh

from armland.models.arm_file.spec import PREFIX
from armland.rotations import Array, matrix

DRAWN = (0, 1, 2)
"""Groups of shapes that MuJoCo's own viewer shows."""

ROUND = 24
"""Sides of what is round."""

PLAIN = (0.62, 0.66, 0.71, 1.0)
"""Colour of a shape that stands for one that is not drawn."""


class Mesh(NamedTuple):
    """Triangles of one colour that are fixed to one body."""

    body: int
    vertices: Array  # (v, 3) m, body
    faces: np.ndarray  # (f, 3) indices
    color: tuple[int, int, int]  # 0 to 255
    opacity: float  # 1 where nothing shines through


def meshes_of(model: mujoco.MjModel) -> list[Mesh]:
    """The meshes of all that is drawn of a model, its floor left out: that is drawn by whoever shows it.

    Links of an arm whose file draws none are drawn by the shapes that touch in their place.
    """
    parts: dict[tuple[int, tuple[float, ...]], list[tuple[Array, np.ndarray]]] = defaultdict(list)
    for geom in drawn(model):
        made = triangles(model, geom)
        if made is None:
            continue
        vertices, faces = made
        placed = vertices @ matrix(model.geom_quat[geom]).T + model.geom_pos[geom]
        parts[int(model.geom_bodyid[geom]), color_of(model, geom)].append((placed, faces))
    return [_joined(body, color, pieces) for (body, color), pieces in sorted(parts.items())]


def triangles(model: mujoco.MjModel, geom: int) -> tuple[Array, np.ndarray] | None:
    """Vertices (v, 3), m, and faces (f, 3) of a shape in its own frame; None for a plane, or another that has no end."""
    kind, size, G = int(model.geom_type[geom]), model.geom_size[geom], mujoco.mjtGeom
    if kind == G.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        begin, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
        return model.mesh_vert[first : first + count].astype(float), model.mesh_face[begin : begin + faces].copy()
    return _primitive(kind, tuple(size.tolist()))


@lru_cache(maxsize=1024)
def _primitive(kind: int, size: tuple[float, ...]) -> tuple[Array, np.ndarray] | None:
    # The next flight's scene has the same ones, and to make them takes as long as to send them.
    make, G, rings = trimesh.creation, mujoco.mjtGeom, [ROUND // 2, ROUND]
    if kind == G.mjGEOM_BOX:
        made = make.box(extents=2.0 * np.array(size))
    elif kind == G.mjGEOM_SPHERE:
        made = make.uv_sphere(radius=size[0], count=rings)
    elif kind == G.mjGEOM_ELLIPSOID:
        made = make.uv_sphere(radius=1.0, count=rings).apply_scale(size)
    elif kind == G.mjGEOM_CYLINDER:
        made = make.cylinder(radius=size[0], height=2.0 * size[1], sections=ROUND)
    elif kind == G.mjGEOM_CAPSULE:
        # Its ends are the middles of its caps.
        made = make.capsule(height=2.0 * size[1], radius=size[0], count=rings)
        made.apply_translation([0.0, 0.0, -made.bounds.mean(axis=0)[2]])
    else:
        return None
    vertices, faces = np.array(made.vertices, dtype=float), np.array(made.faces)
    vertices.flags.writeable = faces.flags.writeable = False
    return vertices, faces


def look_of(model: mujoco.MjModel) -> str:
    """The same for two models of which the same is drawn, wherever their bodies are."""
    arrays = (
        *(model.geom_type, model.geom_size, model.geom_pos, model.geom_quat, model.geom_bodyid, model.geom_group),
        *(model.geom_rgba, model.geom_matid, model.geom_dataid, model.mat_rgba, model.mesh_vert, model.mesh_face),
    )
    return sha256(b"".join([model.names, *(a.tobytes() for a in arrays)])).hexdigest()


def drawn(model: mujoco.MjModel) -> list[int]:
    """The numbers of the shapes that are drawn, see `meshes_of`."""
    shown = [g for g in range(model.ngeom) if model.geom_group[g] in DRAWN and model.geom_rgba[g][3] > 0.0]
    seen = {int(model.geom_bodyid[g]) for g in shown}
    instead = [
        g
        for g in range(model.ngeom)
        if model.geom_group[g] == 3
        and int(model.geom_bodyid[g]) not in seen
        and model.body(int(model.geom_bodyid[g])).name.startswith((PREFIX, "armland_"))
    ]
    return [g for g in [*shown, *instead] if model.geom(g).name != "floor"]


def color_of(model: mujoco.MjModel, geom: int) -> tuple[float, ...]:
    """Red, green, blue and opacity of a shape, 0 to 1."""
    if model.geom_group[geom] == 3:
        return PLAIN
    material = int(model.geom_matid[geom])
    rgba = model.mat_rgba[material] if material >= 0 else model.geom_rgba[geom]
    return tuple(round(float(c), 3) for c in rgba)


def _joined(body: int, color: tuple[float, ...], pieces: list[tuple[Array, np.ndarray]]) -> Mesh:
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in pieces[:-1])])
    faces = np.vstack([faces + start for (_, faces), start in zip(pieces, starts, strict=True)])
    r, g, b = (round(255 * c) for c in color[:3])
    return Mesh(body, np.vstack([vertices for vertices, _ in pieces]), faces, (r, g, b), color[3])
