"""Shapes: MuJoCo's geoms as triangles of the right size, in the right place, of the right colour."""

import mujoco
import numpy as np
import pytest
import trimesh

from armland.console.stage.shapes import look_of, meshes_of, triangles
from armland.plant.scene.composition import build_scene
from armland.scenario import load_scenario

SHAPES = """
<mujoco>
  <asset>
    <mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/>
    <material name="red" rgba="1 0 0 1"/>
  </asset>
  <worldbody>
    <geom name="box" type="box" size="0.1 0.2 0.3"/>
    <geom name="sphere" type="sphere" size="0.5"/>
    <geom name="ellipsoid" type="ellipsoid" size="0.1 0.2 0.4"/>
    <geom name="cylinder" type="cylinder" size="0.2 0.3"/>
    <geom name="capsule" type="capsule" size="0.1 0.4"/>
    <geom name="mesh" type="mesh" mesh="wedge" material="red"/>
    <geom name="plane" type="plane" size="1 1 0.1"/>
    <geom name="hidden" type="sphere" size="0.1" group="3"/>
    <geom name="clear" type="sphere" size="0.1" rgba="1 1 1 0"/>
    <body name="arm/link"><geom type="capsule" size="0.1 0.1" group="3"/></body>
    <body name="tilted" pos="0 0 1"><geom type="box" size="0.1 0.1 0.5" pos="1 0 0" euler="0 90 0" rgba="0 1 0 0.5"/></body>
  </worldbody>
</mujoco>
"""


@pytest.fixture(scope="module")
def model():
    return mujoco.MjModel.from_xml_string(SHAPES)


@pytest.mark.parametrize(
    ("name", "volume", "extents"),
    [
        ("box", 8 * 0.1 * 0.2 * 0.3, (0.2, 0.4, 0.6)),
        ("sphere", 4 / 3 * np.pi * 0.5**3, (1.0, 1.0, 1.0)),
        ("ellipsoid", 4 / 3 * np.pi * 0.1 * 0.2 * 0.4, (0.2, 0.4, 0.8)),
        ("cylinder", np.pi * 0.2**2 * 0.6, (0.4, 0.4, 0.6)),
        ("capsule", np.pi * 0.1**2 * (0.8 + 4 / 3 * 0.1), (0.2, 0.2, 1.0)),
        ("mesh", 1 / 6, None),
    ],
)
def test_a_shape_has_its_volume_and_lies_about_its_middle(model, name: str, volume: float, extents) -> None:
    vertices, faces = triangles(model, model.geom(name).id)
    made = trimesh.Trimesh(vertices, faces)
    # Polygons lie inside the round shapes that they stand for.
    assert 0.93 * volume <= abs(made.volume) <= volume * (1.0 + 1e-6)
    if extents is not None:
        np.testing.assert_allclose(made.extents, extents, rtol=0.02)
        np.testing.assert_allclose(made.bounds.sum(axis=0), 0.0, atol=1e-9)


def test_a_shape_is_made_once_and_nobody_can_change_it(model) -> None:
    ball = model.geom("sphere").id
    made = triangles(model, ball)
    assert triangles(mujoco.MjModel.from_xml_string(SHAPES), ball)[0] is made[0]
    with pytest.raises(ValueError, match="read-only"):
        made[0][0] = 0.0


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('size="0.1 0.2 0.3"', 'size="0.1 0.2 0.4"'),
        ('rgba="1 0 0 1"', 'rgba="1 0 1 1"'),
        ('0 0 1"/>\n    <material', '0 0 2"/>\n    <material'),
        ('pos="1 0 0" euler', 'pos="1 0 1" euler'),
        ('group="3"/>\n    <geom name="clear"', 'group="2"/>\n    <geom name="clear"'),
    ],
)
def test_two_models_look_the_same_if_the_same_is_drawn(model, old: str, new: str) -> None:
    assert old in SHAPES
    assert look_of(mujoco.MjModel.from_xml_string(SHAPES.replace('pos="0 0 1"', 'pos="0 0 2"'))) == look_of(model)
    assert look_of(mujoco.MjModel.from_xml_string(SHAPES.replace(old, new))) != look_of(model)


def test_a_plane_has_no_end(model) -> None:
    assert triangles(model, model.geom("plane").id) is None


def test_what_is_not_drawn_is_left_out_but_for_links_that_would_have_nothing(model) -> None:
    meshes = meshes_of(model)
    bodies = {model.body(m.body).name for m in meshes}
    assert bodies == {"world", "arm/link", "tilted"}
    world = [m for m in meshes if m.body == 0]
    assert {m.color for m in world} == {(128, 128, 128), (255, 0, 0)}
    grey = next(m for m in world if m.color[0] == 128)
    parts = sum(
        len(triangles(model, model.geom(n).id)[0]) for n in ("box", "sphere", "ellipsoid", "cylinder", "capsule")
    )
    assert len(grey.vertices) == parts
    assert grey.faces.max() == parts - 1


def test_shapes_are_placed_in_their_body(model) -> None:
    (mesh,) = [m for m in meshes_of(model) if model.body(m.body).name == "tilted"]
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    np.testing.assert_allclose(high - low, [1.0, 0.2, 0.2], atol=1e-9)
    np.testing.assert_allclose(high + low, [2.0, 0.0, 0.0], atol=1e-9)
    assert (mesh.color, mesh.opacity) == ((0, 255, 0), 0.5)


def test_a_scene_is_small_enough_for_a_page() -> None:
    model = build_scene(load_scenario("landing"), "free").model
    meshes = meshes_of(model)
    names = {model.body(m.body).name for m in meshes}
    assert {"arm/link_4", "armland_tool", "uav/uav", "uav/plate", "cradle"} <= names
    assert sum(len(m.vertices) for m in meshes) < 60_000
    assert len(meshes) < 60
