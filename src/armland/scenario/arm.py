"""The arm and what it carries on its flange."""

from typing import Annotated

from pydantic import Field, model_validator

from armland.scenario.quantities import Angle, Coefficient, Factor, Length, Mass, PositiveSpeed, Section, Text, Torque

MOST_JOINTS = 64


class Arm(Section):
    """The robot arm: any serial arm from URDF or MJCF."""

    file: Text = Field(
        "lwr4.xml", description="arm that comes with armland, or a path relative to the scenario's folder"
    )
    ee: Text = Field("flange", description="site, body or link that carries the tool; its z axis points outwards")
    home_rad: Annotated[tuple[Angle, ...], Field(max_length=MOST_JOINTS)] | None = Field(
        None, description="joint positions near the start; searched if absent"
    )
    elbow_joint: Text | None = Field(None, description="joint at the elbow; the middle one if absent")
    default_armature_kgm2: Coefficient = Field(0.1, description="reflected motor inertia where the arm's file has none")
    inertia_scale: Factor = Field(
        1.0, description="factor on masses, inertias and reflected motor inertias of the file"
    )
    joint_speed_rad_s: Annotated[tuple[PositiveSpeed, ...], Field(min_length=1, max_length=MOST_JOINTS)] = Field(
        (1.92, 1.92, 2.23, 2.23, 2.27, 3.14, 3.14), description="rated speed of each joint"
    )
    brake_nm: Torque = Field(
        300.0, description="friction of a joint whose brake is on; assumption: enough for any pose"
    )


class Tool(Section):
    """What is mounted on the flange: force-torque sensor, then camera, magnet and the hinge's lower half."""

    sensor_mass_kg: Mass = Field(
        0.25, description="of the force-torque sensor, which the arm carries before it measures"
    )
    sensor_length_m: Length = Field(0.0504, description="flange to the sensor's far face, where its frame stands")
    tool_mass_kg: Mass = Field(0.30, description="of all beyond the sensor, which the sensor weighs")
    tool_com_m: Length = Field(0.025, description="sensor's far face to the centre of mass of what is beyond it")
    length_m: Length = Field(0.1064, description="flange to the hinge's pivot")

    @model_validator(mode="after")
    def _order(self) -> "Tool":
        if self.length_m <= self.sensor_length_m:
            raise ValueError(
                f"length_m = {self.length_m:g} must exceed sensor_length_m = {self.sensor_length_m:g}: the pivot lies beyond the sensor"
            )
        return self
