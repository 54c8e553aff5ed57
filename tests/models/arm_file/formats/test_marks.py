"""Meshes of an MJCF are where MuJoCo puts them, though none of their files is opened."""

import numpy as np
import pytest

from armland.models.arm_file.reading import read_tree

FILE = """
<mujoco>
  <compiler angle="degree" meshdir="parts"/>
  <default><default class="seen"><geom contype="0" conaffinity="0" type="mesh"/></default></default>
  <asset>
    <mesh name="arm" file="arm.stl" scale="0.001 0.001 0.002"/>
    <mesh name="moved" file="arm.stl" refpos="1 0 0"/>
    <mesh name="own" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>
  </asset>
  <worldbody>
    <body name="link">
      <joint name="j"/>
      <inertial pos="0 0 0" mass="2" diaginertia="0.1 0.1 0.1"/>
      <geom type="mesh" mesh="arm" pos="0.1 0.2 0.3" euler="0 0 90"/>
      <geom class="seen" mesh="arm" axisangle="1 0 0 180"/>
      <geom type="mesh" mesh="moved"/>
      <geom type="mesh" mesh="own"/>
      <geom type="sphere" size="0.05"/>
    </body>
  </worldbody>
</mujoco>
"""


@pytest.fixture
def link(tmp_path):
    path = tmp_path / "arm.xml"
    path.write_text(FILE)
    (body,) = read_tree(path).bodies
    return body


def test_pose_scale_file_and_purpose_are_the_geoms(link, tmp_path):
    touched, seen = link.meshes
    assert touched.file == seen.file == str(tmp_path / "parts" / "arm.stl")
    np.testing.assert_allclose(touched.scale, [1e-3, 1e-3, 2e-3])
    np.testing.assert_allclose(touched.pose.pos, [0.1, 0.2, 0.3])
    np.testing.assert_allclose(touched.pose.quat, [0.5**0.5, 0.0, 0.0, 0.5**0.5], atol=1e-12)
    np.testing.assert_allclose(np.abs(seen.pose.quat), [0.0, 1.0, 0.0, 0.0], atol=1e-12)
    assert (touched.touches, seen.touches) == (True, False)


def test_spheres_that_mark_meshes_are_no_shapes_and_weigh_nothing(link):
    assert [s.kind for s in link.shapes] == ["sphere"]
    assert link.inertial.mass == 2.0
