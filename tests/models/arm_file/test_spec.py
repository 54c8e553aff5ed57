"""The clean spec: the arm and nothing else, names that clash with nobody's, shapes that weigh and touch nothing by themselves."""

import mujoco
import numpy as np
import pytest

from armland.models.arm_file.reading import read_arm
from armland.models.description import ASSETS


@pytest.mark.parametrize(
    "name", ["floor.xml", "camera_overview.xml", "keyframe_ctrl.xml", "gravity_off.xml", "actuator_limits.xml"]
)
def test_nothing_but_the_arm_is_in_it(arm, name):
    model = arm(name).spec().compile()
    assert (model.nu, model.nsensor, model.nkey, model.ncam, model.nlight, model.neq, model.ntendon) == (0,) * 7
    np.testing.assert_allclose(model.opt.gravity, [0.0, 0.0, -9.81])
    assert model.opt.disableflags == mujoco.MjModel.from_xml_string("<mujoco/>").opt.disableflags
    names = [model.body(i).name for i in range(1, model.nbody)] + [model.joint(i).name for i in range(model.njnt)]
    assert all(n.startswith("arm/") for n in names)


def test_shapes_neither_weigh_nor_touch(arm):
    for file in (arm("ok.urdf"), read_arm(ASSETS / "lwr4.xml")):
        model = file.spec().compile()
        assert model.ngeom > 0
        assert not model.geom_contype.any()
        assert not model.geom_conaffinity.any()
        masses = [0.0 if k.inertial is None else k.inertial.mass for k in file.chain.links]
        np.testing.assert_allclose(model.body_mass[1:], masses)


def test_limits_are_the_tables(arm):
    file = arm("no_effort.urdf")
    model = file.spec().compile()
    assert model.jnt_limited.all()
    assert model.jnt_actfrclimited.all()
    np.testing.assert_allclose(model.jnt_actfrcrange[:, 1], [r.torque.number for r in file.rows])
    np.testing.assert_allclose(model.jnt_range, [[r.low.number, r.high.number] for r in file.rows])
    np.testing.assert_allclose(model.dof_armature, [r.armature.number for r in file.rows])


def test_shapes_for_contact_have_names_and_looks_have_none(changed):
    geoms = '<geom type="box" size="0.1 0.1 0.1" contype="0" conaffinity="0"/><geom type="sphere" size="0.1"/><joint name="j3"'
    model = read_arm(changed("ok.xml", ('<joint name="j3"', geoms))).spec().compile()
    own = [model.geom(i) for i in range(model.ngeom) if model.body(int(model.geom_bodyid[i])).name == "arm/l3"]
    assert [(g.name.startswith("arm/shape_"), int(g.group[0])) for g in own] == [(False, 2), (True, 3)]
    # A link that is only drawn is touched as it is drawn.
    seen = read_arm(changed("ok.xml", ('<joint name="j3"', geoms.replace('<geom type="sphere" size="0.1"/>', ""))))
    model = seen.spec().compile()
    own = [model.geom(i) for i in range(model.ngeom) if model.body(int(model.geom_bodyid[i])).name == "arm/l3"]
    assert [(g.name.startswith("arm/shape_"), int(g.group[0])) for g in own] == [(True, 2)]


def test_shapes_are_named_by_the_body_that_has_them(changed):
    """A locked finger is part of the last link, and is still called a finger."""
    ball = '<collision><geometry><sphere radius="0.01"/></geometry></collision></link>\n  <joint name="grip_l"'
    model = read_arm(changed("gripper.urdf", ('</link>\n  <joint name="grip_l"', ball))).spec().compile()
    (found,) = (model.geom(i) for i in range(model.ngeom) if model.geom(i).name.endswith(":finger_l"))
    assert model.body(int(found.bodyid[0])).name == "arm/l7"
