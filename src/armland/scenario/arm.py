"""The arm and what it carries on its flange."""

from typing import Annotated

from pydantic import Field

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, key

MOST_JOINTS = 64
EACH = Field(min_length=1, max_length=MOST_JOINTS)


class Arm(Section):
    """The robot arm: any serial arm from URDF or MJCF."""

    file: of.Text = key("lwr4.xml", "arm that comes with armland, or a path relative to the scenario's folder")
    ee: of.Text | None = key(
        None, "site, body or link that carries the tool, z outwards; NAME:x where x points outwards; chosen if absent"
    )
    lock: Annotated[dict[of.Text, of.Angle], Field(max_length=MOST_JOINTS)] = Field(
        default_factory=dict,
        description="joints that stand still, by name, and where, the number in rad or m; those off the chain do so anyway",
    )
    home_rad: Annotated[tuple[of.Angle, ...], Field(max_length=MOST_JOINTS)] | None = key(
        None, "joint positions near the start; searched if absent"
    )
    elbow_joint: of.Text | None = key(None, "joint at the elbow; found from geometry if absent")
    default_armature_kgm2: of.Coefficient | None = key(
        None, "reflected motor inertia where the arm's file has none; by rule, 0.1 for arms of 5 kg and more, if absent"
    )
    inertia_scale: of.Factor = key(1.0, "factor on masses, inertias and reflected motor inertias of the file")
    joint_speed_rad_s: Annotated[tuple[of.PositiveSpeed, ...], EACH] | None = key(
        None, "rated speed of each joint; the file's, or by rule, if absent"
    )
    torque_limits_nm: Annotated[tuple[of.PositiveTorque, ...], EACH] | None = key(
        None, "largest torque of each joint; the file's, or by rule, if absent"
    )
    torque_rate_nm_s: Annotated[tuple[of.Gain, ...], EACH] | None = key(
        None, "largest rate of each joint's torque; the file's, or by rule, if absent"
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
