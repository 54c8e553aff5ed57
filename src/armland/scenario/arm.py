"""The arm and what it carries on its flange."""

from typing import Annotated

from pydantic import Field

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, key

MOST_JOINTS = 64


class Arm(Section):
    """The robot arm: any serial arm from URDF or MJCF."""

    file: of.Text = key("lwr4.xml", "arm that comes with armland, or a path relative to the scenario's folder")
    ee: of.Text = key("flange", "site, body or link that carries the tool; its z axis points outwards")
    home_rad: Annotated[tuple[of.Angle, ...], Field(max_length=MOST_JOINTS)] | None = key(
        None, "joint positions near the start; searched if absent"
    )
    elbow_joint: of.Text | None = key(None, "joint at the elbow; the middle one if absent")
    default_armature_kgm2: of.Coefficient = key(0.1, "reflected motor inertia where the arm's file has none")
    inertia_scale: of.Factor = key(1.0, "factor on masses, inertias and reflected motor inertias of the file")
    joint_speed_rad_s: Annotated[tuple[of.PositiveSpeed, ...], Field(min_length=1, max_length=MOST_JOINTS)] = key(
        (1.92, 1.92, 2.23, 2.23, 2.27, 3.14, 3.14), "rated speed of each joint"
    )
    width_m: of.Length = key(0.12, "widest part that passes the cradle's slot")
    brake_nm: of.Torque = key(300.0, "friction of a joint whose brake is on; assumption: enough for any pose")


class Tool(Section):
    """What is mounted on the flange: force-torque sensor, then camera, magnet and the hinge's lower half."""

    rising = (("sensor_length_m", "length_m", "the pivot lies beyond the sensor"),)

    sensor_mass_kg: of.Mass = key(0.25, "of the force-torque sensor, which the arm carries before it measures")
    sensor_length_m: of.Length = key(0.0504, "flange to the sensor's far face, where its frame stands")
    tool_mass_kg: of.Mass = key(0.30, "of all beyond the sensor, which the sensor weighs")
    tool_com_m: of.Length = key(0.025, "sensor's far face to the centre of mass of what is beyond it")
    length_m: of.Length = key(0.1064, "flange to the hinge's pivot")
