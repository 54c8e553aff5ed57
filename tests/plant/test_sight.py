"""Rays against hand-worked views: nothing in the way, a plate that covers half, the edge of the picture."""

import mujoco
import numpy as np
import pytest

from armland.plant.scene.eye import CAMERA, MARKER
from armland.plant.sight import marker_pose, sight
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
