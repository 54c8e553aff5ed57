"""The UAV: body, rotors, its own controller, and the wireless link to it."""

from typing import Annotated, Literal

from pydantic import Field

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key

Spin = Annotated[int, Field(ge=-1, le=1)]

HoverTilt = Annotated[float, between(1e-3, 1.5)]


class Uav(Section):
    """The rigid body. Numbers that are absent are those of the file."""

    file: of.Text = key("ardrone2.xml", "UAV that comes with armland, or an MJCF file; empty where all stands here")
    mass_kg: of.Mass | None = key(None, "without the hinge plate")
    inertia_kgm2: of.Inertia | None = key(None, "about the centre of mass, body axes")
    lever_m: of.Point | None = key(None, "centre of mass to the hinge's pivot, body axes")
    extra_mass_kg: of.Load = key(0.0, "that it carries at its centre of mass beyond its own")
    drag_nspm: of.Coefficient = key(0.22, "linear drag in N·s/m, horizontal; assumption: 0.45 1/s of such quadrotors")


class Rotors(Section):
    """The rotors, four to eight alike, and what motion through the air does to their thrust."""

    rising = (("min_thrust_n", "max_thrust_n", ""),)

    place_m: Annotated[tuple[of.Point, ...], Field(min_length=1, max_length=64)] | None = key(
        None, "of each rotor from the centre of mass, body axes; the file's sites rotor_1, rotor_2 ... if absent"
    )
    axis: Annotated[tuple[of.Direction, ...], Field(min_length=1, max_length=64)] | None = key(
        None,
        "the way that each pushes, body axes, a ratio of components; along body z if absent, or as the file's sites point",
    )
    spin: Annotated[tuple[Spin, ...], Field(min_length=1, max_length=64)] | None = key(
        None,
        "number: 1 where a rotor turns counter-clockwise, seen from above, else -1; alternating about the body if absent",
    )
    max_thrust_n: of.PositiveForce = key(1.86, "largest thrust of one rotor")
    min_thrust_n: of.Force = key(0.09, "smallest thrust of one rotor (idle)")
    time_constant_s: of.PositiveSeconds = key(0.05, "lag of a rotor's thrust behind its set-point")
    drag_torque_m: of.PositiveCoefficient = key(0.02, "reaction torque per thrust, N·m/N")
    inflow: bool = key(True, "thrust by momentum theory at constant rotor speed, models.inflow (I.2)")
    curve: tuple[of.Coefficient, of.Coefficient, of.Coefficient] = key(
        (1.112e-4, 7.705e-3, 0.0924),
        "c2, c1, c0 of one rotor's thrust in N, c2 p^2 + c1 p + c0 at p percent of its command; used by onboard.slope_share "
        "(AR.Drone 2.0 motor bench)",
    )
    radius_m: of.Length = key(0.1, "of a rotor; assumption, no source gives the AR.Drone's")
    slope: Annotated[float, between(1e-9, 100.0)] = key(
        0.7,
        "relative loss of thrust per relative rise of the inflow, a factor; "
        "assumption: σa/(8λ) of two blades of 2 cm by 10 cm",
    )
    inflow_ratio: Annotated[float, between(1e-6, 1.0)] = key(
        0.115, "v_h/ΩR, a ratio; assumption: 3300 turns a minute where the AR.Drone hovers"
    )

    def _contradictions(self) -> list[str]:
        found = super()._contradictions()
        if 0 in (self.spin or ()):
            found.append("spin: 0 is no direction; 1 is counter-clockwise, seen from above, -1 clockwise")
        for i, axis in enumerate(self.axis or ()):
            if axis[2] <= 0.0:
                found.append(f"axis: rotor {i + 1} pushes along {list(axis)}; its z must be above 0: a rotor lifts")
        return found


class Hover(Section):
    """Station keeping on board, for a UAV that hovers by itself."""

    rising = (("lift_min_n", "thrust_max_n", ""),)

    k_position: of.Gain = key(0.8, "1/s")
    k_velocity: of.Gain = key(2.2, "1/s")
    k_integral: of.Gain = key(1.0, "1/s²")
    speed_max_mps: of.PositiveSpeed = key(0.5, "largest speed asked for")
    integral_max_mps2: of.PositiveAcceleration = key(5.0, "largest acceleration that the integral asks for")
    tilt_max_rad: HoverTilt = key(0.4, "largest tilt asked for")
    lift_min_n: of.Force = key(1.4, "least thrust asked for")
    thrust_max_n: of.PositiveForce = key(7.0, "largest thrust asked for")


class Onboard(Section):
    """The UAV's own attitude controller, and what it does by itself."""

    controller: Literal["quaternion_pd", "geometric", "cascade"] = key("quaternion_pd", "law of the attitude")
    rate_hz: Annotated[int, Field(ge=10, le=10_000)] = key(200, "of the attitude controller; divides the base rate")
    kp_nm: of.Gain3 = key((0.4, 0.4, 0.3), "N·m per rad of attitude error, body axes")
    kd_nms: of.Gain3 = key((0.056, 0.056, 0.06), "N·m per rad/s, body axes")
    lead_s: Annotated[float, between(0.0, 1.0)] = key(0.0, "rotor lag that the cascade's derivative makes up for")
    integral_s: of.Seconds = key(
        0.0, "integral time of the cascade's rate loop, which takes away what leans the UAV for good; 0: no integral"
    )
    slope_share: Annotated[float, between(0.0, 1.0)] = key(
        0.0,
        "share by which its torque follows the slope of rotors.curve, relative to hover's: 0 for a controller that knows the "
        "curve, 1 for one that takes its slope for that of hover",
    )
    observer_rad_s: of.Bandwidth = key(0.0, "bandwidth of the torque disturbance observer on board; 0 is none")
    rotor_watch: Annotated[float, between(0.0, 0.95)] = key(
        0.6, "share of its due thrust below which a rotor counts as lost on board; 0: no watch"
    )
    watched_n: of.PositiveForce = key(0.3, "thrust from which on a rotor is watched on board")
    watchdog_ms: of.Milliseconds = key(
        300.0, "silence of the link after which the UAV helps itself; assumption, the AR.Drone's lie around it"
    )
    climb_m: of.Distance = key(0.4, "how far a flying UAV without link climbs away")
    run_down_nps: of.Gain = key(3.0, "N/s at which a UAV without link on the cradle takes its thrust back")
    hover: Hover = key(Hover(), "station keeping on board")


class Link(Section):
    """The wireless link between ground and UAV."""

    rate_hz: of.Rate = key(200, "rate of attitude and rates sent down; divides the base rate")
    uplink_delay_ms: of.Milliseconds = Field(description="torque and thrust set-points, ground to UAV")
    downlink_delay_ms: of.Milliseconds = Field(description="attitude and rates, UAV to ground")
    torque_effectiveness: of.Factor = Field(
        description="factor: torque that the rotors make of one N·m of Δτ_att asked for"
    )
    torque_limit_nm: of.Gain3 = Field(description="largest Δτ_att that the UAV accepts, body axes")
    watchdog_ms: of.PositiveMilliseconds = key(200.0, "age of the UAV's sample from which the ground flags it as stale")
