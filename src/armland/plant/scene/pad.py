"""The scene of a landing without an arm: a flat pad on the deck, a camera below a window in it, and the same UAV as an arm catches."""

import warnings

import mujoco
import numpy as np

from armland.mission.unaided.plan import places
from armland.models.description import EE_SITE, compile_spec
from armland.plant.scene.composition import Scene
from armland.plant.scene.contacts import add_contacts, add_pair
from armland.plant.scene.deck import DECK, JOINTS, moves, put_on_deck, settle_solver
from armland.plant.scene.eye import mount_marker
from armland.plant.scene.platform import PLATFORM, draw_legs, geometry, put_on_platform
from armland.plant.scene.sensors import DECK_SENSORS, NET_FORCE, add_frames, sensor_addresses
from armland.plant.scene.surroundings import add_surroundings
from armland.plant.scene.uav import ON_UAV, PLATE, UAV, let_fly, set_stops, site, uav_spec
from armland.records import MOST_ROTORS
from armland.rotations import Array
from armland.scenario import Scenario

PAD = "pad"
THICK_M = 0.02
"""Half the pad's thickness."""

PARTS = ("camera", "pad")

ON_FRAME = 0.4
"""Friction of frame and plate on the pad, as on rails."""


def build_pad_scene(scenario: Scenario, on_legs: bool = False) -> Scene:
    """Compose and compile the scene of a scenario's UAV and pad.

    Args:
        scenario: what the plant really has.
        on_legs: whether the pad stands on a platform on six legs, where the sea moves the deck.

    Raises:
        ModelError: a UAV file that cannot be used.
    """
    spec, stand = pad_scene_spec(scenario, on_legs)
    with warnings.catch_warnings():
        # No name is there twice, and none is saved.
        warnings.filterwarnings("ignore", message="Attaching a spec with an empty prefix")
        model = compile_spec(spec, "the scene")
    set_stops(model, scenario.hinge)
    settle_solver(model)
    return _scene(model, stand)


def pad_scene_spec(scenario: Scenario, on_legs: bool = False) -> tuple[mujoco.MjSpec, Array]:
    """The scene, not yet compiled, and the pivot (3,), m, D, of a UAV that stands; arguments and errors as for `build_pad_scene`."""
    spec = mujoco.MjSpec()
    spec.compiler.degree, spec.compiler.autolimits = False, True
    uav = uav_spec(scenario)
    lever = site(uav, "pivot").pos - site(uav, "cm").pos
    stand, eye = places(scenario, lever)
    _add_pad(spec, scenario, stand, eye)
    on_legs = on_legs and scenario.sea.moves
    if on_legs:
        spec = put_on_platform(spec, geometry(scenario)[0])
    if scenario.sea.moves:
        spec = put_on_deck(spec)
        # What stands on the deck keeps bodies of its own: contacts and forces are asked of them.
        spec.compiler.fusestatic = False
    _set_options(spec, scenario)
    add_surroundings(spec)
    if on_legs:
        draw_legs(spec, *geometry(scenario))
    body = let_fly(spec, uav, scenario)
    mount_marker(body, scenario.camera)
    spec.worldbody.add_frame().attach_body(body, UAV, "")
    for geom in spec.geoms:
        geom.contype, geom.conaffinity = 0, 0
    for mark in spec.sites:
        mark.group = 4
    add_contacts(spec, [])
    _let_touch(spec, scenario.pad.friction)
    _add_sensors(spec, PLATFORM if on_legs else DECK)
    return spec, stand


def _add_pad(spec: mujoco.MjSpec, scenario: Scenario, stand: Array, eye: Array) -> None:
    p, box = scenario.pad, mujoco.mjtGeom.mjGEOM_BOX
    pad = spec.worldbody.add_body(name=PAD, pos=[stand[0], stand[1], p.height_m])
    look = {"type": box, "rgba": [0.36, 0.42, 0.48, 1], "group": 2}
    pad.add_geom(name=PAD, size=[p.half_m, p.half_m, THICK_M], pos=[0, 0, -THICK_M], mass=2.0, **look)
    for x in (-0.8, 0.8):
        for y in (-0.8, 0.8):
            half = 0.5 * p.height_m - THICK_M
            pad.add_geom(
                size=[0.02, 0.02, half], pos=[x * p.half_m, y * p.half_m, -half - 2.0 * THICK_M], mass=0, **look
            )
    ring = {"type": mujoco.mjtGeom.mjGEOM_CYLINDER, "group": 2, "mass": 0}
    pad.add_geom(size=[0.3, 0.0005, 0], pos=[0, 0, 0.0002], rgba=[0.92, 0.92, 0.9, 1], **ring)
    pad.add_geom(size=[0.27, 0.0006, 0], pos=[0, 0, 0.0002], rgba=[0.36, 0.42, 0.48, 1], **ring)
    eye = eye - pad.pos
    pad.add_site(name=EE_SITE, pos=eye - np.array(scenario.camera.position_m))
    pad.add_site(name="armland_fts")
    pad.add_camera(name="eye", pos=eye, quat=[0.0, 1.0, 0.0, 0.0], fovy=scenario.camera.field_of_view_deg[1])


def _set_options(spec: mujoco.MjSpec, scenario: Scenario) -> None:
    o, off = spec.option, mujoco.mjtDisableBit
    o.timestep, o.gravity = 1.0 / scenario.run.rate_hz, scenario.environment.gravity_mps2
    o.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    o.disableflags |= int(off.mjDSBL_AUTORESET) | int(off.mjDSBL_ISLAND)
    o.cone, o.impratio, o.tolerance = mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0, 1e-10


def _let_touch(spec: mujoco.MjSpec, friction: float) -> None:
    here = {g.name for g in spec.geoms}
    for k in (1, 2):
        add_pair(spec, f"{UAV}skid_{k}", PAD, friction, True)
    for name in (PLATE, *(f"{UAV}frame_{i + 1}" for i in range(MOST_ROTORS))):
        if name in here:
            add_pair(spec, name, PAD, ON_FRAME, False)


def _add_sensors(spec: mujoco.MjSpec, deck: str) -> None:
    add_frames(spec, True)
    for sensor in spec.sensors:
        if sensor.name in DECK_SENSORS:
            # To the UAV the platform is the deck.
            sensor.objname = deck
    S, O = mujoco.mjtSensor, mujoco.mjtObj
    for name, kind, on in (("cradle_force", O.mjOBJ_BODY, PAD), ("ground_force", O.mjOBJ_GEOM, "floor")):
        sensor = spec.add_sensor(name=name, type=S.mjSENS_CONTACT, objtype=kind, objname=on)
        sensor.reftype, sensor.refname = O.mjOBJ_XBODY, f"{UAV}uav"
        sensor.intprm[:3] = [1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE), NET_FORCE, 1]


def _scene(model: mujoco.MjModel, stand: Array) -> Scene:
    hinge = [model.joint(f"{UAV}{name}").id for name in ON_UAV]
    q, v, free = model.jnt_qposadr, model.jnt_dofadr, model.joint(f"{UAV}free").id
    deck, uav = (model.joint(JOINTS[0]).id if moves(model) else -1), model.body(f"{UAV}uav").id
    none = np.zeros(0, int)
    return Scene(
        model=model,
        bond="free",
        parts=PARTS,
        joints=0,
        joint_qpos=none,
        joint_dof=none,
        hinge_qpos=q[hinge].copy(),
        hinge_dof=v[hinge].copy(),
        uav_qpos=q[free] + np.arange(7),
        uav_dof=v[free] + np.arange(6),
        uav_body=uav,
        plate_body=model.body(PLATE).id,
        tool_body=model.body(PAD).id,
        uav_mass=float(model.body_subtreemass[uav]),
        lever=model.site(f"{UAV}pivot").pos - model.site(f"{UAV}cm").pos,
        put_down=stand,
        deck_qpos=int(q[deck]) if deck >= 0 else -1,
        deck_dof=int(v[deck]) if deck >= 0 else -1,
        sensor=sensor_addresses(model),
    )
