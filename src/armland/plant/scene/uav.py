"""The UAV in the scene: hinged on the arm for good, or free with skids, a hanging hinge plate and shapes that can touch.

The UAV's file holds a body `uav` whose origin is its centre of mass, and sites `cm`, `pivot` and `rotor_1` to `rotor_8`.
"""

import mujoco
import numpy as np

from armland.models.airframe.body import add_skids
from armland.models.airframe.rotor_set import beams
from armland.models.description import EE_SITE
from armland.models.parameters import STEEL_KGM3, rotor_set, uav_file, uav_parameters
from armland.plant.scene.arm import add_capsule
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.deviation import ranges
from armland.scenario.gear import Hinge, Plate

UAV = "uav/"
"""Prefix of the UAV's names in the scene."""

PLATE = f"{UAV}plate"
"""Name of the hinge plate's body and of its geom."""

ON_ARM = ("swivel", "hinge_x", "hinge_y")
"""Joints of a UAV that is hinged on the arm, from the arm to the UAV: the UAV's attitude in the arm's is Rz Rx Ry of them."""

ON_UAV = ("hinge_y", "hinge_x", "swivel")
"""Joints of a hanging plate, from the UAV to the plate: the plate's attitude in the UAV's is Ry Rx Rz of them."""

AXES = {"swivel": [0, 0, 1], "hinge_x": [1, 0, 0], "hinge_y": [0, 1, 0]}

PLAY = f"{UAV}play"
"""Joint between UAV and plate along the hinge's upright axis, where the hinge has play."""

LEAST_PLAY_M = 1e-9
"""A range of no width is none to MuJoCo."""

PLAY_HZ, PLAY_DAMPING = 32.0, 0.75
"""Both ends of the play: frequency at which the UAV swings on its hull behind the hinge, and the share of critical damping. Light
frames bend at 30 to 100 Hz; assumption."""

STOP_R, TRIED_NMS = 2000.0, 0.3
"""rad/s² per N·m, see `set_stops`; damping of the stops up to which it holds, N·m·s/rad: c R stays below 600 1/s."""

FRAME_RADIUS_M = 0.015
"""Of the beams that carry the rotors, as far as they can touch."""


def uav_spec(scenario: Scenario) -> mujoco.MjSpec:
    """The UAV's file with the scenario's numbers in place of the file's where it has any, and what the UAV carries.

    Raises:
        ModelError: a file that cannot be used; the message names what it lacks.
    """
    u = scenario.uav
    spec = uav_file(scenario)
    if u.mass_kg is not None or u.inertia_kgm2 is not None or u.extra_mass_kg > 0.0:
        _weigh(spec, scenario)
    if u.lever_m is not None:
        site(spec, "pivot").pos = site(spec, "cm").pos + np.array(u.lever_m)
    return spec


def _weigh(spec: mujoco.MjSpec, scenario: Scenario) -> None:
    own, body = uav_parameters(scenario), spec.body("uav")
    J, body.explicitinertial, body.mass = own.inertia, True, own.mass
    body.ipos, body.iquat, body.inertia = site(spec, "cm").pos, [1.0, 0.0, 0.0, 0.0], np.zeros(3)
    body.fullinertia = [J[0, 0], J[1, 1], J[2, 2], J[0, 1], J[0, 2], J[1, 2]]


def site(spec: mujoco.MjSpec, name: str) -> mujoco.MjsSite:
    """The site `name` of a UAV's spec, which has it."""
    return next(s for s in spec.sites if s.name == name)


def hinge_on_arm(spec: mujoco.MjSpec, uav: mujoco.MjSpec, hinge: Hinge) -> None:
    """Bind the UAV to the arm's end effector by the spherical hinge, its pivot in the end effector point."""
    body, pivot = uav.body("uav"), site(uav, "pivot").pos.copy()
    for name in ON_ARM:
        _add_hinge_joint(body, name, pivot, hinge, uav.compiler.degree)
    body.pos = -pivot
    next(s for s in spec.sites if s.name == EE_SITE).attach_body(body, UAV, "")


def let_fly(spec: mujoco.MjSpec, uav: mujoco.MjSpec, scenario: Scenario) -> mujoco.MjsBody:
    """Put the UAV into the scene as a free body with frame shapes, skids and hinge plate; returns its body."""
    body = uav.body("uav")
    body.add_freejoint(name="free")
    cm = site(uav, "cm").pos
    for i, (one, other) in enumerate(beams(rotor_set(scenario).place)):
        add_capsule(body, f"frame_{i + 1}", [*(cm + one), *(cm + other)], FRAME_RADIUS_M)
    add_skids(body, scenario.skids)
    plate = body.add_body(name="plate", pos=site(uav, "pivot").pos.copy())
    if "hinge.play_m" in ranges(scenario.deviation):
        plate.add_joint(
            name="play",
            type=mujoco.mjtJoint.mjJNT_SLIDE,
            axis=[0, 0, 1],
            limited=True,
            range=[-LEAST_PLAY_M, LEAST_PLAY_M],
        )
    _hang_plate(plate, scenario.plate, scenario.hinge, uav.compiler.degree)
    return body


def set_stops(model: mujoco.MjModel, hinge: Hinge) -> None:
    """Give the hinge's stops, those of its play too, stiffness k and damping c of their own, in the compiled `model`.

    MuJoCo scales a stop's stiffness with the lighter side's inertia, here the plate's of 6e-6 kg·m²: a UAV would lean through it.
    The force of a limit's row is −(K q + B v)/(A + R), with the inverse inertia A behind it: 100 rad/s² per N·m for a UAV on a
    plate that is held, A₀ = 1e5 for a plate that swings freely. R far above the former makes it a spring, K = k R and B = c R;
    far below the latter it leaves the free plate stable, c R < 1/step. So d = A₀/(A₀ + R). Source: MuJoCo's documentation,
    "Solver parameters".
    """
    # The stops of a heavier UAV are stiffer in proportion: with the same R its free plate would be torn about by them.
    ratio = STOP_R / max(hinge.stop_nms / TRIED_NMS, 1.0)
    stops = {f"{UAV}{name}": (hinge.stop_nm, hinge.stop_nms, ratio) for name in ("hinge_x", "hinge_y")}
    stops |= {PLAY: play_stop(float(model.body_mass[model.body(f"{UAV}uav").id]))}
    for name, (k, c, ratio) in stops.items():
        joint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
        if joint < 0:
            continue
        free = float(model.dof_invweight0[model.jnt_dofadr[joint]])
        d = free / (free + ratio)
        # What MuJoCo is given it divides by d² and d, and multiplies the former by d again.
        model.jnt_solref[joint] = [-k * ratio * d, -c * ratio * d]
        model.jnt_solimp[joint] = [d, d, 0.001, 0.5, 2.0]


def play_stop(mass: float) -> tuple[float, float, float]:
    """Stiffness N/m, damping N·s/m and R of `set_stops`, 1/kg, of both ends of the play, for a UAV of `mass`, kg.

    R lies between the inverse masses of a UAV on a plate that is held and of a plate alone.
    """
    omega = 2.0 * np.pi * PLAY_HZ
    return mass * omega**2, 2.0 * PLAY_DAMPING * mass * omega, 2.0 / mass


def _add_hinge_joint(body: mujoco.MjsBody, name: str, pos: Array, hinge: Hinge, degree: bool) -> None:
    limit = hinge.range_deg if degree else np.deg2rad(hinge.range_deg)
    body.add_joint(
        name=name,
        type=mujoco.mjtJoint.mjJNT_HINGE,
        pos=pos,
        axis=AXES[name],
        limited=name != "swivel",
        range=[-limit, limit],
        damping=[hinge.damping_nms, 0, 0],
        frictionloss=hinge.friction_nm,
    )


def _hang_plate(plate: mujoco.MjsBody, p: Plate, hinge: Hinge, degree: bool) -> None:
    for name in ON_UAV:
        _add_hinge_joint(plate, name, np.zeros(3), hinge, degree)
    cylinder, metal = mujoco.mjtGeom.mjGEOM_CYLINDER, [0.72, 0.74, 0.77, 1]
    weight = {"density": STEEL_KGM3} if p.mass_kg is None else {"mass": p.mass_kg}
    # Placed by its middle, not from end to end, which would turn its z axis over: the magnet's gaps are measured along it.
    middle, size = [0, 0, 0.5 * p.thickness_m - p.drop_m], [p.radius_m, 0.5 * p.thickness_m, 0]
    plate.add_geom(name="plate", type=cylinder, pos=middle, size=size, rgba=metal, group=2, **weight)
    stem = [0, 0, p.thickness_m - p.drop_m, 0, 0, 0]
    plate.add_geom(type=cylinder, fromto=stem, size=[0.005, 0, 0], rgba=metal, group=2, mass=0)
    plate.add_site(name="hinge")
    plate.add_site(name="plate", pos=[0, 0, -p.drop_m])
