"""The electromagnet on the arm's tool and the UAV's hinge plate that it grips: the device's law, and both in MuJoCo.

| symbol | name | unit |
|---|---|---|
| F₀, g₀ | `rated_force`, `gap_scale`: pull of F(g) = F₀/(1 + g/g₀)² on a plate at gap g | N, m |
| i | `current`, share of the rated current; the pull goes with i², as F = (N i)² μ₀ A / (2 g²) does | 1 |
| μ | `shear_share`: what holds against sliding, per newton that presses the faces together | 1 |
| r, h | `pad_radius` of the circle of pads that carry the face; height of a load's point above the face | m |

The face is four pads on a circle. Each pulls the plate with its share of F at its own gap, by forces from outside
(`xfrc_applied`) on plate and tool, and a contact bears against the pull: so peeling, breaking loose and sliding are physics
and no rule, and MuJoCo's force sensors see the load and not the pull. Measured beside it: contacts with MuJoCo's `adhesion`
break at their rating, but slide without friction as soon as the load pulls; the force of its adhesion actuator is missing from
its force sensors, which then read the whole pull; a weld is no cheaper and knows no gap, no tilt and no slip.
"""

from typing import NamedTuple

import mujoco
import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.records import Record
from armland.rotations import Array

PADS = 4
OFF, ON, TEST = 0, 1, 2
"""Commands. TEST switches the coil on until its current should have risen, reports, and switches off again."""

TOUCHING_M = 2e-5
"""Gap below which a pad counts as touching."""

CUSHION_N = 1e-3
"""Adhesion of a pad's contact; too small to hold anything."""

RECESS_M = 2e-5
"""How far a pad's cushion lies behind it. MuJoCo takes a contact with adhesion as one without friction where its gap is above
zero, and the curved way of a moving arm parts the faces by some µm within a step: with friction and adhesion in one contact
the plate slid off under a tool that moved at 0.13 m/s."""

HINGE = ("hinge_y", "hinge_x", "swivel")
"""The hinge's joints from the UAV to the plate: the plate's attitude in the body's is Ry Rx Rz of them."""


class Magnet(NamedTuple):
    """What the magnet is. Force, gap and residual force: Ixtur MAP-6 (35 x 35 mm face, plate from 4 mm); facts E."""

    rated_force: float = 177.0  # N in contact; 79, 44, 22 N at 0.1, 0.2, 0.4 mm
    gap_scale: float = 0.2e-3  # m, fitted to those three: 0.201, 0.199, 0.218 mm
    residual_force: float = 0.3  # N, current off
    shear_share: float = 0.2  # rule of the trade: a magnet slides at a fifth of its pull
    time_constant: float = 0.02  # s, of the current (assumption: L/R of a small holding magnet; no source found)
    pad_radius: float = 0.015  # m (assumption: the 35 mm square's pull acts as if on a circle inside it)
    reach: float = 2e-3  # m, gap within which contact damps an approach (assumption: eddy currents, squeezed air)
    health: float = 1.0  # share of the rated current that the coil lets through; less is a fault to be found


class HingePlate(NamedTuple):
    """Steel disc on the spherical hinge below the UAV."""

    radius: float = 0.022  # m: covers the magnet's pads up to an offset of 7 mm
    thickness: float = 0.004  # m: a MAP-6 needs 4 mm for its full force (facts E)
    drop: float = 0.012  # m, pivot to the plate's lower face
    density: float = 7850.0  # kg/m³, steel: 48 g, which the UAV carries beyond its own mass
    # Assumptions: two crossed axes on small ball bearings. The plate's own weight returns it with 4.7 N·mm per rad only:
    # the paper's scene has 1 N·mm of friction, which would leave it hanging askew by 12 degrees.
    friction: float = 1e-4  # N·m
    damping: float = 1e-5  # N·m·s
    range_deg: float = 45.0


PARAMETERS = np.dtype(
    [
        ("rated", "f8"),
        ("gap_scale", "f8"),
        ("residual", "f8"),
        ("health", "f8"),
        ("current_gain", "f8"),  # share of a step that the current makes in one tick
        ("test_ticks", "i8"),
        ("pad", "i8", (PADS,)),  # geom of each pad
        ("plate_geom", "i8"),
        ("plate", "i8"),  # body
        ("tool", "i8"),  # body
        ("thickness", "f8"),  # m, from the plate's middle to its face, plus a pad's own radius
        ("plate_radius", "f8"),
    ]
)

STATE = np.dtype(
    [
        ("current", "f8"),  # share of the rated current
        ("on_ticks", "i8"),  # ticks since it was switched on
        ("report", "f8"),  # N in contact that the current promises; NaN before the first self-test
        ("fault", "i8"),  # 1: the current did not rise as it should
        ("gap", "f8", (PADS,)),  # m, of each pad
        ("touching", "i8"),  # pads in contact
        ("pull", "f8"),  # N, sum of the pads' attraction, whether or not something bears against it
    ]
)


@njit(cache=True)
def pull(gap: float, current: float, rated: float, gap_scale: float, residual: float) -> float:
    """Force in N between face and plate at a `gap` in m under a share `current` of the rated current."""
    share = 1.0 + max(gap, 0.0) / gap_scale
    return (residual + (rated - residual) * current * current) / (share * share)


@njit(cache=True)
def energise(
    command: int,
    geom_xpos: Array,
    geom_xmat: Array,
    xipos: Array,
    p_: NDArray[np.void],
    s_: NDArray[np.void],
    xfrc_applied: Array,
) -> None:
    """One tick: the coil's current, each pad's gap and pull, and their wrenches on plate and tool into `xfrc_applied`.

    The arrays are MuJoCo's, one step old: in flight, at 0.1 m/s, a gap is 0.1 mm behind. The rows of the plate and of the
    tool belong to the magnet alone.
    """
    p, s = p_[0], s_[0]
    _switch(command, p, s)
    b, plate, tool = p.plate_geom, p.plate, p.tool
    nx, ny, nz = geom_xmat[b, 2], geom_xmat[b, 5], geom_xmat[b, 8]
    xfrc_applied[plate, :] = 0.0
    xfrc_applied[tool, :] = 0.0
    s.touching, s.pull = 0, 0.0
    for i in range(PADS):
        x, y, z = geom_xpos[p.pad[i], 0], geom_xpos[p.pad[i], 1], geom_xpos[p.pad[i], 2]
        dx, dy, dz = x - geom_xpos[b, 0], y - geom_xpos[b, 1], z - geom_xpos[b, 2]
        height = nx * dx + ny * dy + nz * dz
        s.gap[i] = -height - p.thickness
        # A pad that the plate does not cover pulls at nothing, nor does one that is beyond it.
        if dx * dx + dy * dy + dz * dz - height * height > p.plate_radius**2 or height > 0.0:
            continue
        s.touching += s.gap[i] < TOUCHING_M
        force = pull(s.gap[i], s.current, p.rated, p.gap_scale, p.residual) / PADS
        s.pull += force
        _push(xfrc_applied, plate, xipos, x, y, z, -force * nx, -force * ny, -force * nz)
        _push(xfrc_applied, tool, xipos, x, y, z, force * nx, force * ny, force * nz)


@njit(cache=True)
def _push(
    wrench: Array, body: int, xipos: Array, x: float, y: float, z: float, fx: float, fy: float, fz: float
) -> None:
    # Adds a force at a point, world, to the wrench at the body's centre of mass.
    x, y, z = x - xipos[body, 0], y - xipos[body, 1], z - xipos[body, 2]
    wrench[body, 0] += fx
    wrench[body, 1] += fy
    wrench[body, 2] += fz
    wrench[body, 3] += y * fz - z * fy
    wrench[body, 4] += z * fx - x * fz
    wrench[body, 5] += x * fy - y * fx


@njit(cache=True)
def _switch(command: int, p: Record, s: Record) -> None:
    s.on_ticks = s.on_ticks + 1 if command != OFF else 0
    tested = s.on_ticks > p.test_ticks
    # A coil that fails later, while it holds something, is found as well.
    if s.on_ticks == p.test_ticks or (tested and command == ON):
        s.report = p.rated * s.current * s.current
        s.fault = s.report < 0.9 * p.rated
    wanted = p.health if command == ON or (command == TEST and not tested) else 0.0
    s.current += p.current_gain * (wanted - s.current)


def breakaway_force(magnet: Magnet, angle: float, lever: float) -> float:
    """Largest force in N at `angle` rad from the face's normal, acting `lever` m above the face, that the magnet holds.

    Two limits, the smaller counts: peeling about the pads' nearest edge, F (cos + sin h/r') = F₀ with r' = r/√2, and
    sliding, F sin = μ (F₀ − F cos).
    """
    c, s = np.cos(angle), np.sin(angle)
    peel = c + s * lever * np.sqrt(2.0) / magnet.pad_radius
    slide = s / magnet.shear_share + c
    return float(magnet.rated_force / max(peel, slide))


def peel_moment(magnet: Magnet, tilt: float) -> float:
    """Moment in N·m about the pads' nearest edge that holds the plate at a `tilt` in rad against the face."""
    lever = np.sqrt(2.0) * magnet.pad_radius
    far = pull(lever * np.sin(tilt), 1.0, magnet.rated_force, magnet.gap_scale, magnet.residual_force)
    return 0.5 * lever * far


def hang_plate(body: mujoco.MjsBody, pivot: Array, p: HingePlate, degree: bool) -> None:
    """Hang the plate on the spherical hinge at `pivot` of the UAV's `body`; `degree`: the angles' unit in the body's spec."""
    plate = body.add_body(name="plate", pos=pivot)
    limit = p.range_deg if degree else np.deg2rad(p.range_deg)
    for name, axis in zip(HINGE, ([0, 1, 0], [1, 0, 0], [0, 0, 1]), strict=True):
        plate.add_joint(
            name=name,
            type=mujoco.mjtJoint.mjJNT_HINGE,
            axis=axis,
            limited=name != "swivel",
            range=[-limit, limit],
            damping=[p.damping, 0, 0],
            frictionloss=p.friction,
        )
    cylinder, metal = mujoco.mjtGeom.mjGEOM_CYLINDER, [0.72, 0.74, 0.77, 1]
    # Placed by its middle, not from end to end, which would turn its z axis over: the magnet's gaps are measured along it.
    middle, size = [0, 0, 0.5 * p.thickness - p.drop], [p.radius, 0.5 * p.thickness, 0]
    plate.add_geom(name="plate", type=cylinder, pos=middle, size=size, density=p.density, rgba=metal, group=2)
    stem = [0, 0, p.thickness - p.drop, 0, 0, 0]
    plate.add_geom(type=cylinder, fromto=stem, size=[0.005, 0, 0], rgba=metal, group=2, mass=0)
    plate.add_site(name="hinge")
    plate.add_site(name="plate", pos=[0, 0, -p.drop])


def mount_face(body: mujoco.MjsBody, height: float, magnet: Magnet, radius: float = 0.003) -> None:
    """Put the face's pads, spheres of `radius` m, on `body` so that they touch the plane z = `height` of its frame."""
    for i in range(PADS):
        angle = 0.5 * np.pi * i
        x, y = magnet.pad_radius * np.cos(angle), magnet.pad_radius * np.sin(angle)
        for name, recess in (("pad", 0.0), ("cushion", RECESS_M)):
            body.add_geom(
                name=f"{name}_{i + 1}",
                type=mujoco.mjtGeom.mjGEOM_SPHERE,
                size=[radius, 0, 0],
                pos=[x, y, height - radius - recess],
                mass=0,
                contype=0,
                conaffinity=0,
                group=3,
            )


def couple(spec: mujoco.MjSpec, plate: str, magnet: Magnet) -> None:
    """Contacts of the pads with the geom `plate`, a cylinder whose lower end is the face that is gripped."""
    stiff = {"solref": [max(0.002, 2.0 * spec.option.timestep), 1.0], "solimp": [0.9999, 0.9999, 0.001, 0.5, 2.0]}
    for i in range(PADS):
        spec.add_pair(
            name=f"magnet_{i + 1}",
            geomname1=f"pad_{i + 1}",
            geomname2=plate,
            condim=3,
            friction=[magnet.shear_share, magnet.shear_share, 0.0, 0.0, 0.0],
            # As stiff as a step of 1 ms allows: the rating presses the faces together by less than 1 µm.
            **stiff,
        )
        spec.add_pair(
            name=f"cushion_{i + 1}",
            geomname1=f"cushion_{i + 1}",
            geomname2=plate,
            condim=1,
            gap=magnet.reach,
            # A hint of adhesion keeps the contact active over the reach: there it damps the snap of a light plate onto the
            # face, which takes less than a step. It cannot do the pulling: MuJoCo drops a contact's friction under tension.
            adhesion=CUSHION_N,
            **stiff,
        )


def device(model: mujoco.MjModel, plate: str, magnet: Magnet) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """Parameters and initial state, switched off, of the magnet of a compiled scene."""
    p, s = np.zeros(1, PARAMETERS), np.zeros(1, STATE)
    geom = model.geom(plate)
    p["rated"], p["gap_scale"], p["residual"] = magnet.rated_force, magnet.gap_scale, magnet.residual_force
    p["health"] = magnet.health
    p["current_gain"] = 1.0 - np.exp(-model.opt.timestep / magnet.time_constant)
    p["test_ticks"] = round(5.0 * magnet.time_constant / model.opt.timestep)
    p["pad"] = [model.geom(f"pad_{i + 1}").id for i in range(PADS)]
    p["plate_geom"], p["plate"], p["tool"] = geom.id, geom.bodyid[0], model.geom("pad_1").bodyid[0]
    p["thickness"] = geom.size[1] + model.geom("pad_1").size[0]
    p["plate_radius"] = geom.size[0]
    s["report"] = np.nan
    return p, s
