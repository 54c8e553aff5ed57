"""Scene of a whole landing: the UAV flies free, a hinge plate hangs below it, the arm's magnet grips the plate, a cradle waits.

Composed with `MjSpec` from the same arm and UAV files as the paper's scene. Nothing collides by MuJoCo's masks: what may touch
is a table of explicit pairs (`landing_contacts`), which costs less and leaves no pair to chance.

| sensor | what, frame |
|---|---|
| `q_*`, `qd_*`, `tau_*` | position, velocity and torque of each of the arm's joints |
| `force`, `torque` | flange on tool at the force-torque sensor's origin, sensor axes |
| `r` `v`, `r_cm` `v_cm`, `ee_pos` `ee_vel` | position, velocity of the pivot on the UAV, of its CM, of the end effector [w] |
| `plate_pos`, `plate_vel` | the same of the middle of the plate's lower face [w] |
| `quat`, `plate_quat`, `ee_quat` | attitudes, world<-body |
| `gyro`, `plate_rate` | angular velocity of the UAV [b], of the plate [w] |
| `hinge_force` | force of the UAV on the plate through the hinge, plate axes: minus the force on the UAV |
| `magnet_force` | contact force of the face on the plate [w], without the magnet's pull: `xfrc_applied[plate_body]` holds that |
| `cradle_force`, `ground_force` | contact force of the rails, of the floor on UAV and plate [w] |
| `arm_cradle_force`, `arm_floor_force`, `arm_uav_force` | contact forces of the arm on what it should not touch [w] |
"""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.mission.landing_scenario import Eye
from armland.models.description import EE_SITE, compile_spec, read_spec, resolve
from armland.models.parameters import arm_spec
from armland.plant.landing_contacts import PLATE, add_contacts
from armland.plant.landing_eye import mount_camera, mount_marker
from armland.plant.magnet import HINGE, HingePlate, Magnet, hang_plate, mount_face
from armland.plant.scene import ROTORS, UAV, _add_motors, _add_surroundings, _camera_axes
from armland.rotations import Array
from armland.scenario import Scenario

NET_FORCE = 3
"""MuJoCo's code for a contact sensor that sums up the forces of all its contacts, in world axes."""


class Skids(NamedTuple):
    """Two tubes across below the UAV, along body y: they cross the rails, so an offset of either direction does no harm.

    Their mass is part of the UAV's. Sizes are assumptions, chosen so that the UAV also stands on the ground.
    """

    x: float = 0.15  # m, of each tube, before and behind the centre of mass: leaves the marker in view
    half_length: float = 0.17  # m
    radius: float = 0.006  # m
    z: float = -0.095  # m, tube's axis below the centre of mass: 29 mm below the hanging plate's face


class Cradle(NamedTuple):
    """Two round rails that point away from the arm's base, open towards it, so that the arm moves along the slot between them.

    Sizes are assumptions: as low and as near as the LWR can put the UAV down with 20 degrees of margin at its shoulder.
    """

    position: tuple[float, float, float] = (0.68, 0.0, 0.66)  # m, world: the slot's middle at the rails' upper edge
    heading: float = 0.0  # rad, of the rails in the world
    gap: float = 0.196  # m, clear width of the slot; the arm's widest part that passes measures 0.12 m
    length: float = 0.36  # m
    radius: float = 0.012  # m


class LandingGear(NamedTuple):
    """What a landing needs beyond arm and UAV."""

    plate: HingePlate = HingePlate()
    skids: Skids = Skids()
    cradle: Cradle = Cradle()
    magnet: Magnet = Magnet()
    arm_radius: float = 0.06  # m, of the capsules that stand for the arm's links
    eye: Eye = Eye()


class LandingScene(NamedTuple):
    """A compiled scene and where things are in it."""

    model: mujoco.MjModel
    gear: LandingGear
    joints: int
    joint_qpos: np.ndarray  # (n,) addresses in qpos
    joint_dof: np.ndarray  # (n,) addresses in qvel
    uav_qpos: np.ndarray  # (7,) position of the centre of mass [w], quaternion scalar first
    uav_dof: np.ndarray  # (6,) its velocity [w], angular velocity [b]
    hinge_qpos: np.ndarray  # (3,) as in `HINGE`
    hinge_dof: np.ndarray  # (3,)
    uav_body: int  # row of xfrc_applied for the rotors' wrench
    plate_body: int
    uav_mass: float  # kg, with the plate: what flies and what the cradle bears
    sensor: dict[str, int]  # address of each sensor's first element in sensordata
    put_down: Array  # (3,) m, world: pivot position with the UAV level on the rails


def build_landing_scene(scenario: Scenario, gear: LandingGear | None = None) -> LandingScene:
    """Compose and compile the landing scene of a scenario's arm, tool and UAV.

    Raises:
        ModelError: an arm or UAV file that cannot be used, or gear that does not fit together.
    """
    gear = gear or LandingGear()
    spec, joints = landing_spec(scenario, gear)
    return _scene(compile_spec(spec, "the landing scene"), joints, gear)


def landing_spec(scenario: Scenario, gear: LandingGear) -> tuple[mujoco.MjSpec, list[str]]:
    """The landing scene, not yet compiled, and the names of the arm's joints; errors as for `build_landing_scene`."""
    _check(gear, scenario)
    spec = arm_spec(scenario)
    joints = [j.name for j in spec.joints]
    # Where the plate slips, a solver that stops at the default of 1e-8 leaves 0.03 N; to go on costs no iteration on average.
    spec.option.timestep, spec.option.tolerance = 1.0 / scenario.run.rate_hz, 1e-10
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    # A diverged run must show: by default MuJoCo puts the scene back to its start and goes on.
    # Two trees only: finding those that do not touch costs more than it saves.
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET) | int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
    # With pyramidal cones the magnet's shear would depend on direction; the ratio keeps the skids from creeping on the rails.
    spec.option.cone, spec.option.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0
    spec.option.tolerance = 1e-10  # where the pads part and touch again, MuJoCo's own 1e-8 leaves 0.02 N in the hinge
    links = _add_links(spec, gear.arm_radius)
    _add_motors(spec)
    _add_surroundings(spec)
    eye, target = np.array([1.65, -1.7, 1.2]), np.array([0.45, 0.0, 0.43])
    spec.worldbody.add_camera(name="landing", pos=eye, xyaxes=_camera_axes(eye, target), fovy=32)
    _add_tool(spec, scenario, gear)
    _attach_uav(spec, scenario, gear)
    _add_cradle(spec, gear.cradle)
    for geom in spec.geoms:
        geom.contype, geom.conaffinity = 0, 0
    for site in spec.sites:
        # Marks of frames, not to be drawn.
        site.group = 4
    add_contacts(spec, links, gear.magnet)
    _add_sensors(spec, joints)
    return spec, joints


def _check(gear: LandingGear, scenario: Scenario) -> None:
    lowest = scenario.tool.sensor_length_m + gear.plate.drop
    if scenario.tool.length_m <= lowest:
        raise ModelError(
            f"tool.length_m = {scenario.tool.length_m:g} leaves no room for the magnet below the hinge plate; it must exceed {lowest:g}"
        )
    if gear.plate.radius < gear.magnet.pad_radius:
        raise ModelError(
            f"the plate's radius of {gear.plate.radius:g} m does not cover the magnet's pads; it must exceed "
            f"{gear.magnet.pad_radius:g} m"
        )
    outside = 0.5 * gear.cradle.gap + 2.0 * gear.cradle.radius
    if gear.skids.half_length < outside:
        raise ModelError(
            f"the skids' half length of {gear.skids.half_length:g} m does not reach over the rails; it must exceed {outside:g} m"
        )


def _add_tool(spec: mujoco.MjSpec, scenario: Scenario, gear: LandingGear) -> None:
    # The pivot of the plate gripped flush is the arm's end effector point, as in the paper's scene.
    face = scenario.tool.length_m - scenario.tool.sensor_length_m - gear.plate.drop
    tool = spec.body("armland_tool")
    mount_face(tool, face, gear.magnet)
    # From the flange on; what is below, the wrist's shape covers.
    _capsule(tool, "tool", [0, 0, -scenario.tool.sensor_length_m - 0.01, 0, 0, face - 0.03], 0.03)
    mount_camera(tool, scenario.tool.length_m - scenario.tool.sensor_length_m, gear.eye)


def _add_links(spec: mujoco.MjSpec, radius: float) -> list[str]:
    # The arm's outer half as capsules from joint to joint; only there can it reach the cradle, the floor or the UAV.
    model = compile_spec(spec, "the arm")
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    names = []
    for i in range(model.njnt // 2, model.njnt - 1):
        body = int(model.jnt_bodyid[i])
        ends = (data.xanchor[[i, i + 1]] - data.xpos[body]) @ data.xmat[body].reshape(3, 3)
        if np.linalg.norm(ends[1] - ends[0]) < 2.0 * radius:
            # Too short for a capsule that ends at its joints: a sphere.
            ends = ends.mean(axis=0) + np.array([[0.0, 0.0, -1e-4], [0.0, 0.0, 1e-4]])
        names.append(f"link_{i + 1}_shape")
        _capsule(spec.joint(model.joint(i).name).parent, names[-1], ends.ravel(), radius)
    return names


def _capsule(body: mujoco.MjsBody, name: str, ends: list[float] | Array, radius: float) -> None:
    # Group 3: touches, but is not drawn.
    body.add_geom(name=name, type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=ends, size=[radius, 0, 0], mass=0, group=3)


def _attach_uav(spec: mujoco.MjSpec, scenario: Scenario, gear: LandingGear) -> None:
    uav = read_spec(resolve(scenario.uav.file))
    needed = ["cm", "pivot", *(f"rotor_{i + 1}" for i in range(ROTORS))]
    sites = {s.name: s for s in uav.sites}
    missing = [n for n in needed if n not in sites] + ["uav"] * (uav.body("uav") is None)
    if missing:
        raise ModelError(
            f"UAV file {scenario.uav.file!r} lacks {', '.join(missing)}; it needs a body 'uav' and the other sites"
        )
    body = uav.body("uav")
    body.add_freejoint(name="free")
    rotors = [sites[f"rotor_{i + 1}"].pos for i in range(ROTORS)]
    for i in range(2):
        _capsule(body, f"frame_{i + 1}", [*rotors[i], *rotors[i + 2]], 0.015)
    _add_skids(body, gear.skids)
    hang_plate(body, sites["pivot"].pos.copy(), gear.plate, uav.compiler.degree)
    mount_marker(body, gear.eye)
    spec.worldbody.add_frame().attach_body(body, UAV, "")


def _add_skids(body: mujoco.MjsBody, skids: Skids) -> None:
    capsule, y, z = mujoco.mjtGeom.mjGEOM_CAPSULE, skids.half_length, skids.z
    look = {"group": 2, "mass": 0, "rgba": [0.72, 0.74, 0.77, 1]}
    for i, x in enumerate((skids.x, -skids.x)):
        body.add_geom(name=f"skid_{i + 1}", type=capsule, fromto=[x, -y, z, x, y, z], size=[skids.radius, 0, 0], **look)
        for side in (-1, 1):
            leg = [0.75 * x, side * 0.09, 0.0, x, side * 0.6 * y, z]
            body.add_geom(type=capsule, fromto=leg, size=[0.6 * skids.radius, 0, 0], **look)


def _add_cradle(spec: mujoco.MjSpec, c: Cradle) -> None:
    half = 0.5 * c.heading
    body = spec.worldbody.add_body(name="cradle", pos=c.position, quat=[np.cos(half), 0, 0, np.sin(half)])
    look = {"type": mujoco.mjtGeom.mjGEOM_CAPSULE, "rgba": [0.45, 0.48, 0.53, 1], "group": 2}
    for i, side in enumerate((-1.0, 1.0)):
        x, y, z = 0.5 * c.length, side * (0.5 * c.gap + c.radius), -c.radius
        body.add_geom(name=f"rail_{i + 1}", fromto=[-x, y, z, x, y, z], size=[c.radius, 0, 0], **look)
        for foot in (-0.3, 0.8):
            # Legs stand outside the slot.
            leg = [foot * x, y, z, foot * x, 1.5 * y, -c.position[2]]
            body.add_geom(fromto=leg, size=[0.7 * c.radius, 0, 0], **look)


def _add_sensors(spec: mujoco.MjSpec, joints: list[str]) -> None:
    S, O = mujoco.mjtSensor, mujoco.mjtObj
    for prefix, kind in (("q", S.mjSENS_JOINTPOS), ("qd", S.mjSENS_JOINTVEL), ("tau", S.mjSENS_JOINTACTFRC)):
        for name in joints:
            spec.add_sensor(name=f"{prefix}_{name}", type=kind, objtype=O.mjOBJ_JOINT, objname=name)
    cm, pivot, fts = f"{UAV}cm", f"{UAV}pivot", "armland_fts"
    for kind, places in (
        (S.mjSENS_FORCE, {"force": fts, "hinge_force": f"{UAV}hinge"}),
        (S.mjSENS_TORQUE, {"torque": fts}),
        (S.mjSENS_GYRO, {"gyro": cm}),
        (S.mjSENS_FRAMEQUAT, {"quat": cm, "plate_quat": PLATE, "ee_quat": EE_SITE}),
        (S.mjSENS_FRAMEPOS, {"r": pivot, "r_cm": cm, "plate_pos": PLATE, "ee_pos": EE_SITE}),
        (S.mjSENS_FRAMELINVEL, {"v": pivot, "v_cm": cm, "plate_vel": PLATE, "ee_vel": EE_SITE}),
        (S.mjSENS_FRAMEANGVEL, {"plate_rate": PLATE}),
    ):
        for name, site in places.items():
            spec.add_sensor(name=name, type=kind, objtype=O.mjOBJ_SITE, objname=site)
    arm = spec.joints[0].parent
    arm.name = arm.name or "armland_arm"
    body, tree, uav = O.mjOBJ_BODY, O.mjOBJ_XBODY, f"{UAV}uav"
    for name, one, on, other, under in (
        ("magnet_force", body, "armland_tool", body, PLATE),
        ("cradle_force", body, "cradle", tree, uav),
        ("ground_force", O.mjOBJ_GEOM, "floor", tree, uav),
        ("arm_cradle_force", tree, arm.name, body, "cradle"),
        ("arm_floor_force", tree, arm.name, O.mjOBJ_GEOM, "floor"),
        ("arm_uav_force", tree, arm.name, body, uav),
    ):
        sensor = spec.add_sensor(name=name, type=S.mjSENS_CONTACT, objtype=one, objname=on)
        sensor.reftype, sensor.refname = other, under
        sensor.intprm[:3] = [1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE), NET_FORCE, 1]


def _scene(model: mujoco.MjModel, joints: list[str], gear: LandingGear) -> LandingScene:
    ids = [model.joint(name).id for name in joints]
    hinge = [model.joint(f"{UAV}{name}").id for name in HINGE]
    free = model.joint(f"{UAV}free").id
    q, v, uav = model.jnt_qposadr, model.jnt_dofadr, model.body(f"{UAV}uav").id
    above = model.site(f"{UAV}pivot").pos[2] - gear.skids.z + gear.skids.radius
    return LandingScene(
        model=model,
        gear=gear,
        joints=len(joints),
        joint_qpos=q[ids].copy(),
        joint_dof=v[ids].copy(),
        uav_qpos=q[free] + np.arange(7),
        uav_dof=v[free] + np.arange(6),
        hinge_qpos=q[hinge].copy(),
        hinge_dof=v[hinge].copy(),
        uav_body=uav,
        plate_body=model.body(PLATE).id,
        uav_mass=float(model.body_subtreemass[uav]),
        sensor={model.sensor(i).name: int(model.sensor_adr[i]) for i in range(model.nsensor)},
        put_down=np.array(gear.cradle.position) + [0.0, 0.0, above],
    )
