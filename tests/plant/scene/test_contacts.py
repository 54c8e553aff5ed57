"""What may touch what: the table is complete where both shapes exist, and holds nothing else."""

import pytest

from armland.plant.scene.composition import build_scene


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
