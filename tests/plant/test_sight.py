"""Rays against hand-worked views: nothing in the way, a plate that covers half, the edge of the picture."""

import mujoco
import numpy as np
import pytest

from armland.experiments.episode import prepare
from armland.plant.scene.eye import CAMERA, MARKER
from armland.plant.sight import AZIMUTHS, clear_angles, marker_pose, sight
from armland.rotations import matrix

WORLD = """
<mujoco>
  <worldbody>
    <camera name="{camera}" pos="0 0 0" quat="0 1 0 0" fovy="48"/>
    <geom name="{marker}" type="box" size=".03 .03 .0005" pos="{x} 0 .3005" quat="0 1 0 0" group="2"/>
    {more}
  </worldbody>
</mujoco>
"""


def seen(more="", x=0.0):
    model = mujoco.MjModel.from_xml_string(WORLD.format(camera=CAMERA, marker=MARKER, more=more, x=x))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    return sight(model, data), marker_pose(model, data)


def test_free_marker_is_seen_whole():
    whole, (position, quat) = seen()
    assert (whole.seen, whole.in_picture, whole.hidden_by) == (1.0, 1.0, ())
    assert whole.depth == pytest.approx(0.3)
    np.testing.assert_allclose(position, [0.0, 0.0, 0.3], atol=1e-12)
    np.testing.assert_allclose(matrix(quat), np.diag([1.0, -1.0, -1.0]), atol=1e-12)


def test_plate_before_one_half_hides_it():
    # At half the depth, what lies beyond x = 0 hides what lies beyond x = 0 on the marker.
    half, _ = seen('<geom name="lid" type="box" size=".05 .05 .001" pos=".05 0 .15" group="2"/>')
    assert half.seen == pytest.approx(10 / 21)
    assert (half.in_picture, half.hidden_by) == (1.0, ("lid",))


def test_collision_shapes_hide_nothing():
    whole, _ = seen('<geom name="lid" type="box" size=".05 .05 .001" pos=".05 0 .15" group="3"/>')
    assert whole.seen == 1.0


def test_what_is_beyond_the_pictures_edge_is_not_seen():
    # The edge lies at 0.3 tan 30° = 0.1732 m: the marker's middle, one of 21 columns, is just outside.
    cut, _ = seen(x=0.1733)
    assert cut.seen == cut.in_picture == pytest.approx(10 / 21)
    assert cut.hidden_by == ()


UAV_BODY = """
<mujoco>
  <worldbody>
    <body name="uav">
      <freejoint/>
      <geom type="box" size=".2 .2 .01" pos="0 0 .05" mass="1"/>
      <geom name="{marker}" type="box" size=".03 .03 .0005" pos="0 0 .0005" quat="0 1 0 0" group="2"/>
      {more}
    </body>
    {beside}
  </worldbody>
</mujoco>
"""


def clear(more="", beside="", largest=60.0):
    model = mujoco.MjModel.from_xml_string(UAV_BODY.format(marker=MARKER, more=more, beside=beside))
    return np.rad2deg(clear_angles(model, 1, np.deg2rad(largest)))


def test_marker_that_nothing_hides_is_seen_as_far_as_one_looks():
    np.testing.assert_allclose(clear(), 60.0)


def test_wall_hides_the_marker_from_behind_it_alone():
    """A wall 0.12 m aside, from the marker's plane 0.1 m down: the face's edge, 0.09 m from it, is hidden from 42° on.

    The marker's frame has x as the body and y against it, for its face looks down.
    """
    found = clear('<geom type="box" size=".001 .4 .05" pos=".12 0 -.05" group="1" mass="0"/>')
    assert 37.5 <= found[0] <= 45.0
    assert found[AZIMUTHS // 2] == pytest.approx(60.0)
    aside = clear('<geom type="box" size=".4 .001 .05" pos="0 .12 -.05" group="1" mass="0"/>')
    assert aside[3 * AZIMUTHS // 4] == pytest.approx(found[0])
    assert aside[AZIMUTHS // 4] == pytest.approx(60.0)


def test_what_is_not_of_the_uav_or_not_drawn_hides_nothing():
    np.testing.assert_allclose(clear(beside='<geom type="box" size=".001 .4 .05" pos=".12 0 -.05" group="1"/>'), 60.0)
    np.testing.assert_allclose(clear('<geom type="box" size=".001 .4 .05" pos=".12 0 -.05" group="3" mass="0"/>'), 60.0)


def test_hull_that_is_drawn_below_its_marker_has_it_on_its_outside():
    np.testing.assert_allclose(clear('<geom type="box" size=".1 .1 .05" pos="0 0 .02" group="1" mass="0"/>'), 60.0)


def test_demonstrators_skids_hide_the_marker_across_them_and_not_along_them(landing_scenario):
    simulator = prepare(landing_scenario, "landing", 1).simulator
    found = np.rad2deg(clear_angles(simulator.scene.model, simulator.scene.uav_body, np.deg2rad(45.0)))
    assert 25.0 <= found.min() <= 30.0
    assert found.argmin() in (0, 1, AZIMUTHS - 1)
    np.testing.assert_allclose(found[[AZIMUTHS // 4, 3 * AZIMUTHS // 4]], 45.0)
