"""Deviations of what MuJoCo moves: masses, frictions, springs and places, written into the compiled model."""

import mujoco
import numpy as np

from armland.plant.deviation.drawn import Values
from armland.plant.scene.arm import scale_inertia
from armland.plant.scene.composition import Scene
from armland.plant.scene.uav import LEAST_PLAY_M, PLAY
from armland.rotations import Array, from_rotation_vector, multiply
from armland.scenario import Scenario

LEAST_KG = 0.02
"""A tool that weighs nothing is none."""


def deviate_bodies(values: Values, scenario: Scenario, scene: Scene) -> Scene:
    """Write the deviations into the scene's model; returns the scene with the place that its cradle now has."""
    model = scene.model
    _uav(values, model, scene.uav_body)
    if scene.joints:
        _arm(values, scenario, scene)
    _hinge(values, model, scene)
    shift = _cradle(values, model) if "cradle" in scene.parts else np.zeros(3)
    mujoco.mj_setConst(model, mujoco.MjData(model))
    return scene._replace(put_down=scene.put_down + shift)


def value(values: Values, path: str) -> float:
    """The deviation `path` that is one number; 0 where there is none."""
    return float(values[path][0]) if path in values else 0.0


def _uav(values: Values, model: mujoco.MjModel, body: int) -> None:
    model.body_mass[body] *= 1.0 + value(values, "uav.mass")
    model.body_inertia[body] *= 1.0 + value(values, "uav.inertia")
    model.body_ipos[body] += values.get("uav.cm_m", 0.0)


def _arm(values: Values, scenario: Scenario, scene: Scene) -> None:
    model, dof, tool = scene.model, scene.joint_dof, scene.tool_body
    joints = [int(j) for j in model.dof_jntid[dof]]
    scale_inertia(model, 1.0 + value(values, "arm.inertia"), joints)
    model.dof_frictionloss[dof] += values.get("arm.coulomb", 0.0) * torque_limits(scene)
    model.dof_damping[dof] += values.get("arm.viscous_nms", 0.0)
    # The tool's body carries all beyond the sensor.
    more, before = value(values, "wrench.tool_kg"), model.body_mass[tool]
    model.body_mass[tool] = max(before + more, LEAST_KG)
    model.body_ipos[tool, 2] += value(values, "wrench.tool_com_m")


def torque_limits(scene: Scene) -> Array:
    """Largest torque (n,), N·m, of each joint; 0 where the arm's file says none, for no share of it is known."""
    m, joint = scene.model, scene.model.dof_jntid[scene.joint_dof]
    limited = m.jnt_actfrclimited[joint].astype(bool)
    return np.where(limited, np.abs(m.jnt_actfrcrange[joint]).min(axis=1), 0.0)


def _hinge(values: Values, model: mujoco.MjModel, scene: Scene) -> None:
    # The swivel turns the cable's end with it; the two crossed axes bend the cable.
    crossed = scene.hinge_dof[:2] if scene.bond == "free" else scene.hinge_dof[1:]
    model.dof_frictionloss[crossed] += value(values, "hinge.friction_nm")
    model.dof_damping[crossed] += value(values, "hinge.damping_nms")
    joints = model.dof_jntid[crossed]
    model.jnt_stiffness[joints] += value(values, "hinge.stiffness_nm")
    model.qpos_spring[model.jnt_qposadr[joints]] += np.deg2rad(values.get("hinge.askew_deg", 0.0))
    if "hinge.play_m" in values:
        half = 0.5 * max(value(values, "hinge.play_m"), LEAST_PLAY_M)
        model.jnt_range[model.joint(PLAY).id] = [-half, half]


def _cradle(values: Values, model: mujoco.MjModel) -> Array:
    body, shift = model.body("cradle").id, np.zeros(3) + values.get("cradle.place_m", 0.0)
    heading = np.deg2rad(value(values, "cradle.heading_deg"))
    model.body_pos[body] += shift
    model.body_quat[body] = multiply(from_rotation_vector(np.array([0.0, 0.0, heading])), model.body_quat[body])
    rails = [model.geom(f"rail_{i}").id for i in (1, 2)]
    pairs = np.isin(model.pair_geom1, rails) | np.isin(model.pair_geom2, rails)
    model.pair_friction[pairs, :2] *= 1.0 + value(values, "cradle.friction")
    return shift
