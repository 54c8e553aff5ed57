"""Laws and gains: what the controller is told beyond what it believes of the hardware."""

from typing import Annotated, Literal

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key
from armland.scenario.uav import Onboard


class Station(Section):
    """Station keeping of the flying UAV by the ground, see `control.laws.station_keeping`."""

    k_position: of.Gain = key(1.2, "1/s")
    k_velocity: of.Gain = key(3.0, "1/s")
    k_integral: of.Gain = key(1.2, "1/s²")
    vertical: Annotated[float, between(1e-3, 100.0)] = key(
        1.0, "ratio of k_velocity and k_integral upwards to those sideways: thrust answers sooner than attitude"
    )
    speed_max_mps: of.PositiveSpeed = key(0.3, "largest speed asked for")
    integral_max_mps2: of.PositiveAcceleration = key(5.0, "largest acceleration that the integral asks for")
    tilt_max_rad: Annotated[float, between(1e-3, 1.5)] = key(0.3, "largest tilt asked for")
    rate_hz: of.Rate = key(200, "of the set-points; divides the base rate")
    gust_share: of.Fraction = key(1.0, "share of the disturbance in the plate filter that is cancelled, horizontally")
    gust_max_mps2: of.PositiveAcceleration = key(2.0, "largest disturbance that is cancelled")
    hover_s: of.PositiveSeconds = key(1.0, "time constant with which the hover thrust follows the station keeping")
    rides_rad_s: of.PositiveBandwidth = key(
        8.0,
        "of a deck's motion with which the UAV goes along, at most: a hull's is slower, and what is faster no attitude follows",
    )
    ahead: of.Fraction = key(1.0, "share of its lateness by which it is asked beforehand for what such a deck will do")


class Approach(Section):
    """How the free arm follows the plate, and how a reference comes to rest."""

    track_rad_s: of.PositiveBandwidth = key(12.0, "double pole of the filter on the plate's motion")
    track_max_mps2: of.PositiveAcceleration = key(3.0, "largest acceleration of that filter")
    track_max_mps: of.PositiveSpeed = key(0.4, "its largest speed, each axis")
    clearance_m: of.Distance = key(
        0.015, "of the arm to the slot's rails, beyond which it does not follow the plate sideways"
    )
    coast_s: of.PositiveSeconds = key(0.06, "in which the reference comes to rest")
    beyond_m: of.Distance = key(0.006, "how far beyond the plate's face the arm would close")
    lower_mps: of.PositiveSpeed | None = key(
        None, "speed at which the arm feels for the cradle; if absent 0.03 m/s, or as slow as the magnet bears"
    )
    give_way_mpns: of.Gain = key(3e-3, "m/s per N of hinge force where the arm gives way")
    give_way_max_m: of.Distance = key(4e-3, "largest displacement of giving way")


class Thrust(Section):
    """The UAV's thrust while the arm holds it."""

    carry_share: Annotated[float, between(1e-6, 0.99)] = key(0.5, "share of the weight that the rotors carry meanwhile")
    rate_nps: of.Gain = key(3.0, "N/s of the ramp")
    slack_n: of.Gain = key(1.5, "hinge force behind its expectation that stops the ramp")
    balance_nps_per_n: of.Gain = key(1.5, "N/s of thrust per N of hinge force while the hinge is freed of force")
    floor_n: of.Force = key(0.1, "above the idle thrust of all rotors: least thrust that is commanded")
    ceiling: of.PositiveFraction = key(0.94, "share of the largest static thrust of all rotors that is commanded")


class Control(Section):
    """Gains of the coordinated controller; where the paper has a value, the default is the paper's."""

    law: of.Text | None = key(
        None, "row of the law table, or FILE.py:FUNCTION, for the held UAV; the mission's own if absent"
    )
    k1: of.Gain6 = key((1.0, 1.0, 1.0, 30.0, 30.0, 30.0), "K₁ in 1/s: attitude, then position")
    k2: of.Gain6 = key((1.0, 1.0, 1.0, 30.0, 30.0, 30.0), "K₂ in N·m·s, then kg/s")
    k3: of.Gain = key(35.0, "k₃ in N/m (and N·m): position; attitude too unless k3_attitude is set")
    k3_attitude: of.Gain | None = key(None, "separate k₃ of the attitude block in N·m (X.6); exact law only")
    thrust_n: of.Force = key(2.35, "total thrust f_T asked of the UAV on the hinge throughout")
    position_rad_s: of.PositiveBandwidth = key(30.0, "poles of the held UAV's position, landing")
    position_damping: of.Gain = key(1.0, "their damping ratio")
    free_rad_s: of.PositiveBandwidth = key(25.0, "poles of the end effector while nothing is held")
    free_damping: of.Gain = key(1.0, "their damping ratio")
    observer_rad_s: of.PositiveBandwidth = key(15.0, "bandwidth of the force disturbance observer (X.3)")
    observer_limit_n: of.PositiveForce = key(
        40.0, "largest force that the observer makes up for, arm model's error included"
    )
    observer_limit_nm: of.PositiveTorque = key(0.3, "largest moment that it holds responsible")
    takeover_limit_n: of.Force = key(2.0, "force of the arm that may stand in for a torque (X.4)")
    orientation_kp: of.Gain = key(25.0, "N·m per rad of end effector tilt")
    orientation_kd: of.Gain = key(7.0, "N·m per rad/s of the end effector")
    elbow_force_n: of.Force = key(5.0, "pull of the elbow field, downwards")
    null_space_damping_nms: of.Coefficient = key(2.0, "joint damping in N·m·s/rad, projected into the null space")
    posture_rad_s: of.Bandwidth = key(
        0.0, "bandwidth with which the null space returns to the pose from which the arm approaches; 0: it does not"
    )
    range_margin_rad: of.Fraction = key(0.25, "distance to a joint's end at which the null space pushes back")
    range_stiffness_nm: of.Coefficient = key(20.0, "N·m per rad of that push")
    coriolis_feedforward: bool = key(False, "feed μ ẋ_d forward; the paper neglects it")
    deck_feedforward: bool = key(True, "feed the torques forward that the motion of the arm's base asks for, at sea")
    station: Station = key(Station(), "station keeping by the ground")
    approach: Approach = key(Approach(), "how the free arm follows the plate")
    thrust: Thrust = key(Thrust(), "thrust while the arm holds the UAV")


class Poles(Section):
    """Wanted bandwidth and damping ratio; the rule makes the gains of ground and board of them."""

    position_rad_s: of.PositiveBandwidth = key(40.0, "of the position")
    position_damping: of.Gain = key(1.0, "damping ratio of the position")
    attitude_rad_s: of.PositiveBandwidth = key(20.0, "of the attitude")
    attitude_damping: of.Gain = key(0.7, "damping ratio of the attitude")


class Experiment(Section):
    """One controller to try on the hinge: a row of the paper's Table II, or one that goes beyond it."""

    law: of.Text = key("paper", "row of the law table: `classical` (6), `paper` (29), `exact` (X.1), or a user's own")
    extra_torque: Literal["none", "full", "feedforward"] = key(
        "none", "Δτ_att over the link: none, all of the law's, or only what cancels the hinge force (X.6)"
    )
    acceleration: Literal["none", "reference", "implied"] = key(
        "none", "what the arm feeds forward as Λ ẍ: nothing, ẍ_d as in (35), or what the law implies (X.2)"
    )
    support: Literal["none", "measured", "model"] = key(
        "none", "static support force of (33): none, the measured z force, or the model's"
    )
    observer: bool = key(False, "disturbance observer (X.3)")
    limits: bool = key(False, "thrust and torque within what the rotors give, the arm takes over the rest (X.4)")
    onboard: Onboard | None = key(None, "another attitude controller on board for this experiment")
    rule: Poles | None = key(None, "gains by rule, on the ground and on board, instead of those given")
