"""Scene of the demonstrator, composed with `MjSpec`: arm, force-torque sensor, tool, spherical hinge, UAV with four rotors."""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.models.description import EE_SITE, compile_spec, frame_names, read_spec, resolve
from armland.models.parameters import arm_spec
from armland.scenario import Scenario

ROTORS = 4
UAV = "uav/"
"""Prefix of the UAV's names in the scene."""


class Scene(NamedTuple):
    """A compiled scene and where things are in it."""

    model: mujoco.MjModel
    joints: int
    joint_qpos: np.ndarray  # (n,) addresses in qpos
    joint_dof: np.ndarray  # (n,) addresses in qvel
    hinge_qpos: np.ndarray  # (3,) swivel, x, y
    sensor: dict[str, int]  # address of each sensor's first element in sensordata


def build_scene(scenario: Scenario) -> Scene:
    """Compose and compile the demonstrator of a scenario.

    Raises:
        ModelError: an arm or UAV file that cannot be used.
    """
    spec = arm_spec(scenario)
    joints = [j.name for j in spec.joints]
    _add_motors(spec)
    _attach_uav(spec, scenario)
    _add_sensors(spec, joints)
    _add_surroundings(spec)
    spec.option.timestep = 1.0 / scenario.run.rate_hz
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    # A diverged run must show: by default MuJoCo puts the scene back to its start and goes on.
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    model = compile_spec(spec, "the demonstrator's scene")
    return _scene(model, joints)


def _add_motors(spec: mujoco.MjSpec) -> None:
    for actuator in list(spec.actuators):
        spec.delete(actuator)
    for joint in spec.joints:
        motor = spec.add_actuator(name=f"motor_{joint.name}", target=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_motor()


def _attach_uav(spec: mujoco.MjSpec, scenario: Scenario) -> None:
    uav = read_spec(resolve(scenario.uav.file), "UAV file")
    names = frame_names(uav)
    needed = ["uav", "cm", "pivot", *(f"rotor_{i + 1}" for i in range(ROTORS))]
    missing = [n for n in needed if n not in names]
    if missing:
        raise ModelError(
            f"UAV file {scenario.uav.file!r} lacks {', '.join(missing)}; it needs a body 'uav' and the other sites"
        )
    site = next(s for s in spec.sites if s.name == EE_SITE)
    pivot = next(s for s in uav.sites if s.name == "pivot").pos.copy()
    body = next(b for b in uav.bodies if b.name == "uav")
    h = scenario.hinge
    for axis, name, limited in (
        ([0, 0, 1], "swivel", False),
        ([1, 0, 0], "hinge_x", True),
        ([0, 1, 0], "hinge_y", True),
    ):
        body.add_joint(
            name=name,
            type=mujoco.mjtJoint.mjJNT_HINGE,
            pos=pivot,
            axis=axis,
            limited=limited,
            range=np.deg2rad([-h.range_deg, h.range_deg]) if not uav.compiler.degree else [-h.range_deg, h.range_deg],
            damping=[h.damping_nms, 0, 0],
            frictionloss=h.friction_nm,
        )
    body.pos = -pivot
    site.attach_body(body, UAV, "")


def _add_sensors(spec: mujoco.MjSpec, joints: list[str]) -> None:
    S, O = mujoco.mjtSensor, mujoco.mjtObj
    for name in joints:
        spec.add_sensor(name=f"q_{name}", type=S.mjSENS_JOINTPOS, objtype=O.mjOBJ_JOINT, objname=name)
    for name in joints:
        spec.add_sensor(name=f"qd_{name}", type=S.mjSENS_JOINTVEL, objtype=O.mjOBJ_JOINT, objname=name)
    for name in joints:
        spec.add_sensor(name=f"tau_{name}", type=S.mjSENS_JOINTACTFRC, objtype=O.mjOBJ_JOINT, objname=name)
    pivot, cm = f"{UAV}pivot", f"{UAV}cm"
    for name, kind, site in (
        ("force", S.mjSENS_FORCE, "armland_fts"),
        ("torque", S.mjSENS_TORQUE, "armland_fts"),
        ("quat", S.mjSENS_FRAMEQUAT, cm),
        ("gyro", S.mjSENS_GYRO, cm),
        ("r", S.mjSENS_FRAMEPOS, pivot),
        ("v", S.mjSENS_FRAMELINVEL, pivot),
        ("v_cm", S.mjSENS_FRAMELINVEL, cm),
        ("hinge_force", S.mjSENS_FORCE, pivot),
    ):
        spec.add_sensor(name=name, type=kind, objtype=O.mjOBJ_SITE, objname=site)


def _add_surroundings(spec: mujoco.MjSpec) -> None:
    """What only the eye needs: sky, floor, lights and the camera `overview`, which has arm and UAV in frame."""
    visual = spec.visual
    visual.global_.offwidth, visual.global_.offheight = 1600, 1200
    visual.headlight.ambient = [0.46, 0.46, 0.47]
    visual.headlight.diffuse = [0.22, 0.22, 0.22]
    visual.headlight.specular = [0.1, 0.1, 0.1]
    visual.quality.shadowsize = 4096
    # The floor has no edge: haze takes it into the sky's colour at the horizon.
    visual.map.haze, visual.rgba.haze = 0.35, [0.95, 0.96, 0.98, 1.0]
    T, B = mujoco.mjtTexture, mujoco.mjtBuiltin
    sky = {"type": T.mjTEXTURE_SKYBOX, "builtin": B.mjBUILTIN_GRADIENT, "width": 256, "height": 1536}
    spec.add_texture(name="sky", rgb1=[0.78, 0.85, 0.93], rgb2=[0.95, 0.96, 0.98], **sky)
    tiles = {"type": T.mjTEXTURE_2D, "builtin": B.mjBUILTIN_CHECKER, "width": 512, "height": 512}
    spec.add_texture(name="floor", rgb1=[0.84, 0.85, 0.87], rgb2=[0.80, 0.81, 0.83], **tiles)
    # A square of the checker is a quarter of a metre wide: the floor is a ruler, too.
    material = spec.add_material(name="floor", texrepeat=[4, 4], texuniform=True, specular=0.0)
    material.textures[int(mujoco.mjtTextureRole.mjTEXROLE_RGB)] = "floor"
    world = spec.worldbody
    plane = mujoco.mjtGeom.mjGEOM_PLANE
    world.add_geom(name="floor", type=plane, size=[0, 0, 0.1], material="floor", contype=0, conaffinity=0, group=2)
    sun = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    world.add_light(type=sun, pos=[0.2, -1.4, 2.5], dir=[0.05, 0.7, -1.0], diffuse=[0.48, 0.48, 0.46], castshadow=True)
    world.add_light(type=sun, pos=[1.0, 1.0, 2.0], dir=[-1.0, -0.6, -0.5], diffuse=[0.16, 0.17, 0.2], castshadow=False)
    eye, target = np.array([1.42, -1.62, 1.25]), np.array([0.42, 0.04, 0.44])
    world.add_camera(name="overview", pos=eye, xyaxes=_camera_axes(eye, target), fovy=30)


def _camera_axes(eye: np.ndarray, target: np.ndarray) -> np.ndarray:
    # The camera looks along its -z, with its x axis level.
    z = (eye - target) / np.linalg.norm(eye - target)
    x = np.cross([0.0, 0.0, 1.0], z)
    x /= np.linalg.norm(x)
    return np.concatenate([x, np.cross(z, x)])


def _scene(model: mujoco.MjModel, joints: list[str]) -> Scene:
    ids = [model.joint(name).id for name in joints]
    hinge = [model.joint(f"{UAV}{name}").id for name in ("swivel", "hinge_x", "hinge_y")]
    sensor = {model.sensor(i).name: int(model.sensor_adr[i]) for i in range(model.nsensor)}
    return Scene(
        model=model,
        joints=len(joints),
        joint_qpos=model.jnt_qposadr[ids].copy(),
        joint_dof=model.jnt_dofadr[ids].copy(),
        hinge_qpos=model.jnt_qposadr[hinge].copy(),
        sensor=sensor,
    )
