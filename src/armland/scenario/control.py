"""Laws and gains: what the controller is told beyond what it believes of the hardware."""

from typing import Annotated, Literal

from pydantic import Field

from armland.scenario.quantities import (
    Coefficient,
    Distance,
    Force,
    Fraction,
    Gain,
    Gain6,
    PositiveAcceleration,
    PositiveBandwidth,
    PositiveForce,
    PositiveFraction,
    PositiveSeconds,
    PositiveSpeed,
    PositiveTorque,
    Rate,
    Section,
    Text,
    between,
)
from armland.scenario.uav import Onboard


class Station(Section):
    """Station keeping of the flying UAV by the ground, see `control.laws.station_keeping`."""

    k_position: Gain = Field(1.2, description="1/s")
    k_velocity: Gain = Field(3.0, description="1/s")
    k_integral: Gain = Field(1.2, description="1/s²")
    speed_max_mps: PositiveSpeed = Field(0.3, description="largest speed asked for")
    integral_max_mps2: PositiveAcceleration = Field(3.0, description="largest acceleration that the integral asks for")
    tilt_max_rad: Annotated[float, between(1e-3, 1.5)] = Field(0.3, description="largest tilt asked for")
    rate_hz: Rate = Field(200, description="of the set-points; divides the base rate")
    hover_s: PositiveSeconds = Field(
        1.0, description="time constant with which the hover thrust follows the station keeping"
    )


class Approach(Section):
    """How the free arm follows the plate, and how a reference comes to rest."""

    track_rad_s: PositiveBandwidth = Field(12.0, description="double pole of the filter on the plate's motion")
    track_max_mps2: PositiveAcceleration = Field(3.0, description="largest acceleration of that filter")
    coast_s: PositiveSeconds = Field(0.06, description="in which the reference comes to rest")
    beyond_m: Distance = Field(0.006, description="how far beyond the plate's face the arm would close")
    give_way_mpns: Gain = Field(3e-3, description="m/s per N of hinge force where the arm gives way")
    give_way_max_m: Distance = Field(4e-3, description="largest displacement of giving way")


class Thrust(Section):
    """The UAV's thrust while the arm holds it."""

    carry_share: Annotated[float, between(1e-6, 0.99)] = Field(
        0.5, description="share of the weight that the rotors carry meanwhile"
    )
    rate_nps: Gain = Field(3.0, description="N/s of the ramp")
    slack_n: Gain = Field(1.5, description="hinge force behind its expectation that stops the ramp")
    balance_nps_per_n: Gain = Field(
        1.5, description="N/s of thrust per N of hinge force while the hinge is freed of force"
    )
    floor_n: Force = Field(0.1, description="above the idle thrust of all rotors: least thrust that is commanded")
    ceiling: PositiveFraction = Field(
        0.94, description="share of the largest static thrust of all rotors that is commanded"
    )


class Control(Section):
    """Gains of the coordinated controller; where the paper has a value, the default is the paper's."""

    law: Text | None = Field(
        None, description="row of the law table, or FILE.py:FUNCTION, for the held UAV; the mission's own if absent"
    )
    k1: Gain6 = Field((1.0, 1.0, 1.0, 30.0, 30.0, 30.0), description="K₁ in 1/s: attitude, then position")
    k2: Gain6 = Field((1.0, 1.0, 1.0, 30.0, 30.0, 30.0), description="K₂ in N·m·s, then kg/s")
    k3: Gain = Field(35.0, description="k₃ in N/m (and N·m): position; attitude too unless k3_attitude is set")
    k3_attitude: Gain | None = Field(None, description="separate k₃ of the attitude block in N·m (X.6); exact law only")
    thrust_n: Force = Field(2.35, description="total thrust f_T asked of the UAV on the hinge throughout")
    position_rad_s: PositiveBandwidth = Field(30.0, description="poles of the held UAV's position, landing")
    position_damping: Gain = Field(1.0, description="their damping ratio")
    free_rad_s: PositiveBandwidth = Field(25.0, description="poles of the end effector while nothing is held")
    free_damping: Gain = Field(1.0, description="their damping ratio")
    observer_rad_s: PositiveBandwidth = Field(15.0, description="bandwidth of the force disturbance observer (X.3)")
    observer_limit_n: PositiveForce = Field(
        40.0, description="largest force that the observer makes up for, arm model's error included"
    )
    observer_limit_nm: PositiveTorque = Field(0.3, description="largest moment that it holds responsible")
    takeover_limit_n: Force = Field(2.0, description="force of the arm that may stand in for a torque (X.4)")
    orientation_kp: Gain = Field(25.0, description="N·m per rad of end effector tilt")
    orientation_kd: Gain = Field(7.0, description="N·m per rad/s of the end effector")
    elbow_force_n: Force = Field(5.0, description="pull of the elbow field, downwards")
    null_space_damping_nms: Coefficient = Field(
        2.0, description="joint damping in N·m·s/rad, projected into the null space"
    )
    range_margin_rad: Fraction = Field(
        0.25, description="distance to a joint's end at which the null space pushes back"
    )
    range_stiffness_nm: Coefficient = Field(20.0, description="N·m per rad of that push")
    coriolis_feedforward: bool = Field(False, description="feed μ ẋ_d forward; the paper neglects it")
    station: Station = Field(Station(), description="station keeping by the ground")
    approach: Approach = Field(Approach(), description="how the free arm follows the plate")
    thrust: Thrust = Field(Thrust(), description="thrust while the arm holds the UAV")


class Poles(Section):
    """Wanted bandwidth and damping ratio; the rule makes the gains of ground and board of them."""

    position_rad_s: PositiveBandwidth = Field(40.0, description="of the position")
    position_damping: Gain = Field(1.0, description="damping ratio of the position")
    attitude_rad_s: PositiveBandwidth = Field(20.0, description="of the attitude")
    attitude_damping: Gain = Field(0.7, description="damping ratio of the attitude")


class Experiment(Section):
    """One controller to try on the hinge: a row of the paper's Table II, or one that goes beyond it."""

    law: Text = Field(
        "paper", description="row of the law table: `classical` (6), `paper` (29), `exact` (X.1), or a user's own"
    )
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
