"""Landings of somebody else's arm, each with one oddity of real files. Slow: an arm flies for seconds."""

from pathlib import Path

import pytest

from armland.cli.options import load
from armland.experiments.episode import fly

ARMS = Path(__file__).parents[1] / "data" / "arms"
LAND = (
    *(
        "ok.urdf",
        "ok.xml",
        "no_effort.urdf",
        "continuous_no_limit_tag.urdf",
        "actuator_limits.xml",
        "position_servos.xml",
    ),
    *("default_motor_ctrlrange.xml", "contact_disabled.xml", "gravity_off.xml", "gravity_flag_off.xml", "floor.xml"),
    *(
        "camera_overview.xml",
        "name_clash_floor.urdf",
        "name_clash_world.urdf",
        "keyframe_ctrl.xml",
        "gripper.urdf",
        "rail.urdf",
    ),
    *(
        "t18_meshes_missing.xml",
        "friction1.urdf",
        "damping10.urdf",
        "space_names.urdf",
        "t5_pedestal.urdf",
        "onesided.xml",
    ),
)


@pytest.mark.slow
@pytest.mark.parametrize("name", LAND)
def test_arm_lands_with_nothing_set_but_its_file(name):
    result = fly(load("landing", {"arm": str(ARMS / name)}), "landing", 1).result
    assert result["success"], result["reason"]
    assert result["limits_violated"] == []
