"""The scene, composed with `MjSpec` of arm, tool, UAV and gear: the one place that decides what stands where.

| UAV | how it is bound | parts |
|---|---|---|
| `hinged` | by the spherical hinge on the arm's end effector, for good: the paper's demonstrator | none: nothing touches |
| `free` | not at all: flies, is gripped at its hinge plate, stands on its skids | `magnet`, `camera`, `cradle`, each optional |

Where the sea moves, arm, cradle and floor stand on a `deck`.
Another kind of catcher, or no arm at all, is one more branch of `scene_spec`. Shapes never collide by MuJoCo's
masks: what may touch is a table of explicit pairs (`contacts`).
"""

import warnings
from typing import Literal, NamedTuple

import mujoco
import numpy as np

from armland.models.description import compile_spec
from armland.models.parameters import arm_spec
from armland.plant.scene.arm import add_links, add_motors, scale_inertia
from armland.plant.scene.contacts import add_contacts
from armland.plant.scene.deck import JOINTS, moves, put_on_deck, settle_solver
from armland.plant.scene.eye import mount_camera, mount_marker
from armland.plant.scene.gear import add_cradle, add_tool, check_gear, couple, cradle_position
from armland.plant.scene.sensors import add_sensors, sensor_addresses
from armland.plant.scene.surroundings import add_surroundings
from armland.plant.scene.uav import ON_ARM, ON_UAV, PLATE, UAV, hinge_on_arm, let_fly, set_stops, site, uav_spec
from armland.rotations import Array
from armland.scenario import Scenario

Bond = Literal["hinged", "free"]

PARTS = ("magnet", "camera", "cradle")
"""What a scene with a free UAV may hold besides."""


class Scene(NamedTuple):
    """MuJoCo's model of all that there is, with addresses of joints, bodies and sensors, and a few numbers of the UAV."""

    model: mujoco.MjModel
    bond: Bond
    parts: tuple[str, ...]  # of `PARTS`
    joints: int
    joint_qpos: np.ndarray  # (n,) addresses in qpos
    joint_dof: np.ndarray  # (n,) addresses in qvel
    hinge_qpos: np.ndarray  # (3,) in the order of `ON_ARM` or `ON_UAV`
    hinge_dof: np.ndarray  # (3,)
    uav_qpos: np.ndarray  # free: (7,) position of the centre of mass [W], quaternion scalar first; hinged: (0,)
    uav_dof: np.ndarray  # free: (6,) its velocity [W], angular velocity [B]; hinged: (0,)
    uav_body: int  # row of xfrc_applied for the rotors' wrench
    plate_body: int  # -1 where there is no plate
    tool_body: int
    uav_mass: float  # kg, with plate and load: what flies and what the cradle bears
    lever: Array  # (3,) m, B: centre of mass to the pivot
    put_down: Array  # (3,) m, D: pivot position with the UAV level on the rails; NaN where there is no cradle
    deck_qpos: int  # first address of the deck's joints in qpos; −1 where there is no deck
    deck_dof: int  # and in qvel
    sensor: dict[str, int]  # address of each sensor's first element in sensordata


def build_scene(scenario: Scenario, bond: Bond, parts: tuple[str, ...] = PARTS) -> Scene:
    """Compose and compile the scene of a scenario's arm, tool, UAV and gear.

    Args:
        scenario: what the plant really has.
        bond: whether the UAV is hinged on the arm or free.
        parts: what there is besides, of `PARTS`; a scene with a hinged UAV has none of them.

    Raises:
        ModelError: an arm or UAV file that cannot be used, or gear that does not fit together.
        ConfigurationError: a cradle that would lie on the floor.
    """
    spec, joints = scene_spec(scenario, bond, parts)
    with warnings.catch_warnings():
        # No other scene has the arm's names, and none is saved.
        warnings.filterwarnings("ignore", message="Attaching a spec with an empty prefix")
        model = compile_spec(spec, "the scene")
    set_stops(model, scenario.hinge)
    scale_inertia(model, scenario.arm.inertia_scale, [model.joint(name).id for name in joints])
    settle_solver(model)
    return _scene(model, joints, scenario, bond, parts if bond == "free" else ())


def scene_spec(scenario: Scenario, bond: Bond, parts: tuple[str, ...] = PARTS) -> tuple[mujoco.MjSpec, list[str]]:
    """The scene, not yet compiled, and the names of the arm's joints; arguments and errors as for `build_scene`."""
    spec = arm_spec(scenario)
    joints = [j.name for j in spec.joints]
    uav = uav_spec(scenario)
    links = add_links(spec) if bond == "free" else []
    add_motors(spec)
    if scenario.sea.moves and bond == "free":
        spec = put_on_deck(spec)
    _set_options(spec, scenario, bond)
    add_surroundings(spec)
    if bond == "hinged":
        hinge_on_arm(spec, uav, scenario.hinge)
    else:
        _add_free(spec, uav, scenario, parts)
    for geom in spec.geoms:
        geom.contype, geom.conaffinity = 0, 0
    for mark in spec.sites:
        # Marks of frames, not to be drawn.
        mark.group = 4
    if bond == "free":
        if "magnet" in parts:
            couple(spec, scenario.magnet)
        add_contacts(spec, links)
    add_sensors(spec, joints, bond == "free", "cradle" in parts, "magnet" in parts)
    return spec, joints


def _set_options(spec: mujoco.MjSpec, scenario: Scenario, bond: Bond) -> None:
    o, off = spec.option, mujoco.mjtDisableBit
    o.timestep, o.gravity = 1.0 / scenario.run.rate_hz, scenario.environment.gravity_mps2
    o.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    # A diverged run must show: by default MuJoCo puts the scene back to its start and goes on.
    o.disableflags |= int(off.mjDSBL_AUTORESET)
    if bond == "free":
        # Two trees only: finding those that do not touch costs more than it saves.
        o.disableflags |= int(off.mjDSBL_ISLAND)
        # With pyramidal cones the magnet's shear would depend on direction; the ratio keeps the skids from creeping on the rails.
        o.cone, o.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0
        # Where the pads part and touch again, MuJoCo's own 1e-8 leaves 0.03 N in the hinge; to go on costs no iteration on average.
        o.tolerance = 1e-10


def _add_free(spec: mujoco.MjSpec, uav: mujoco.MjSpec, scenario: Scenario, parts: tuple[str, ...]) -> None:
    check_gear(scenario)
    if "magnet" in parts:
        add_tool(spec, scenario)
    if "camera" in parts:
        point = scenario.tool.length_m - scenario.tool.sensor_length_m
        mount_camera(spec.body("armland_tool"), point, scenario.camera)
    lever = site(uav, "pivot").pos - site(uav, "cm").pos
    body = let_fly(spec, uav, scenario)
    if "camera" in parts:
        mount_marker(body, scenario.camera)
    spec.worldbody.add_frame().attach_body(body, UAV, "")
    if "cradle" in parts:
        add_cradle(spec, scenario, cradle_position(scenario, lever))


def _scene(model: mujoco.MjModel, joints: list[str], scenario: Scenario, bond: Bond, parts: tuple[str, ...]) -> Scene:
    ids = [model.joint(name).id for name in joints]
    hinge = [model.joint(f"{UAV}{name}").id for name in (ON_UAV if bond == "free" else ON_ARM)]
    q, v, uav = model.jnt_qposadr, model.jnt_dofadr, model.body(f"{UAV}uav").id
    free = model.joint(f"{UAV}free").id if bond == "free" else -1
    deck = model.joint(JOINTS[0]).id if moves(model) else -1
    pivot, skids = model.site(f"{UAV}pivot").pos, scenario.skids
    put_down = np.full(3, np.nan)
    if "cradle" in parts:
        put_down = model.body("cradle").pos + [0.0, 0.0, pivot[2] - skids.z_m + skids.radius_m]
    return Scene(
        model=model,
        bond=bond,
        parts=parts,
        joints=len(joints),
        joint_qpos=q[ids].copy(),
        joint_dof=v[ids].copy(),
        hinge_qpos=q[hinge].copy(),
        hinge_dof=v[hinge].copy(),
        uav_qpos=q[free] + np.arange(7 if bond == "free" else 0),
        uav_dof=v[free] + np.arange(6 if bond == "free" else 0),
        uav_body=uav,
        plate_body=model.body(PLATE).id if bond == "free" else -1,
        tool_body=model.body("armland_tool").id,
        uav_mass=float(model.body_subtreemass[uav]),
        lever=pivot - model.site(f"{UAV}cm").pos,
        put_down=put_down,
        deck_qpos=int(q[deck]) if deck >= 0 else -1,
        deck_dof=int(v[deck]) if deck >= 0 else -1,
        sensor=sensor_addresses(model),
    )
