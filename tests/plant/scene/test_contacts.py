"""What may touch what: the table is complete where both shapes exist, and holds nothing else."""

import mujoco
import numpy as np
import pytest

from armland.plant.scene import contacts
from armland.plant.scene.composition import build_scene
from armland.plant.scene.contacts import add_contacts


def pairs(model):
    both = zip(model.pair_geom1, model.pair_geom2, strict=True)
    return {frozenset(model.geom(int(i)).name.split("/")[-1] for i in pair) for pair in both}


def test_what_must_not_pass_through_each_other_touches(landing):
    table = pairs(build_scene(landing(), "free").model)
    for one, other in (
        ("skid_1", "rail_2"),
        ("skid_2", "floor"),
        ("frame_1", "tool"),
        ("plate", "rail_1"),
        ("rail_1", "camera"),
        ("pad_3", "plate"),
        ("link_6_shape", "floor"),
    ):
        assert frozenset((one, other)) in table


def test_arm_and_uav_do_not_touch_themselves(landing):
    arm = {"tool", "camera", "link_4_shape", "link_5_shape", "link_6_shape"}
    uav = {"skid_1", "skid_2", "frame_1", "frame_2", "plate"}
    for pair in pairs(build_scene(landing(), "free").model):
        assert not pair <= arm
        assert not pair <= uav


@pytest.mark.parametrize("parts", [(), ("cradle",), ("camera", "magnet")])
def test_table_shrinks_with_the_parts(landing, parts):
    table = pairs(build_scene(landing(), "free", parts).model)
    names = set().union(*table)
    assert ("rail_1" in names) == ("cradle" in parts)
    assert ("camera" in names) == ("camera" in parts)
    assert ("pad_1" in names) == ("magnet" in parts)


def test_hinged_uav_touches_nothing(paper):
    assert build_scene(paper(), "hinged").model.npair == 0


WEIGHT = 5.0 * 9.81


def slid(push):
    """Force between skids and rails over the weight (k,), of a block of 5 kg on two rails, pushed with a share of their friction."""
    spec = mujoco.MjSpec()
    spec.option.timestep, spec.option.cone, spec.option.impratio = 1e-3, mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    kind = {"type": mujoco.mjtGeom.mjGEOM_CAPSULE, "contype": 0, "conaffinity": 0}
    block = spec.worldbody.add_body(name="block", pos=[0.0, 0.0, 0.018])
    block.add_freejoint()
    block.mass, block.inertia, block.explicitinertial = 5.0, [0.05, 0.05, 0.05], True
    for i, at in ((1, -0.13), (2, 0.13)):
        spec.worldbody.add_geom(name=f"rail_{i}", fromto=[-0.4, at, 0.0, 0.4, at, 0.0], size=[0.012, 0, 0], **kind)
        block.add_geom(name=f"uav/skid_{i}", fromto=[at, -0.19, 0.0, at, 0.19, 0.0], size=[0.006, 0, 0], **kind)
    add_contacts(spec, [])
    model = spec.compile()
    data, force, borne = mujoco.MjData(model), np.zeros(6), []
    for k in range(240):
        # It settles, and is then pushed for 20 ms.
        data.qfrc_applied[0] = 0.8 * push * WEIGHT if 200 <= k < 220 else 0.0
        mujoco.mj_step(model, data)
        total = 0.0
        for i in range(data.ncon):
            mujoco.mj_contactForce(model, data, i, force)
            total += force[0]
        borne.append(total / WEIGHT)
    return np.array(borne[195:])


def test_skids_bear_at_every_step_up_to_the_end_of_their_friction():
    for push in (0.0, 0.5, 0.9, 0.98):
        np.testing.assert_allclose(slid(push), 1.0, atol=0.05)


def test_harder_contact_near_the_end_of_its_friction_bears_nothing_at_times(monkeypatch):
    """It opens for a step, and the next one makes up for it by a blow."""
    monkeypatch.setattr(contacts, "BEARING", contacts.HARD)
    borne = slid(0.98)
    assert borne.min() < 0.5
    assert borne.max() > 2.0
