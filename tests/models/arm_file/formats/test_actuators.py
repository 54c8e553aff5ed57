"""Torque limits and speeds from actuators of all kinds."""

import mujoco
import pytest

from armland.models.arm_file.formats.actuators import least, limits

BODY = (
    '<mujoco><compiler autolimits="true"/><worldbody><body><joint name="j"/><geom size="0.1"/></body></worldbody>'
    "<actuator>{}</actuator></mujoco>"
)


def of(*actuators):
    return limits(mujoco.MjModel.from_xml_string(BODY.format("".join(actuators)))).get(0, {})


@pytest.mark.parametrize(
    ("actuators", "torque"),
    [
        (['<motor joint="j" ctrlrange="-50 50"/>'], 50.0),
        (['<motor joint="j" ctrlrange="-1 1" gear="80"/>'], 80.0),
        (['<motor joint="j" ctrlrange="-50 50" forcerange="-30 30" gear="-2"/>'], 60.0),
        (['<general joint="j" gainprm="20" ctrlrange="-3 3"/>'], 60.0),
        (['<position joint="j" kp="900" forcerange="-87 87" ctrlrange="-3 3"/>'], 87.0),
        (['<general joint="j" gainprm="900" biasprm="0 -900 -90" biastype="affine" forcerange="-12 12"/>'], 12.0),
        (['<position joint="j" kp="900" ctrlrange="-3 3"/>'], None),
        (['<motor joint="j"/>'], None),
        (['<velocity joint="j" kv="5" forcerange="-9 9"/>', '<motor joint="j" ctrlrange="-70 70"/>'], 70.0),
        (['<motor joint="j" ctrlrange="-20 70"/>'], 20.0),
        (['<motor joint="j" ctrlrange="0 70"/>'], 70.0),
    ],
)
def test_torque_of_the_joint(actuators, torque):
    found = of(*actuators).get("torque")
    assert (found and found.number) == (None if torque is None else pytest.approx(torque))
    assert found is None or found.source == "actuator"


def test_velocity_servo_says_the_speed():
    assert of('<velocity joint="j" kv="5" ctrlrange="-2 2" gear="0.5"/>')["speed"].number == pytest.approx(4.0)
    assert "speed" not in of('<position joint="j" kp="5" ctrlrange="-2 2"/>')


def test_smaller_end_and_none():
    assert [least([-3.0, 2.0]), least([0.0, 5.0]), least([0.0, 0.0])] == [2.0, 5.0, None]
