"""The UAV: body, rotors, its own controller, and the wireless link to it."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from armland.scenario.quantities import (
    Bandwidth,
    Coefficient,
    Distance,
    Factor,
    Force,
    Gain,
    Gain3,
    Inertia,
    Length,
    Load,
    Mass,
    Milliseconds,
    Point,
    PositiveAcceleration,
    PositiveCoefficient,
    PositiveForce,
    PositiveMilliseconds,
    PositiveSeconds,
    PositiveSpeed,
    Rate,
    Section,
    Text,
    between,
)

HoverTilt = Annotated[float, between(1e-3, 1.5)]


class Uav(Section):
    """The rigid body. Numbers that are absent are those of the file."""

    file: Text = Field("ardrone2.xml", description="UAV that comes with armland, or an MJCF file")
    mass_kg: Mass | None = Field(None, description="without the hinge plate")
    inertia_kgm2: Inertia | None = Field(None, description="about the centre of mass, body axes")
    lever_m: Point | None = Field(None, description="centre of mass to the hinge's pivot, body axes")
    extra_mass_kg: Load = Field(0.0, description="that it carries at its centre of mass beyond its own")
    drag_nspm: Coefficient = Field(
        0.22, description="linear drag in N·s/m, horizontal; assumption: 0.45 1/s of such quadrotors"
    )


class Rotors(Section):
    """The four rotors, and what motion through the air does to their thrust."""

    max_thrust_n: PositiveForce = Field(1.86, description="largest thrust of one rotor")
    min_thrust_n: Force = Field(0.09, description="smallest thrust of one rotor (idle)")
    time_constant_s: PositiveSeconds = Field(0.05, description="lag of a rotor's thrust behind its set-point")
    drag_torque_m: PositiveCoefficient = Field(0.02, description="reaction torque per thrust, N·m/N")
    inflow: bool = Field(True, description="thrust by momentum theory at constant rotor speed, models.inflow (I.2)")
    radius_m: Length = Field(0.1, description="of a rotor; assumption, no source gives the AR.Drone's")
    slope: Annotated[float, between(1e-9, 100.0)] = Field(
        0.7,
        description="relative loss of thrust per relative rise of the inflow, a factor; "
        "assumption: σa/(8λ) of two blades of 2 cm by 10 cm",
    )
    inflow_ratio: Annotated[float, between(1e-6, 1.0)] = Field(
        0.115, description="v_h/ΩR, a ratio; assumption: 3300 turns a minute where the AR.Drone hovers"
    )

    @model_validator(mode="after")
    def _order(self) -> "Rotors":
        if self.min_thrust_n >= self.max_thrust_n:
            raise ValueError(f"min_thrust_n = {self.min_thrust_n:g} must be below max_thrust_n = {self.max_thrust_n:g}")
        return self


class Hover(Section):
    """Station keeping on board, for a UAV that hovers by itself."""

    k_position: Gain = Field(0.8, description="1/s")
    k_velocity: Gain = Field(2.2, description="1/s")
    k_integral: Gain = Field(1.0, description="1/s²")
    speed_max_mps: PositiveSpeed = Field(0.5, description="largest speed asked for")
    integral_max_mps2: PositiveAcceleration = Field(5.0, description="largest acceleration that the integral asks for")
    tilt_max_rad: HoverTilt = Field(0.4, description="largest tilt asked for")
    lift_min_n: Force = Field(1.4, description="least thrust asked for")
    thrust_max_n: PositiveForce = Field(7.0, description="largest thrust asked for")

    @model_validator(mode="after")
    def _order(self) -> "Hover":
        if self.lift_min_n >= self.thrust_max_n:
            raise ValueError(f"lift_min_n = {self.lift_min_n:g} must be below thrust_max_n = {self.thrust_max_n:g}")
        return self


class Onboard(Section):
    """The UAV's own attitude controller, and what it does by itself."""

    controller: Literal["quaternion_pd", "geometric", "cascade"] = Field(
        "quaternion_pd", description="law of the attitude"
    )
    rate_hz: Annotated[int, Field(ge=10, le=10_000)] = Field(
        200, description="of the attitude controller; divides the base rate"
    )
    kp_nm: Gain3 = Field((0.4, 0.4, 0.3), description="N·m per rad of attitude error, body axes")
    kd_nms: Gain3 = Field((0.056, 0.056, 0.06), description="N·m per rad/s, body axes")
    lead_s: Annotated[float, between(0.0, 1.0)] = Field(
        0.0, description="rotor lag that the cascade's derivative makes up for"
    )
    observer_rad_s: Bandwidth = Field(
        0.0, description="bandwidth of the torque disturbance observer on board; 0 is none"
    )
    rotor_watch: Annotated[float, between(0.0, 0.95)] = Field(
        0.6, description="share of its due thrust below which a rotor counts as lost on board; 0: no watch"
    )
    watchdog_ms: Milliseconds = Field(
        300.0,
        description="silence of the link after which the UAV helps itself; assumption, the AR.Drone's lie around it",
    )
    climb_m: Distance = Field(0.4, description="how far a flying UAV without link climbs away")
    run_down_nps: Gain = Field(3.0, description="N/s at which a UAV without link on the cradle takes its thrust back")
    hover: Hover = Field(Hover(), description="station keeping on board")


class Link(Section):
    """The wireless link between ground and UAV."""

    rate_hz: Rate = Field(200, description="rate of attitude and rates sent down; divides the base rate")
    uplink_delay_ms: Milliseconds = Field(description="torque and thrust set-points, ground to UAV")
    downlink_delay_ms: Milliseconds = Field(description="attitude and rates, UAV to ground")
    torque_effectiveness: Factor = Field(
        description="factor: torque that the rotors make of one N·m of Δτ_att asked for"
    )
    torque_limit_nm: Gain3 = Field(description="largest Δτ_att that the UAV accepts, body axes")
    watchdog_ms: PositiveMilliseconds = Field(
        200.0, description="age of the UAV's sample from which the ground flags it as stale"
    )
