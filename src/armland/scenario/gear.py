"""What a landing needs beyond arm and UAV: hinge, plate, magnet, skids, cradle. Sizes without a source are assumptions."""

from typing import Annotated

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key


class Hinge(Section):
    """Spherical hinge below the UAV: two crossed axes and the swivel."""

    range_deg: Annotated[float, between(0.1, 85.0)] = key(
        30.0,
        "tilt of the UAV on the plate at which it stops: one whose rotors stand still leans there, clear of the arm",
    )
    stop_nm: of.Gain = key(
        6.0,
        "N·m/rad of the rubber at that end: a UAV that falls against it must not break the plate off the magnet; assumption",
    )
    stop_nms: of.Gain = key(0.3, "its damping in N·m·s/rad; assumption: three quarters of the critical one")
    friction_nm: of.Coefficient = key(0.001, "dry friction, each axis")
    damping_nms: of.Coefficient = key(0.001, "viscous friction in N·m·s/rad, each axis")


class Plate(Section):
    """Steel disc on the spherical hinge below the UAV, which the magnet grips."""

    radius_m: of.Length = key(0.022, "covers the magnet's pads up to an offset of 7 mm")
    thickness_m: of.Length = key(0.004, "a MAP-6 magnet needs 4 mm for its full force")
    drop_m: of.Length = key(0.012, "pivot to the plate's lower face")
    mass_kg: of.Mass | None = key(None, "of the plate; that of solid steel if absent")


class Magnet(Section):
    """Electromagnet. Force, gap and residual force: Ixtur MAP-6 (35 x 35 mm face, plate from 4 mm)."""

    rating_n: of.PositiveForce = key(177.0, "pull in contact")
    gap_scale_m: of.Length = key(0.2e-3, "g₀ of F₀/(1 + g/g₀)², fitted to 79, 44, 22 N at 0.1, 0.2, 0.4 mm")
    residual_n: of.Force = key(0.3, "pull with the current off")
    shear_share: of.PositiveFraction = key(0.2, "holds against sliding, per newton of pull; rule of the trade")
    time_constant_s: of.PositiveSeconds = key(0.02, "of the current; assumption: L/R of a small holding magnet")
    pad_radius_m: of.Length = key(0.015, "circle of pads on which the pull acts; assumption: inside the face")
    reach_m: of.Length = key(2e-3, "gap within which contact damps an approach; assumption: eddy currents, air")


class Skids(Section):
    """Two tubes across below the UAV, along body y. Their mass is part of the UAV's."""

    x_m: of.Length = key(0.15, "of each tube, before and behind the centre of mass: leaves the marker in view")
    half_length_m: of.Length = key(
        0.19, "of each tube: 4 cm beyond the rails, so that a cradle a little aside still bears it"
    )
    radius_m: of.Length = key(0.006, "of each tube")
    z_m: of.Coordinate = key(-0.095, "tubes' axis below the centre of mass")


class Cradle(Section):
    """Two round rails on a frame that rests on four rubber buffers, one below each place where a skid bears.

    They point away from the arm's base, open towards it, and stand, unloaded, where `place.put_down_m` says.
    """

    heading_deg: of.Angle = key(0.0, "of the rails, world")
    gap_m: of.Length = key(
        0.25, "clear width of the slot: room for the arm to follow a UAV sideways, see `arm.width_m`"
    )
    length_m: of.Length = key(0.36, "of each rail")
    radius_m: of.Length = key(0.012, "of each rail")
    mass_kg: of.Mass = key(0.3, "of rails and frame; two aluminium tubes with a wall of 2 mm weigh 0.27 kg")
    stiffness_npm: of.Gain = key(
        1e4, "N/m, of each buffer; assumption: rubber of 10 mm and 40 Shore A, docs/touchdown.md"
    )
    damping_nspm: of.Coefficient = key(25.0, "of each buffer; assumption: loss factor 0.2 at the touchdown's 13 Hz")
