"""A landing without an arm: the pad on which the UAV lands by itself, and how it comes down."""

from typing import Annotated

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key


class Pad(Section):
    """Flat landing deck, `place.catch_m` above its middle. The camera looks up through a window in it. Sizes are assumptions."""

    height_m: Annotated[float, between(0.1, 10.0)] = key(0.45, "of its surface above the deck's origin")
    half_m: of.Length = key(0.5, "half its edge: the UAV's skids are 0.38 m wide")
    friction: Annotated[float, between(0.0, 2.0)] = key(0.8, "of the skids on it, ratio; that of the skids on rails")
    recess_m: Annotated[float, between(0.0, 2.0)] = key(
        0.35, "optical centre below the surface: it sees the marker of a UAV that stands"
    )


class Descent(Section):
    """How a UAV without an arm comes down on the pad."""

    rising = (("ready_m", "wait_m", "it waits for a quiet moment below where it finds its station"),)

    wait_m: of.Length = key(0.5, "height of the skids above the pad at which the station is found")
    ready_m: of.Length = key(0.2, "height at which it waits for a quiet moment")
    sink_mps: of.PositiveSpeed = key(0.2, "speed of the descent, against the pad")
    align_m: of.Length = key(0.1, "horizontal distance to its station within which it goes down")
    give_up_m: of.Length = key(0.3, "distance at which a descent is given up and begun again")
    timed: bool = key(True, "whether it waits for a quiet moment; false: it comes down when it is on its station")
    quiet: of.Factor = key(0.6, "ratio: unrest of pad and UAV, below which it comes down")
    patience_s: of.PositiveSeconds = key(15.0, "after which it comes down whatever the unrest")
    cut_m: of.Distance = key(0.01, "height at which the rotors are stopped")
    level_m: of.Distance = key(0.0, "height from which on it levels out to the pad; 0: not at all")


class Hexapod(Section):
    """Platform on six legs that carries the pad and cancels the hull's motion. All numbers are assumptions: a small electric motion
    base; no data sheet was at hand."""

    foot_radius_m: of.Length = key(0.55, "circle of the legs' feet on the deck")
    head_radius_m: of.Length = key(0.35, "circle of their heads below the pad")
    stroke_m: of.Length = key(0.3, "of each leg, half of it either way from the neutral pose")
    speed_mps: of.PositiveSpeed = key(0.5, "largest of a leg")
    acceleration_mps2: of.PositiveAcceleration = key(5.0, "largest of a leg")
    servo_rad_s: of.PositiveBandwidth = key(40.0, "bandwidth of a leg's servo")
    fade_s: of.PositiveSeconds = key(2.0, "time constant with which it comes back to its middle")
    travel_m: of.Length = key(
        0.12, "farthest that its middle is asked to go: the rest of the stroke holds the attitude"
    )


class Tether(Section):
    """Rope from a winch below the pad's middle to the UAV's hinge. Numbers without a source are assumptions."""

    kg_per_m: Annotated[float, between(1e-4, 1.0)] = key(0.002, "mass of the rope, kg/m: 1.5 mm of polyamide")
    stretch_n: Annotated[float, between(10.0, 1e5)] = key(1500.0, "EA, N, force at which it would be twice as long")
    low_n: of.PositiveForce = key(0.3, "tension that the winch keeps while the UAV flies by itself")
    pull_n: of.PositiveForce = key(
        1.2, "thrust beyond the weight with which the UAV pulls on the rope while it comes down"
    )
    hold_n: of.PositiveForce = key(3.0, "tension with which a UAV that stands is held on the pad")
    give_mps_per_n: of.PositiveCoefficient = key(2.0, "speed of the winch per newton that the tension is wrong by")
    reel_mps_per_n: of.PositiveCoefficient = key(0.06, "likewise while it reels in")
    speed_mps: of.PositiveSpeed = key(2.0, "largest of the winch")
    acceleration_mps2: of.PositiveAcceleration = key(20.0, "largest of the winch")
