"""Sensors and what they get wrong."""

from typing import Annotated

from pydantic import Field, model_validator

from armland.scenario.quantities import (
    Degrees,
    Distance,
    Factor,
    Force,
    Force3,
    Fraction,
    Hertz,
    Length,
    Milliseconds,
    Point,
    Section,
    Sigma,
    Tilt,
    Torque,
    Torque3,
    between,
)

View = Annotated[float, between(1.0, 170.0)]
SmallAngle = Annotated[float, between(0.0, 45.0)]


class Sensors(Section):
    """Standard deviations of white noise, and the force-torque sensor's filter and bias."""

    joint_position_rad: Sigma = Field(1e-5, description="noise of a joint's encoder")
    joint_velocity_rad_s: Sigma = Field(1e-3, description="noise of a joint's speed")
    force_n: Sigma = Field(0.05, description="noise of the force-torque sensor, each axis, before its filter")
    torque_nm: Sigma = Field(0.002, description="likewise")
    force_bias_n: Force3 = Field((0.0, 0.0, 0.0), description="beyond the one that is drawn; sensor axes")
    torque_bias_nm: Torque3 = Field((0.0, 0.0, 0.0), description="likewise")
    force_filter_hz: Hertz = Field(100.0, description="cut-off of the force-torque sensor's first-order low-pass")
    attitude_rad: Sigma = Field(2e-3, description="noise of the attitude that the UAV sends, each axis")
    rate_rad_s: Sigma = Field(1e-2, description="noise of its angular velocity, each axis")


class Camera(Section):
    """Camera on the tool and marker under the UAV. Both beside the axis, on the same side, so that it sees until contact."""

    position_m: Point = Field(
        (0.075, 0.0, -0.10), description="optical centre, end effector frame; it looks along its z"
    )
    marker_m: Point = Field(
        (0.075, 0.0, -0.03), description="marker's centre from the centre of mass, body; it looks down"
    )
    marker_size_m: Length = Field(0.06, description="edge of the black square")
    rate_hz: Annotated[int, Field(ge=1, le=1000)] = Field(30, description="images a second, at most the base rate")
    delay_ms: tuple[Milliseconds, Milliseconds] = Field(
        (50.0, 75.0), description="from exposure to arrival, uniform; tum_ardrone's video delay is the upper end"
    )
    field_of_view_deg: tuple[View, View] = Field((60.0, 48.0), description="full angles in image x and y; common lens")
    depth_min_m: Length = Field(0.05, description="closest focus; assumption")
    depth_max_per_size: Factor = Field(
        1.1 / 0.04, description="ratio of the largest depth to the marker's size, family 36h11"
    )
    incidence_max_deg: Tilt = Field(25.0, description="largest angle of sight to the marker's normal")
    reference_m: tuple[Length, Length] = Field((0.3, 1.0), description="depths of the two published precisions")
    lateral_m: tuple[Length, Length] = Field((0.4e-3, 0.7e-3), description="rc_visard manual, at the two depths")
    depth_m: tuple[Length, Length] = Field((0.9e-3, 3.3e-3), description="likewise, along the optical axis")
    focal_px: Annotated[float, between(1.0, 1e6)] = Field(
        1078.0, description="focal length in pixels: 960 over 48 degrees"
    )
    exposure_s: Annotated[float, between(0.0, 1.0)] = Field(4.0e-3, description="time of an exposure; assumption")
    honesty: Annotated[float, between(0.0, 100.0)] = Field(1.0, description="factor: real noise over claimed noise")
    lose: Fraction = Field(0.02, description="probability of a drop-out after a found marker; assumption")
    stay_lost: Fraction = Field(0.5, description="probability that a drop-out lasts another image; assumption")

    @model_validator(mode="after")
    def _order(self) -> "Camera":
        problems = []
        if self.delay_ms[0] > self.delay_ms[1]:
            problems.append(f"delay_ms = {list(self.delay_ms)}: the least delay stands first")
        if self.reference_m[0] >= self.reference_m[1]:
            problems.append(f"reference_m = {list(self.reference_m)}: the smaller depth stands first, and they differ")
        largest = self.depth_max_per_size * self.marker_size_m
        if self.depth_min_m >= largest:
            problems.append(
                f"depth_min_m = {self.depth_min_m:g} must be below depth_max_per_size x marker_size_m = {largest:g}: "
                "the marker would be seen at no depth"
            )
        if problems:
            raise ValueError("\n".join(problems))
        return self


class Imperfections(Section):
    """What is wrong for one seed and not for another: drawn within these bounds. Where the UAV is at the start is in `place`."""

    force_bias_n: Force = Field(1.0, description="of the force-torque sensor, each axis")
    torque_bias_nm: Torque = Field(0.05, description="each axis")
    heading_error_deg: Degrees = Field(10.0, description="heading that the UAV believes, against the world")
    tilt_error_deg: SmallAngle = Field(0.5, description="roll and pitch that the UAV believes")
    thrust_error: Annotated[float, between(0.0, 0.9)] = Field(
        0.05, description="thrust given over thrust asked for, less one: a share of it"
    )
    hover_noise_m: Distance = Field(
        0.01, description="white noise of the position that the UAV believes in its own hover"
    )
    camera: bool = Field(True, description="noise, delay and drop-outs of the camera; false: exact, at once")
    camera_mount_m: Distance = Field(0.0005, description="error of camera's and marker's place together, each axis")
    camera_angle_deg: SmallAngle = Field(0.1, description="error of the direction in which it looks, x and y")
    camera_scale: Annotated[float, between(0.0, 0.5)] = Field(
        0.003, description="error of its focal length, as a share of it"
    )
    noise: bool = Field(True, description="white noise of encoders, force-torque sensor and attitude")
