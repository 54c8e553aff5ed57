"""Sensors and what they get wrong."""

from typing import Annotated

from pydantic import Field

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key

View = Annotated[float, between(1.0, 170.0)]
SmallAngle = Annotated[float, between(0.0, 45.0)]


class Sensors(Section):
    """Standard deviations of white noise, and the force-torque sensor's filter and bias."""

    joint_position_rad: of.Sigma = key(1e-5, "noise of a joint's encoder")
    joint_velocity_rad_s: of.Sigma = key(1e-3, "noise of a joint's speed")
    force_n: of.Sigma = key(0.05, "noise of the force-torque sensor, each axis, before its filter")
    torque_nm: of.Sigma = key(0.002, "likewise")
    force_bias_n: of.Force3 = key((0.0, 0.0, 0.0), "beyond the one that is drawn; sensor axes")
    torque_bias_nm: of.Torque3 = key((0.0, 0.0, 0.0), "likewise")
    force_filter_hz: of.Hertz = key(100.0, "cut-off of the force-torque sensor's first-order low-pass")
    attitude_rad: of.Sigma = key(2e-3, "noise of the attitude that the UAV sends, each axis")
    rate_rad_s: of.Sigma = key(1e-2, "noise of its angular velocity, each axis")
    acceleration_mps2: of.Sigma = key(
        0.05,
        "noise of its accelerometers, each axis, mean of a sample; BMA280: 120 µg/√Hz, 0.012 m/s² of it; the rest, the rotors' "
        "vibration, is an assumption",
    )


class Camera(Section):
    """Camera on the tool and marker under the UAV. Both beside the axis, on the same side, so that it sees until contact."""

    position_m: of.Point = key((0.075, 0.0, -0.10), "optical centre, end effector frame; it looks along its z")
    marker_m: of.Point = key((0.075, 0.0, -0.03), "marker's centre from the centre of mass, body; it looks down")
    marker_size_m: of.Length = key(0.06, "edge of the black square")
    rate_hz: Annotated[int, Field(ge=1, le=1000)] = key(30, "images a second, at most the base rate")
    delay_ms: tuple[of.Milliseconds, of.Milliseconds] = key(
        (50.0, 75.0), "from exposure to arrival, uniform; tum_ardrone's video delay is the upper end"
    )
    field_of_view_deg: tuple[View, View] = key((60.0, 48.0), "full angles in image x and y; common lens")
    depth_min_m: of.Length = key(0.05, "closest focus; assumption")
    depth_max_per_size: of.Factor = key(1.1 / 0.04, "ratio of the largest depth to the marker's size, family 36h11")
    incidence_max_deg: of.Tilt = key(
        45.0,
        "largest angle of sight to the marker's normal at which the detector errs no more than the model; docs/camera.md",
    )
    hidden_from_deg: of.Tilt = key(
        25.0,
        "angle from which on the UAV's own skids may hide the marker, as the controller believes; the plant finds it by rays",
    )
    reference_m: tuple[of.Length, of.Length] = key((0.3, 1.0), "depths of the two published precisions")
    lateral_m: tuple[of.Length, of.Length] = key((0.4e-3, 0.7e-3), "rc_visard manual, at the two depths")
    depth_m: tuple[of.Length, of.Length] = key((0.9e-3, 3.3e-3), "likewise, along the optical axis")
    focal_px: Annotated[float, between(1.0, 1e6)] = key(1078.0, "focal length in pixels: 960 over 48 degrees")
    exposure_s: Annotated[float, between(0.0, 1.0)] = key(4.0e-3, "time of an exposure; assumption")
    honesty: Annotated[float, between(0.0, 100.0)] = key(1.0, "factor: real noise over claimed noise")
    lose: of.Fraction = key(0.02, "probability of a drop-out after a found marker; assumption")
    stay_lost: of.Fraction = key(0.5, "probability that a drop-out lasts another image; assumption")

    def _contradictions(self) -> list[str]:
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
        return problems


class MotionReference(Section):
    """Motion reference unit beside the arm's base, where the sea moves the deck: on land there is none. Biases: standard deviations."""

    rate_hz: of.Rate = key(100, "samples a second, Seatex MRU 5; divides the base rate")
    delay_ms: of.Milliseconds = key(10.0, "from sampling to arrival; assumption")
    tilt_deg: SmallAngle = key(0.03, "error of roll and pitch that stays for a run; MRU 5, dynamic accuracy")
    heading_deg: SmallAngle = key(0.5, "likewise of the heading; assumption")
    tilt_noise_deg: SmallAngle = key(0.005, "noise of a sample's attitude; assumption")
    rate_bias_deg_s: of.Sigma = key(0.003, "error of the rates, deg/s, that stays; 10 deg/h, MTi-300")
    rate_noise_deg_s: of.Sigma = key(0.07, "noise of a sample's rates, deg/s; 0.01 deg/s/√Hz over 50 Hz, MTi-300")
    velocity_mps: of.Speed = key(0.02, "error of the velocity that stays; assumption")
    velocity_noise_mps: of.Speed = key(0.003, "noise of a sample's velocity; assumption")
    acceleration_bias_mps2: of.Sigma = key(0.01, "error of the acceleration, m/s², that stays; assumption: 1 mg")
    acceleration_noise_mps2: of.Sigma = key(0.0042, "noise of a sample's, m/s²; 60 µg/√Hz over 50 Hz, MTi-300")


class Imperfections(Section):
    """What is wrong for one seed and not for another: drawn within these bounds. Where the UAV is at the start is in `place`."""

    force_bias_n: of.Force = key(1.0, "of the force-torque sensor, each axis")
    torque_bias_nm: of.Torque = key(0.05, "each axis")
    heading_error_deg: of.Degrees = key(10.0, "heading that the UAV believes, against the world")
    tilt_error_deg: SmallAngle = key(0.5, "roll and pitch that the UAV believes")
    thrust_error: Annotated[float, between(0.0, 0.9)] = key(
        0.05, "thrust given over thrust asked for, less one: a share of it"
    )
    acceleration_bias_mps2: Annotated[float, between(0.0, 100.0)] = key(
        0.5, "of its accelerometers, each axis; BMA280: zero-g offset of 50 mg over its life"
    )
    hover_noise_m: of.Distance = key(0.01, "white noise of the position that the UAV believes in its own hover")
    camera: bool = key(True, "noise, delay and drop-outs of the camera; false: exact, at once")
    camera_mount_m: of.Distance = key(0.0005, "error of camera's and marker's place together, each axis")
    camera_angle_deg: SmallAngle = key(0.1, "error of the direction in which it looks, x and y")
    camera_scale: Annotated[float, between(0.0, 0.5)] = key(0.003, "error of its focal length, as a share of it")
    noise: bool = key(True, "white noise of encoders, force-torque sensor and attitude")
