"""What a scenario holds: typed, frozen, strict. Names carry units; frames are the world's unless said otherwise."""

from typing import Annotated, Literal

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Vector3 = tuple[Finite, Finite, Finite]
Positive3 = tuple[Positive, Positive, Positive]
Positive6 = tuple[Positive, Positive, Positive, Positive, Positive, Positive]


class Section(BaseModel):
    """A table of a scenario: frozen, unknown keys are errors, numbers are never guessed from text."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


def _inertia(value: tuple[Vector3, Vector3, Vector3]) -> tuple[Vector3, Vector3, Vector3]:
    J = np.array(value)
    if not np.allclose(J, J.T, rtol=0.0, atol=1e-12):
        raise ValueError("inertia must be symmetric")
    eigenvalues = np.linalg.eigvalsh(J)
    if eigenvalues[0] <= 0.0:
        raise ValueError(f"inertia must be positive definite; its smallest eigenvalue is {eigenvalues[0]:g} kg·m²")
    if eigenvalues[0] + eigenvalues[1] < eigenvalues[2] * (1.0 - 1e-9):
        raise ValueError(
            f"no rigid body has the principal inertias {eigenvalues[0]:g}, {eigenvalues[1]:g}, {eigenvalues[2]:g} kg·m²: "
            "the two smaller must add up to at least the largest"
        )
    return value


Inertia = Annotated[tuple[Vector3, Vector3, Vector3], AfterValidator(_inertia)]


class Run(Section):
    """Time and randomness."""

    seed: int = Field(1, ge=0, description="seed of every random stream; each stream also has its own name")
    rate_hz: int = Field(1000, ge=100, le=10000, description="base rate of physics and control")
    settle_s: NonNegative = Field(1.0, description="rest before the trajectory starts; not judged")
    tail_s: NonNegative = Field(1.0, description="rest after the trajectory ends; judged")


class Arm(Section):
    """The robot arm: any serial arm from URDF or MJCF."""

    file: str = Field(
        "lwr4.xml", description="arm that comes with armland, or a path relative to the scenario's folder"
    )
    ee: str = Field("flange", description="site, body or link that carries the tool; its z axis points outwards")
    home_rad: tuple[Finite, ...] | None = Field(None, description="joint positions near the start; searched if absent")
    elbow_joint: str | None = Field(None, description="joint at the elbow; the middle one if absent")
    default_armature_kgm2: NonNegative = Field(0.1, description="reflected motor inertia where the arm's file has none")


class ToolSection(Section):
    """What is mounted on the flange: force-torque sensor, then camera, magnet and the hinge's lower half."""

    sensor_mass_kg: Positive = 0.25
    sensor_length_m: Positive = 0.0504
    tool_mass_kg: Positive = 0.30
    tool_com_m: Positive = 0.025
    length_m: Positive = Field(0.1064, description="flange to the hinge's pivot")

    @model_validator(mode="after")
    def _order(self) -> "ToolSection":
        if self.length_m <= self.sensor_length_m:
            raise ValueError(
                f"length_m = {self.length_m:g} must exceed sensor_length_m = {self.sensor_length_m:g}: the pivot lies beyond the sensor"
            )
        return self


class Hinge(Section):
    """Spherical hinge: two crossed axes and the swivel."""

    range_deg: Annotated[float, Field(gt=0.0, le=85.0)] = 45.0
    friction_nm: NonNegative = 0.001
    damping_nms: NonNegative = 0.001


class Uav(Section):
    """The UAV: `file` is what flies in the simulator, the numbers are what the law believes."""

    file: str = "ardrone2.xml"
    mass_kg: Positive = 0.480
    inertia_kgm2: Inertia = ((0.006, 0.0, 0.0), (0.0, 0.007, 0.0), (0.0, 0.0, 0.012))
    lever_m: Vector3 = Field((0.0, 0.0, -0.06), description="centre of mass to pivot, body frame")


class Rotors(Section):
    """The four rotors."""

    max_thrust_n: Positive = Field(1.86, description="largest thrust of one rotor")
    min_thrust_n: NonNegative = Field(0.09, description="smallest thrust of one rotor (idle)")
    time_constant_s: Positive = 0.05
    drag_torque_m: Positive = Field(0.02, description="reaction torque per thrust, N·m/N")

    @model_validator(mode="after")
    def _order(self) -> "Rotors":
        if self.min_thrust_n >= self.max_thrust_n:
            raise ValueError(f"min_thrust_n = {self.min_thrust_n:g} must be below max_thrust_n = {self.max_thrust_n:g}")
        return self


class Onboard(Section):
    """The UAV's own attitude controller."""

    controller: Literal["quaternion_pd", "geometric", "cascade"] = "quaternion_pd"
    rate_hz: int = Field(200, ge=10)
    kp_nm: Positive3 = Field((0.4, 0.4, 0.3), description="N·m per rad of attitude error, body axes")
    kd_nms: Positive3 = Field((0.056, 0.056, 0.06), description="N·m per rad/s, body axes")
    lead_s: NonNegative = Field(0.0, description="rotor lag that the cascade's derivative makes up for")
    observer_rad_s: NonNegative = Field(
        0.0, description="bandwidth of the torque disturbance observer on board; 0 is none"
    )


class Link(Section):
    """The wireless link between ground and UAV."""

    rate_hz: int = Field(200, ge=1, description="rate of attitude and rates sent down")
    uplink_delay_ms: NonNegative = Field(description="torque and thrust set-points, ground to UAV")
    downlink_delay_ms: NonNegative = Field(description="attitude and rates, UAV to ground")
    torque_effectiveness: Positive = Field(description="torque that the rotors make of one N·m of Δτ_att asked for")
    torque_limit_nm: Positive3 = Field(description="largest Δτ_att that the UAV accepts, body axes")
    watchdog_ms: Positive = 200.0


class Sensors(Section):
    """Standard deviations of white noise, and the force-torque sensor's filter and bias."""

    joint_position_rad: NonNegative = 1e-5
    joint_velocity_rad_s: NonNegative = 1e-3
    force_n: NonNegative = 0.05
    torque_nm: NonNegative = 0.002
    force_bias_n: Vector3 = (0.0, 0.0, 0.0)
    force_filter_hz: Positive = Field(100.0, description="cut-off of the force-torque sensor's first-order low-pass")
    attitude_rad: NonNegative = 2e-3
    rate_rad_s: NonNegative = 1e-2


class Disturbance(Section):
    """A constant force and torque on the UAV that no model knows of."""

    force_n: Vector3 = Field((0.0, 0.0, 0.0), description="at the centre of mass, world axes")
    torque_nm: Vector3 = Field((0.0, 0.0, 0.0), description="body axes")


class Control(Section):
    """Gains of the coordinated controller; the defaults are the paper's."""

    k1: Positive6 = (1.0, 1.0, 1.0, 30.0, 30.0, 30.0)
    k2: Positive6 = (1.0, 1.0, 1.0, 30.0, 30.0, 30.0)
    k3: Positive = Field(35.0, description="position; attitude too unless k3_attitude is set")
    k3_attitude: Positive | None = Field(None, description="separate k₃ of the attitude block (X.6); exact law only")
    observer_rad_s: Positive = Field(15.0, description="bandwidth of the force disturbance observer (X.3)")
    observer_limit_n: Positive = Field(
        40.0, description="largest force that the observer makes up for, arm model's error included"
    )
    takeover_limit_n: NonNegative = Field(2.0, description="force of the arm that may stand in for a torque (X.4)")
    observer_limit_nm: Positive = Field(0.3, description="largest moment that it holds responsible")
    orientation_kp: Positive = Field(25.0, description="N·m per rad of end effector tilt")
    orientation_kd: Positive = Field(7.0, description="N·m per rad/s of the end effector")
    elbow_force_n: NonNegative = Field(5.0, description="pull of the elbow field, downwards")
    null_space_damping_nms: NonNegative = Field(2.0, description="joint damping, projected into the null space")
    range_margin_rad: NonNegative = Field(
        0.25, description="distance to a joint's end at which the null space pushes back"
    )
    range_stiffness_nm: NonNegative = Field(20.0, description="N·m per rad of that push")
    coriolis_feedforward: bool = Field(False, description="feed μ ẋ_d forward; the paper neglects it")
    thrust_n: NonNegative = Field(description="total thrust f_T asked of the UAV throughout")
    model_inertia_scale: Positive = Field(1.0, description="factor on the controller's arm masses and inertias")


class Poles(Section):
    """Wanted bandwidth and damping ratio; the rule makes the gains of ground and board of them."""

    position_rad_s: Positive = 40.0
    position_damping: Positive = 1.0
    attitude_rad_s: Positive = 20.0
    attitude_damping: Positive = 0.7


class Experiment(Section):
    """One controller to try: a row of the paper's Table II, or one that goes beyond it."""

    law: Literal["classical", "paper", "exact"] = Field("paper", description="(6), (29) or (X.1)")
    extra_torque: Literal["none", "full", "feedforward"] = Field(
        "none", description="Δτ_att over the link: none, all of the law's, or only what cancels the hinge force (X.6)"
    )
    acceleration: Literal["none", "reference", "implied"] = Field(
        "none", description="what the arm feeds forward as Λ ẍ: nothing, ẍ_d as in (35), or what the law implies (X.2)"
    )
    support: Literal["none", "measured", "model"] = Field(
        "none", description="static support force of (33): none, the measured z force, or the model's"
    )
    observer: bool = Field(False, description="disturbance observer (X.3)")
    limits: bool = Field(
        False, description="thrust and torque within what the rotors give, the arm takes over the rest (X.4)"
    )
    onboard: Onboard | None = Field(None, description="another attitude controller on board for this experiment")
    rule: Poles | None = Field(None, description="gains by rule, on the ground and on board, instead of those given")


class Move(Section):
    """A point-to-point move with rests: septic in time, so C³ at its ends."""

    to_m: Vector3 = Field(description="end point relative to the trajectory's start")
    duration_s: Positive
    rest_s: NonNegative = 1.0


class Trajectory(Section):
    """Desired path r_d(t) of the pivot."""

    start_m: Vector3 | None = Field(None, description="pivot position at the start; the home pose's if absent")
    moves: tuple[Move, ...] = Field(min_length=1)


class Scenario(Section):
    """A whole scenario."""

    title: str = "untitled"
    calibration: str | None = Field(None, description="file of calibrated values, relative to the scenario's folder")
    run: Run = Run()
    arm: Arm = Arm()
    tool: ToolSection = ToolSection()
    hinge: Hinge = Hinge()
    uav: Uav = Uav()
    rotors: Rotors = Rotors()
    onboard: Onboard = Onboard()
    link: Link
    sensors: Sensors = Sensors()
    disturbance: Disturbance = Disturbance()
    control: Control
    trajectory: Trajectory
    harder: Trajectory | None = Field(None, description="second path for the comparison of laws")
    experiments: dict[str, Experiment] = Field(min_length=1)

    @model_validator(mode="after")
    def _consistent(self) -> "Scenario":
        problems = []
        rate = self.run.rate_hz
        devices = {"onboard.rate_hz": self.onboard.rate_hz, "link.rate_hz": self.link.rate_hz}
        for name, experiment in self.experiments.items():
            if experiment.onboard is not None:
                devices[f"experiments.{name}.onboard.rate_hz"] = experiment.onboard.rate_hz
        for name, device in devices.items():
            if device > rate or rate % device:
                divisors = [d for d in range(1, rate + 1) if rate % d == 0]
                near = ", ".join(map(str, sorted(sorted(divisors, key=lambda d: abs(d - device))[:3])))
                problems.append(f"{name} = {device} does not divide run.rate_hz = {rate}; nearest that do: {near}")
        low, high = 4.0 * self.rotors.min_thrust_n, 4.0 * self.rotors.max_thrust_n
        if not low <= self.control.thrust_n <= high:
            problems.append(
                f"control.thrust_n = {self.control.thrust_n:g} N is beyond the four rotors, which give {low:g} to {high:g} N"
            )
        if problems:
            raise ValueError("\n".join(problems))
        return self
