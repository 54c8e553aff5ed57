"""Triangles of each format, held against a box whose corners, area and volume are known."""

import struct

import numpy as np
import pytest

from armland.models.arm_file.meshes.files import triangles

HALF = np.array([0.1, 0.2, 0.3])
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * HALF
QUADS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
"""Of the box, seen from outside against the clock."""

FACES = np.array([[q[0], q[k], q[k + 1]] for q in QUADS for k in (1, 2)])


def text(numbers):
    return " ".join(f"{x:g}" for x in np.ravel(numbers))


def stl(path):
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {text(c)}\n" for c in CORNERS[f]) + "endloop\nendfacet\n"
        for f in FACES
    )
    path.write_text(f"solid box\n{facets}endsolid box\n")


def stl_in_bytes(path):
    facets = b"".join(struct.pack("<12fH", 0, 0, 0, *CORNERS[f].ravel(), 0) for f in FACES)
    path.write_bytes(b"\0" * 80 + struct.pack("<I", len(FACES)) + facets)


def obj(path):
    quads = "".join("f " + " ".join(str(i + 1) for i in q) + "\n" for q in QUADS)
    path.write_text("".join(f"v {text(c)}\n" for c in CORNERS) + quads)


def obj_counted_backwards(path):
    quads = "".join("f " + " ".join(f"{i - 8}//1" for i in q) + "\n" for q in QUADS)
    path.write_text("# box\nvn 0 0 1\n" + "".join(f"v {text(c)} 0.5 0.5 0.5\n" for c in CORNERS) + quads)


def msh(path):
    counts = struct.pack("<4i", len(CORNERS), 0, 0, len(FACES))
    path.write_bytes(counts + CORNERS.astype("<f4").tobytes() + FACES.astype("<i4").tobytes())


DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="millimetre" meter="0.001"/><up_axis>Z_UP</up_axis></asset>
  <library_geometries><geometry id="box"><mesh>
    <source id="p"><float_array id="pa" count="24">{corners}</float_array>
      <technique_common><accessor source="#pa" count="8" stride="3"/></technique_common></source>
    <source id="n"><float_array id="na" count="3">0 0 1</float_array>
      <technique_common><accessor source="#na" count="1" stride="3"/></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    {faces}
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node id="outer"><translate>0 0 1000</translate>
    <node id="inner"><rotate>0 0 1 90</rotate><scale>2 2 2</scale><instance_geometry url="#box"/></node>
  </node></visual_scene></library_visual_scenes>
</COLLADA>
"""
"""A box in millimetres whose node doubles it, turns it by a quarter about z and lifts it by a metre."""

INPUTS = '<input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/>'


def indices(corners):
    return " ".join(f"{i} 0" for i in np.ravel(corners))


PARTS = {
    "triangles": f'<triangles count="12">{INPUTS}<p>{indices(FACES)}</p></triangles>',
    "polylist": f'<polylist count="6">{INPUTS}<vcount>{text([4] * 6)}</vcount><p>{indices(QUADS)}</p></polylist>',
    "polygons": f'<polygons count="6">{INPUTS}' + "".join(f"<p>{indices(q)}</p>" for q in QUADS) + "</polygons>",
}


def volume(found):
    """By the divergence theorem: right only if every face is there once, with its corners in order."""
    return np.einsum("ki,ki->", found[:, 0], np.cross(found[:, 1], found[:, 2])) / 6.0


@pytest.mark.parametrize(
    ("write", "suffix"),
    [(stl, "stl"), (stl_in_bytes, "STL"), (obj, "obj"), (obj_counted_backwards, "obj"), (msh, "msh")],
)
def test_box_has_its_corners_and_its_volume(tmp_path, write, suffix):
    path = tmp_path / f"box.{suffix}"
    write(path)
    found = triangles(path)
    assert found.shape == (12, 3, 3)
    assert volume(found) == pytest.approx(8.0 * HALF.prod(), rel=1e-5)
    np.testing.assert_allclose(np.abs(found).reshape(-1, 3), np.tile(HALF, (36, 1)), atol=1e-6)


@pytest.mark.parametrize("part", PARTS)
def test_collada_puts_it_where_its_nodes_say_in_metres(tmp_path, part):
    path = tmp_path / "box.dae"
    path.write_text(DAE.format(corners=text(1e3 * CORNERS), faces=PARTS[part]))
    found = triangles(path)
    assert volume(found) == pytest.approx(8.0 * 8.0 * HALF.prod(), rel=1e-6)
    low, high = found.reshape(-1, 3).min(axis=0), found.reshape(-1, 3).max(axis=0)
    np.testing.assert_allclose(high, [0.4, 0.2, 1.6], atol=1e-9)
    np.testing.assert_allclose(low, [-0.4, -0.2, 0.4], atol=1e-9)


@pytest.mark.parametrize(
    ("name", "content"),
    [("gone.stl", None), ("box.step", b"ISO-10303-21"), ("cut.msh", b"\1\0"), ("odd.dae", b"<COLLADA"), ("x.obj", b"")],
)
def test_what_cannot_be_read_has_no_triangles(tmp_path, name, content):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    assert triangles(path).shape == (0, 3, 3)
