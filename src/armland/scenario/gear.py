"""What a landing needs beyond arm and UAV: hinge, plate, magnet, skids, cradle. Sizes without a source are assumptions."""

from typing import Annotated

from pydantic import Field

from armland.scenario.quantities import (
    Angle,
    Coefficient,
    Coordinate,
    Force,
    Length,
    Mass,
    PositiveForce,
    PositiveFraction,
    PositiveSeconds,
    Section,
    between,
)


class Hinge(Section):
    """Spherical hinge below the UAV: two crossed axes and the swivel."""

    range_deg: Annotated[float, between(0.1, 85.0)] = Field(
        45.0, description="tilt of the UAV on the plate at which it stops"
    )
    friction_nm: Coefficient = Field(0.001, description="dry friction, each axis")
    damping_nms: Coefficient = Field(0.001, description="viscous friction in N·m·s/rad, each axis")


class Plate(Section):
    """Steel disc on the spherical hinge below the UAV, which the magnet grips."""

    radius_m: Length = Field(0.022, description="covers the magnet's pads up to an offset of 7 mm")
    thickness_m: Length = Field(0.004, description="a MAP-6 magnet needs 4 mm for its full force")
    drop_m: Length = Field(0.012, description="pivot to the plate's lower face")
    mass_kg: Mass | None = Field(None, description="of the plate; that of solid steel if absent")


class Magnet(Section):
    """Electromagnet. Force, gap and residual force: Ixtur MAP-6 (35 x 35 mm face, plate from 4 mm)."""

    rating_n: PositiveForce = Field(177.0, description="pull in contact")
    gap_scale_m: Length = Field(0.2e-3, description="g₀ of F₀/(1 + g/g₀)², fitted to 79, 44, 22 N at 0.1, 0.2, 0.4 mm")
    residual_n: Force = Field(0.3, description="pull with the current off")
    shear_share: PositiveFraction = Field(
        0.2, description="holds against sliding, per newton of pull; rule of the trade"
    )
    time_constant_s: PositiveSeconds = Field(
        0.02, description="of the current; assumption: L/R of a small holding magnet"
    )
    pad_radius_m: Length = Field(
        0.015, description="circle of pads on which the pull acts; assumption: inside the face"
    )
    reach_m: Length = Field(
        2e-3, description="gap within which contact damps an approach; assumption: eddy currents, air"
    )


class Skids(Section):
    """Two tubes across below the UAV, along body y. Their mass is part of the UAV's."""

    x_m: Length = Field(
        0.15, description="of each tube, before and behind the centre of mass: leaves the marker in view"
    )
    half_length_m: Length = Field(0.17, description="of each tube")
    radius_m: Length = Field(0.006, description="of each tube")
    z_m: Coordinate = Field(-0.095, description="tubes' axis below the centre of mass")


class Cradle(Section):
    """Two round rails that point away from the arm's base, open towards it. It stands where `place.put_down_m` says."""

    heading_deg: Angle = Field(0.0, description="of the rails, world")
    gap_m: Length = Field(
        0.196, description="clear width of the slot; the arm's widest part that passes measures 0.12 m"
    )
    length_m: Length = Field(0.36, description="of each rail")
    radius_m: Length = Field(0.012, description="of each rail")
