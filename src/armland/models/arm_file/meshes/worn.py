"""Which meshes of its file the links of an arm wear: read, merged to a grid of half a millimetre, in the link's frame."""

from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.models.arm_file.chain import Chain, Link
from armland.models.arm_file.meshes.files import triangles
from armland.models.arm_file.spec import PREFIX
from armland.models.arm_file.tree import Mesh
from armland.rotations import Array, matrix

GRID_M = 5e-4
"""Corners are rounded to it: half of the depth from which a link counts as inside something."""

THIN_M = 1e-3
"""What is thinner than this has no inside."""


class Solid(NamedTuple):
    """Triangles of one mesh."""

    vertices: Array  # (k, 3) m, in the link's frame
    faces: NDArray[np.int32]  # (f, 3)


class Worn(NamedTuple):
    """What a link wears."""

    solids: tuple[Solid, ...]
    instead: bool  # whether it has no shapes of its file beside them that count


def worn(chain: Chain) -> dict[str, Worn]:
    """Meshes of each link by the name of its body; links without any that can be read are not in it.

    Those that the file means for contact, or those that it draws where it means no shape and no mesh of the link for contact.
    """
    found = {f"{PREFIX}{link.name}": _of(link) for link in chain.links}
    return {name: one for name, one in found.items() if one.solids}


def _of(link: Link) -> Worn:
    own = [s for s in link.shapes if s.of]
    meant = any(s.touches for s in own) or any(m.touches for m in link.meshes)
    solids = [s for m in link.meshes if (m.touches or not meant) and (s := _solid(m)) is not None]
    return Worn(tuple(solids), not any(s.touches or not meant for s in own))


def _solid(mesh: Mesh) -> Solid | None:
    path = Path(mesh.file)
    corners = _read(path, path.stat().st_mtime_ns if path.is_file() else 0)
    return merged((corners * mesh.scale) @ matrix(mesh.pose.quat).T + mesh.pose.pos)


@lru_cache(maxsize=64)
def _read(path: Path, changed: int) -> Array:
    # Campaigns fly one arm many times.
    return triangles(path)


def merged(corners: Array) -> Solid | None:
    """Triangles with each corner once, on the grid; None where they enclose nothing.

    Args:
        corners: of triangles (k, 3, 3), m.
    """
    if not len(corners):
        return None
    cells, index = np.unique(np.rint(corners.reshape(-1, 3) / GRID_M).astype(np.int64), axis=0, return_inverse=True)
    faces = index.reshape(-1, 3).astype(np.int32)
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    vertices = cells[np.unique(faces)] * GRID_M if len(faces) else np.zeros((0, 3))
    if len(vertices) < 4 or np.linalg.svd(vertices - vertices.mean(axis=0), compute_uv=False)[-1] < THIN_M:
        return None
    return Solid(np.asarray(cells * GRID_M), faces)
