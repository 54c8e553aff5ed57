"""What stands in the way of an arm that can land nowhere: the first condition that no upright pose fulfils."""

from pathlib import Path

import pytest

from armland.mission.feasibility.hindrance import hindrance
from armland.mission.registry import MISSIONS
from armland.scenario import load_scenario

LINK = """<link name="l{i}"><inertial><mass value="1"/>
<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j{i}" type="revolute"><parent link="{parent}"/><child link="l{i}"/><origin xyz="0 0 {up}"/><axis xyz="{axis}"/>
<limit lower="-2.9" upper="2.9" effort="200" velocity="3"/></joint>"""


def told(tmp_path: Path, axes: list[str], lowest: float = 0.3, **arm: object) -> str:
    """The hindrance of an arm of links of 0.25 m about `axes`, its first joint `lowest` m above the floor."""
    links = [
        LINK.format(i=i, parent="base" if i == 0 else f"l{i - 1}", up=lowest if i == 0 else 0.25, axis=axis)
        for i, axis in enumerate(axes)
    ]
    file = tmp_path / "arm.urdf"
    file.write_text(f'<robot name="arm"><link name="base"/>{"".join(links)}</robot>')
    scenario = load_scenario("landing", {"arm": {"file": str(file), "ee": f"l{len(axes) - 1}", **arm}})
    return hindrance(scenario, MISSIONS["landing"])


def test_joints_that_all_turn_alike_move_no_tool_in_all_directions(tmp_path):
    said = told(tmp_path, ["0 0 1", *["0 1 0"] * 5])
    assert "none has a smallest singular value of 0.036" in said
    assert said.endswith("at most 0.000")


def test_weak_joints_are_told(tmp_path):
    axes = ["0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"]
    assert "takes up to 0.9 of the joints' torques" in told(tmp_path, axes, torque_limits_nm=[2.0] * 6)


def test_arm_that_can_land_has_none(tmp_path):
    assert hindrance(load_scenario("landing"), MISSIONS["landing"]) == ""


@pytest.mark.parametrize("lowest", [-1.0, -0.6])
def test_arm_that_begins_below_the_floor_is_told_of_it_or_of_its_height(tmp_path, lowest):
    said = told(tmp_path, ["0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"], lowest)
    assert "is clear of the floor" in said or "m of height" in said
