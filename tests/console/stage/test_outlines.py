"""Outlines: along the edges between seen and unseen faces they are what the convex hull of the projected corners is."""

import mujoco
import numpy as np
import pytest
from scipy.spatial import ConvexHull

from armland.console.stage.outlines import NEAR_M, Outlines, hull_of, outline
from armland.console.stage.poses import Poses
from armland.console.stage.shapes import triangles
from armland.console.stage.sight import Sight
from armland.plant.scene.eye import CAMERA
from armland.rotations import from_rotation_vector, matrix

HALF = np.array([0.8, 0.6])
SQUARE = np.array([[-0.1, -0.1, 1.0], [0.1, -0.1, 1.0], [0.1, 0.1, 1.0], [-0.1, 0.1, 1.0]])
RING = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
LOOK = np.eye(3)

SHAPES = """
<mujoco><worldbody>
  <geom type="box" size="0.1 0.2 0.3"/>
  <geom type="sphere" size="0.3"/>
  <geom type="ellipsoid" size="0.1 0.2 0.4"/>
  <geom type="cylinder" size="0.2 0.3"/>
  <geom type="capsule" size="0.1 0.4"/>
</worldbody></mujoco>
"""


def area(path: np.ndarray) -> float:
    """Of a polygon (k, 2), by the shoelace formula: a wrong order makes it smaller."""
    (u, v), (u_next, v_next) = path.T, np.roll(path, -1, axis=0).T
    return 0.5 * abs(float((u * v_next - v * u_next).sum()))


def by_hull(hull, place, turn, half=HALF):
    return outline(hull.corners @ turn.T + place, hull.edges, half)


@pytest.fixture(scope="module")
def solids():
    model = mujoco.MjModel.from_xml_string(SHAPES)
    return [hull_of(i, *triangles(model, i)) for i in range(model.ngeom)]


def test_both_ways_to_an_outline_agree(solids) -> None:
    rng = np.random.default_rng(1)
    outlines = Outlines(solids, HALF)
    for _ in range(40):
        turns = np.array([matrix(from_rotation_vector(rng.uniform(-2.0, 2.0, 3))) for _ in solids])
        places = rng.uniform([-1.0, -1.0, 1.0], [1.0, 1.0, 3.0], (len(solids), 3))
        wanted = {i: by_hull(h, places[i], turns[i]) for i, h in enumerate(solids)}
        got = {o.number: o for o in outlines.seen(places, turns, np.zeros(3), LOOK)}
        # What a box around a shape leaves in doubt may be kept.
        assert {i for i, path in wanted.items() if path is not None} <= set(got)
        for i, path in wanted.items():
            if path is not None:
                assert area(got[i].path) == pytest.approx(area(path), rel=1e-9)
                assert ConvexHull(got[i].path).volume == pytest.approx(area(path), rel=1e-9)
                assert got[i].depth == pytest.approx(places[i, 2])


def test_they_agree_in_a_landing_s_scene_too(recording) -> None:
    poses = Poses(recording.scene)
    outlines = Sight(poses, recording.scenario.camera)._outlines
    compared = 0
    for time in np.linspace(0.0, recording.end, 7):
        poses.set(recording.at(time)["truth"])
        centre, quat = poses.camera(CAMERA)
        R = matrix(quat)
        for seen in outlines.seen(poses.bodies[0], poses.turns, centre, R):
            hull = outlines._hulls[seen.number]
            points = (hull.corners @ poses.turns[hull.body].T + poses.bodies[0][hull.body] - centre) @ R
            wanted = outline(points, hull.edges, outlines._half)
            if wanted is not None:
                compared += 1
                assert area(seen.path) == pytest.approx(area(wanted), rel=1e-6)
    assert compared > 100


def test_a_camera_that_is_turned_and_moved_sees_the_same_as_one_at_rest(solids) -> None:
    turn, place = matrix(from_rotation_vector(np.array([0.3, -0.2, 0.5]))), np.array([1.0, 2.0, 3.0])
    places, turns = np.tile([0.1, 0.0, 2.0], (len(solids), 1)), np.tile(LOOK, (len(solids), 1, 1))
    rest = Outlines(solids, HALF).seen(places, turns, np.zeros(3), LOOK)
    moved = Outlines(solids, HALF).seen(places @ turn.T + place, turn @ turns, place, turn)
    assert len(rest) == len(moved) == len(solids)
    for a, b in zip(rest, moved, strict=True):
        assert a.number == b.number
        assert area(a.path) == pytest.approx(area(b.path))


def test_what_is_out_of_view_is_left_out(solids) -> None:
    outlines, turns = Outlines(solids, HALF), np.tile(LOOK, (len(solids), 1, 1))
    for place in ([0.0, 0.0, -2.0], [5.0, 0.0, 2.0], [0.0, -5.0, 2.0], [np.nan, 0.0, 2.0]):
        assert outlines.seen(np.tile(place, (len(solids), 1)), turns, np.zeros(3), LOOK) == []
    assert Outlines([], HALF).seen(np.zeros((1, 3)), turns[:1], np.zeros(3), LOOK) == []


def test_what_the_near_plane_cuts_and_what_is_flat_is_seen_all_the_same(solids) -> None:
    long = hull_of(0, np.array([[x, y, z] for x in (-0.1, 0.1) for y in (0.1, 0.2) for z in (-1.0, 1.0)]), None)
    flat = hull_of(0, SQUARE, np.array([[0, 1, 2], [0, 2, 3]]))
    assert len(flat.planes) == 0
    seen = Outlines([long, flat], HALF).seen(np.zeros((1, 3)), LOOK[None], np.zeros(3), LOOK)
    assert [o.number for o in seen] == [0, 1]
    assert area(seen[1].path) == pytest.approx(0.04)
    # It begins just before the camera, where it is far outside.
    assert np.abs(seen[0].path).max() == pytest.approx(0.2 / NEAR_M)


def test_what_reaches_behind_the_camera_is_cut_and_what_lies_there_is_not_drawn() -> None:
    assert len(outline(SQUARE, RING, HALF)) == 4
    half = SQUARE + [0.0, 0.05, 0.0]
    half[2:, 2] = -1.0
    cut = outline(half, RING, HALF)
    assert len(cut) == 4
    assert np.isfinite(cut).all()
    # Both edges are cut just before the camera, where they lie far outside.
    assert np.ptp(cut[:, 0]) == pytest.approx(0.2 / NEAR_M)
    assert outline(-SQUARE, RING, HALF) is None
    assert outline(SQUARE + [5.0, 0.0, 0.0], RING, HALF) is None
    # Seen edge on.
    assert outline(SQUARE * [1.0, 0.0, 1.0], RING, HALF) is None


def test_faces_go_round_in_one_direction(solids) -> None:
    for hull in solids:
        a, b, c = (hull.corners[np.roll(hull.starts, 1, axis=1)[:, k]] for k in range(3))
        outward = np.einsum("fi,fi->f", np.cross(b - a, c - a), hull.planes[:, :3])
        assert (outward > 0.0).all()
        # Each edge of a face is one of its neighbour's, the other way.
        ends = np.roll(hull.starts, -1, axis=1)
        for face, k in np.ndindex(hull.beside.shape):
            other = hull.beside[face, k]
            (back,) = np.flatnonzero(hull.beside[other] == face)
            assert (hull.starts[other, back], ends[other, back]) == (ends[face, k], hull.starts[face, k])
