"""Depths by hand: of a mesh in each primitive, in another mesh, and where only its convex hull meets something."""

import mujoco
import numpy as np
import pytest

from armland.experiments.judge.depth import APART_M, EDGE_M, Depths, depth_in, spread, winding

SQUARE = [(0, 0), (0.2, 0), (0.2, 0.2), (0, 0.2)]
ANGLE = [(0, 0), (0.4, 0), (0.4, 0.1), (0.1, 0.1), (0.1, 0.4), (0, 0.4)]
"""Outlines: of a block, and of a bracket whose hull fills its inner corner."""

FANS = {4: [(0, 1, 2), (0, 2, 3)], 6: [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]}


def prism(outline, height=0.1):
    """Vertices and faces of an outline that is drawn out along z, seen from outside against the clock."""
    n = len(outline)
    vertices = [(x, y, z) for z in (0.0, height) for x, y in outline]
    faces = [(a, c, b) for a, b, c in FANS[n]] + [(a + n, b + n, c + n) for a, b, c in FANS[n]]
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, j + n), (i, j + n, i + n)]
    return np.array(vertices, float), np.array(faces)


def scene(other, outline=ANGLE):
    """Contacts' world: the prism at rest, and another geom."""
    vertices, faces = prism(outline)
    text = [" ".join(map(str, x.ravel())) for x in (vertices, faces)]
    asset = f'<mesh name="m" vertex="{text[0]}" face="{text[1]}" inertia="shell"/>'
    bodies = f'<body><geom type="mesh" mesh="m" mass="0"/></body><body>{other}</body>'
    model = mujoco.MjModel.from_xml_string(f"<mujoco><asset>{asset}</asset><worldbody>{bodies}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return model, data


def depth(other, outline=ANGLE):
    model, data = scene(other, outline)
    return Depths(model).of(data, 0, 1), Depths(model).of(data, 1, 0)


def test_ball_in_the_inner_corner_is_in_the_hull_and_not_in_the_mesh():
    ball = '<geom type="sphere" size="0.05" pos="0.18 0.18 0.05"/>'
    model, data = scene(ball)
    assert mujoco.mj_geomDistance(model, data, 0, 1, 1.0, None) < -0.02
    assert depth(ball) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        ('<geom type="sphere" size="0.05" pos="0.3 0.13 0.05"/>', 0.02),
        ('<geom type="box" size="0.05 0.05 0.2" pos="0.3 0.14 0.05"/>', 0.01),
        ('<geom type="capsule" size="0.05 0.1" pos="0.3 0.13 0.05"/>', 0.02),
        ('<geom type="cylinder" size="0.05 0.2" pos="0.3 0.13 0.05"/>', 0.02),
        ('<geom type="plane" size="1 1 1" pos="0 0 0.03"/>', 0.03),
    ],
)
def test_depth_in_a_primitive_by_hand(other, expected):
    """Points stand up to 12 mm apart: a round shape is touched a little beside its deepest place."""
    one, two = depth(other)
    assert one == two == pytest.approx(expected, abs=1.5e-3)


def test_depth_in_another_mesh_is_to_its_surface():
    outline = " ".join(map(str, (prism(SQUARE)[0] + [0.36, -0.05, 0.02]).ravel()))
    faces = " ".join(map(str, prism(SQUARE)[1].ravel()))
    vertices, own = prism(ANGLE)
    text = [" ".join(map(str, x.ravel())) for x in (vertices, own)]
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><asset><mesh name="m" vertex="{text[0]}" face="{text[1]}" inertia="shell"/>'
        f'<mesh name="n" vertex="{outline}" face="{faces}" inertia="shell"/></asset><worldbody>'
        '<geom type="mesh" mesh="m" mass="0"/><geom type="mesh" mesh="n" mass="0"/></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    # The bracket's arm ends at x = 0.4, 40 mm inside the block.
    assert Depths(model).of(data, 0, 1) == pytest.approx(0.04, abs=6e-3)


def test_winding_number_is_one_inside_and_zero_outside_of_a_concave_solid():
    vertices, faces = prism(ANGLE)
    found = winding(
        np.array([[0.05, 0.3, 0.05], [0.3, 0.05, 0.02], [0.2, 0.2, 0.05], [-0.1, 0.0, 0.0]]), vertices[faces]
    )
    np.testing.assert_allclose(found, [1.0, 1.0, 0.0, 0.0], atol=1e-9)


def test_points_are_all_over_the_surface_and_not_too_many():
    vertices, faces = prism(ANGLE)
    points = spread(vertices[faces])
    rng = np.random.default_rng(0)
    shares = rng.dirichlet(np.ones(3), 2000)
    there = np.einsum("kc,kcx->kx", shares, vertices[faces][rng.integers(len(faces), size=2000)])
    nearest = [np.linalg.norm(points - p, axis=1).min() for p in there]
    assert max(nearest) < EDGE_M
    assert len(points) < 40.0 * (2 * 0.07 + 1.6 * 0.1) / EDGE_M**2 * (EDGE_M / APART_M) / 10.0


def test_ellipsoid_is_never_said_to_be_deeper_than_it_is():
    size, rng = np.array([0.1, 0.2, 0.05]), np.random.default_rng(1)
    p = rng.uniform(-1.0, 1.0, (400, 3)) * size
    surface = rng.normal(size=(20000, 3))
    surface = surface / np.linalg.norm(surface, axis=1)[:, None] * size
    true = np.array([np.linalg.norm(surface - x, axis=1).min() for x in p])
    inside = np.linalg.norm(p / size, axis=1) < 1.0
    found = depth_in(int(mujoco.mjtGeom.mjGEOM_ELLIPSOID), size, p)
    assert (found[inside] <= true[inside] + 1e-3).all()
    assert (found[~inside] <= 0.0).all()
