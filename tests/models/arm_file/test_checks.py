"""What is suspicious, and that a healthy arm is not."""

import pytest

from armland.models.arm_file.checks import suspicious
from armland.models.arm_file.reading import read_arm
from armland.models.arm_file.strength import held
from armland.models.description import ASSETS


def lines(file):
    return suspicious(file, held(file.spec().compile()))


def test_healthy_arms_are_not(arm):
    assert lines(arm("ok.urdf")) == lines(arm("ok.xml")) == lines(read_arm(ASSETS / "lwr4.xml")) == []


@pytest.mark.parametrize(
    ("pairs", "words"),
    [
        ([('<mass value="5"/>', '<mass value="1000"/>')], "link 'l1' weighs 1000 kg"),
        ([('<mass value="3"/>', '<mass value="300"/>')], "like solid steel"),
        (
            [('ixx="0.00310" iyy="0.00310" izz="0.00186"', 'ixx="0.033" iyy="0.033" izz="0.033"')],
            "link 'l7' turns like a body of 0.3",
        ),
        ([(f'effort="{e}"', 'effort="300"') for e in ("200", "120", "100", "40")], "all torque limits are 300"),
        ([('velocity="3"', 'velocity="10"')], "speeds above 7 rad/s: j1 10"),
        ([('effort="120"', 'effort="5000"')], "like a placeholder's: j3, j4"),
    ],
)
def test_slips_are_said(changed, pairs, words):
    assert any(words in line for line in lines(read_arm(changed("ok.urdf", *pairs))))


def test_weak_joint_and_leaning_base_are_said(arm):
    assert any("'j2' gives 10 N·m, less than" in line for line in lines(arm("weak.urdf")))
    assert any("90° from upright" in line for line in lines(arm("t5_wall.urdf")))
    assert any("10° from upright" in line for line in lines(arm("t5_tilted10.urdf")))
