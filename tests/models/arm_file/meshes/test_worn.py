"""Which meshes count: those meant for contact before those that are drawn, and the file's own shapes before both."""

import numpy as np
import pytest

from armland.models.arm_file.meshes.worn import GRID_M, merged, worn
from armland.models.arm_file.reading import read_arm


def tetrahedron(size=0.1):
    a = np.array([[0.0, 0.0, 0.0], [size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]])
    return a[[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]]


def written(path, size=0.1):
    rows = [f"v {x:g} {y:g} {z:g}\n" for x, y, z in tetrahedron(size).reshape(-1, 3)]
    path.write_text("".join(rows) + "".join(f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}\n" for i in range(4)))


def dressed(changed, *parts):
    """The test arm, which has no shapes, its third link with parts: what kind, and what geometry."""
    text = "".join(f'<{kind}><origin xyz="0 0 0.1"/><geometry>{what}</geometry></{kind}>' for kind, what in parts)
    return changed("ok.urdf", ('<link name="l3">', f'<link name="l3">{text}'))


def mesh(name):
    return f'<mesh filename="{name}" scale="0.5 0.5 0.5"/>'


def bodies(path):
    return worn(read_arm(path).chain)


def test_mesh_is_where_its_link_has_it_and_as_large_as_it_is_scaled(changed, tmp_path):
    written(tmp_path / "part.obj")
    found = bodies(dressed(changed, ("collision", mesh("part.obj"))))
    (name,) = found
    assert name.endswith("l3")
    (solid,) = found[name].solids
    np.testing.assert_allclose(solid.vertices.max(axis=0), [0.05, 0.05, 0.15], atol=GRID_M)
    np.testing.assert_allclose(solid.vertices.min(axis=0), [0.0, 0.0, 0.1], atol=GRID_M)


def test_package_is_found_upwards_of_the_file(changed, tmp_path):
    (tmp_path / "meshes").mkdir()
    written(tmp_path / "meshes" / "part.obj")
    assert bodies(dressed(changed, ("visual", mesh("package://some_robot/meshes/part.obj"))))


BALL = '<sphere radius="0.05"/>'


@pytest.mark.parametrize(
    ("parts", "meshes", "instead"),
    [
        ((("collision", "part.obj"), ("visual", "part.obj")), 1, True),
        ((("visual", "part.obj"),), 1, True),
        ((("collision", "part.obj"), ("collision", BALL)), 1, False),
        ((("visual", "part.obj"), ("collision", BALL)), 0, False),
        ((("collision", "part.obj"), ("visual", BALL)), 1, True),
        ((("visual", "part.obj"), ("visual", BALL)), 1, False),
    ],
)
def test_what_is_meant_for_contact_counts_before_what_is_drawn(changed, tmp_path, parts, meshes, instead):
    written(tmp_path / "part.obj")
    found = bodies(dressed(changed, *((kind, BALL if what is BALL else mesh(what)) for kind, what in parts)))
    assert [(len(one.solids), one.instead) for one in found.values()] == ([(meshes, instead)] if meshes else [])


def test_missing_file_is_no_mesh(changed):
    assert bodies(dressed(changed, ("collision", mesh("nowhere.stl")))) == {}


def test_merged_corners_stand_once_and_keep_every_face():
    solid = merged(tetrahedron())
    assert solid is not None
    assert solid.vertices.shape == (4, 3)
    assert solid.faces.shape == (4, 3)
    np.testing.assert_allclose(solid.vertices[solid.faces], tetrahedron(), atol=GRID_M)


@pytest.mark.parametrize("corners", [np.zeros((0, 3, 3)), tetrahedron(1e-4), tetrahedron() * [1.0, 1.0, 0.0]])
def test_what_encloses_nothing_is_no_solid(corners):
    assert merged(corners) is None
