"""Files of triangles, read: of STL, OBJ, MuJoCo's MSH and Collada no more than where triangles stand.

STL and OBJ are read by trimesh. It knows nothing of MuJoCo's MSH, and for Collada it asks for a package of its own.

| format | what is taken | what is left |
|---|---|---|
| `.stl` | triangles, written in bytes or in words | colours, normals |
| `.obj` | triangles, polygons as fans | colours, normals, textures, curves |
| `.msh` | points and faces of MuJoCo's old binary form | normals, textures |
| `.dae` | triangles, polygons as fans, where the scene's nodes put them, in its unit | the way up, as the field's viewers leave it |
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armland.rotations import Array

READABLE = (".stl", ".obj", ".msh", ".dae")

LARGEST = 60_000_000
"""Bytes of a file; no link of an arm is drawn by more."""


def triangles(path: Path) -> Array:
    """Corners (k, 3, 3), in the file's unit; none where the file is missing, of another format or damaged."""
    nothing = np.zeros((0, 3, 3))
    if not path.is_file() or path.suffix.lower() not in READABLE or path.stat().st_size > LARGEST:
        return nothing
    try:
        found = _READERS[path.suffix.lower()](path)
    except (ValueError, KeyError, IndexError, AttributeError, StopIteration, ET.ParseError):
        return nothing
    return found if np.isfinite(found).all() else nothing


def _by_library(path: Path) -> Array:
    # Not at the top: most arms are read without a mesh.
    import trimesh

    mesh = trimesh.load_mesh(path, process=False, skip_materials=True)
    return np.asarray(mesh.triangles, dtype=np.float64)


def _msh(path: Path) -> Array:
    raw = path.read_bytes()
    points, normals, textures, faces = np.frombuffer(raw, "<i4", 4)
    where = np.frombuffer(raw, "<f4", 3 * points, 16).reshape(-1, 3)
    corners = np.frombuffer(raw, "<i4", 3 * faces, 16 + 4 * (3 * points + 3 * normals + 2 * textures))
    return where[corners].astype(float).reshape(-1, 3, 3)


def _collada(path: Path) -> Array:
    root = ET.fromstring(path.read_bytes())
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]
    unit = root.find("asset/unit")
    scale = float(unit.get("meter", "1")) if unit is not None else 1.0
    solids = {g.get("id"): np.concatenate([np.zeros((0, 3, 3)), *_drawn(g)]) for g in root.iter("geometry")}
    placed = [p for scene in root.iter("visual_scene") for node in scene for p in _placed(node, np.eye(4), solids)]
    return scale * np.concatenate([np.zeros((0, 3, 3)), *(placed or solids.values())])


def _placed(node: ET.Element, above: Array, solids: dict[str | None, Array]) -> Iterator[Array]:
    if node.tag != "node":
        return
    here = above
    for part in node:
        if part.tag in _MOVES:
            here = here @ _MOVES[part.tag](np.array((part.text or "").split(), float))
    for part in node:
        if part.tag == "instance_geometry":
            yield solids[part.get("url", "").removeprefix("#")] @ here[:3, :3].T + here[:3, 3]
        yield from _placed(part, here, solids)


def _turned(v: Array) -> Array:
    axis, angle = v[:3] / np.linalg.norm(v[:3]), np.deg2rad(v[3])
    K = np.cross(np.eye(3), -axis)
    out = np.eye(4)
    out[:3, :3] += np.sin(angle) * K + (1.0 - np.cos(angle)) * (K @ K)
    return out


def _shifted(v: Array) -> Array:
    out = np.eye(4)
    out[:3, 3] = v
    return out


_MOVES = {
    "matrix": lambda v: v.reshape(4, 4),
    "translate": _shifted,
    "rotate": _turned,
    "scale": lambda v: np.diag([*v, 1.0]),
}


def _drawn(geometry: ET.Element) -> Iterator[Array]:
    # Triangles (k, 3, 3) of each part of a mesh.
    arrays = {
        s.get("id"): np.array((s.findtext("float_array") or "").split(), float).reshape(-1, _stride(s))[:, :3]
        for s in geometry.iter("source")
        if s.find("float_array") is not None and _stride(s) >= 3
    }
    named = {
        v.get("id"): i.get("source", "").removeprefix("#")
        for v in geometry.iter("vertices")
        for i in v.iter("input")
        if i.get("semantic") == "POSITION"
    }
    for part in geometry.iter():
        if part.tag in ("triangles", "polylist", "polygons"):
            yield _corners(part, arrays, named)


def _stride(source: ET.Element) -> int:
    accessor = source.find("technique_common/accessor")
    return int(accessor.get("stride", "1")) if accessor is not None else 3


def _corners(part: ET.Element, arrays: dict[str | None, Array], named: dict[str | None, str]) -> Array:
    inputs = part.findall("input")
    stride = 1 + max(int(i.get("offset", "0")) for i in inputs)
    vertex = next(i for i in inputs if i.get("semantic") == "VERTEX")
    points = arrays[named[vertex.get("source", "").removeprefix("#")]]
    loops = [_numbers(p)[int(vertex.get("offset", "0")) :: stride] for p in part.findall("p")]
    if part.tag == "triangles":
        fans = np.concatenate(loops).reshape(-1, 3)
    else:
        counts = _numbers(part.find("vcount")) if part.tag == "polylist" else np.array([len(p) for p in loops])
        fans = _fans(np.concatenate(loops), counts)
    return np.asarray(points[fans])


def _numbers(element: ET.Element | None) -> NDArray[np.int64]:
    return np.array(((element.text if element is not None else "") or "").split(), np.int64)


def _fans(corners: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    out, at = [], 0
    for n in counts.tolist():
        out += [corners[[at, at + k, at + k + 1]] for k in range(1, n - 1)]
        at += n
    return np.array(out, np.int64).reshape(-1, 3)


_READERS = {".stl": _by_library, ".obj": _by_library, ".msh": _msh, ".dae": _collada}
