"""What gives way at a touchdown: springs and dampers that are the same whatever comes down on them.

| symbol | name | unit |
|---|---|---|
| k, c | `stiffness`, `damping` of one buffer | N/m, N·s/m |
| a, b | half the distance of the buffers along and across the rails | m |
| h | `step` | s |

The cradle's frame rests on four rubber buffers at (±a, ±b), so it sinks, rolls and pitches with

    k_z = 4 k,  k_roll = 4 k b²,  k_pitch = 4 k a²,  and the same with c    (1)

These are joints. MuJoCo's contacts are no springs: their stiffness goes with the mass of what meets, so that an arm of 6 kg
would find the rubber twelve times as hard as a UAV of half a kilogram. Where they are made springs, by an impedance d near zero,
their friction creeps.

Spring and damper of a joint are a constraint on it with that impedance: its force f obeys R f = −(B v + K q) − q̈ with
R = (1 − d)/(d m), B = damping/d and K = stiffness/d, where m is the joint's own inertia. So

    f = −k q − c v − μ q̈,  μ = m d/(1 − d),  with stiffness = (1 − d) k/m and damping = (1 − d) c/m    (2)

A joint's own damping would be integrated implicitly, which contacts do not foresee: they would chatter.
Source of what `solref` does: MuJoCo's documentation, "Solver parameters".
"""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.scenario.gear import Cradle

SINK = "cradle_sink"
"""Joint along which the frame gives way vertically; `cradle_roll` and `cradle_pitch` stand beside it."""

SHARE = 1e-3
"""Share of the frame's inertia that (2) adds to it."""


class Mode(NamedTuple):
    """One way in which the frame gives way."""

    name: str  # of its joint
    kind: mujoco.mjtJoint
    axis: list[int]
    inertia: float  # kg or kg·m²
    stiffness: float  # N/m or N·m/rad
    damping: float  # N·s/m or N·m·s/rad


def modes(c: Cradle, along: float, across: float) -> tuple[Mode, Mode, Mode]:
    """How the frame of a cradle gives way; two thin rails are what has inertia.

    Args:
        c: the cradle.
        along: a, m.
        across: b, m.
    """
    slide, turn, k, d = (
        mujoco.mjtJoint.mjJNT_SLIDE,
        mujoco.mjtJoint.mjJNT_HINGE,
        4.0 * c.stiffness_npm,
        4.0 * c.damping_nspm,
    )
    roll, pitch = c.mass_kg * across**2, c.mass_kg * c.length_m**2 / 12.0
    return (
        Mode(SINK, slide, [0, 0, 1], c.mass_kg, k, d),
        Mode("cradle_roll", turn, [1, 0, 0], roll, k * across**2, d * across**2),  # (1)
        Mode("cradle_pitch", turn, [0, 1, 0], pitch, k * along**2, d * along**2),  # (1)
    )


def rest_on_buffers(
    spec: mujoco.MjSpec, body: mujoco.MjsBody, c: Cradle, ways: tuple[Mode, ...], gravity: float
) -> None:
    """Let the cradle's frame `body`, its origin amid the buffers, give way in `ways`; unloaded it lies where it was put.

    Args:
        spec: of the scene.
        body: the frame; it gets its mass here.
        c: the cradle.
        ways: of `modes`.
        gravity: acceleration along z, m/s².

    Raises:
        ModelError: buffers that are too stiff for the base rate.
    """
    sink, roll, pitch = ways
    body.explicitinertial, body.mass, body.ipos, body.iquat = True, c.mass_kg, np.zeros(3), [1.0, 0.0, 0.0, 0.0]
    body.inertia = [roll.inertia, pitch.inertia, roll.inertia + pitch.inertia]
    _check(c, ways, spec.option.timestep)
    for w in ways:
        body.add_joint(name=w.name, type=w.kind, axis=w.axis)
        rest = -c.mass_kg * gravity / w.stiffness if w is sink else 0.0
        share = (1.0 - SHARE) / w.inertia
        spec.add_equality(
            name=w.name,
            type=mujoco.mjtEq.mjEQ_JOINT,
            objtype=mujoco.mjtObj.mjOBJ_JOINT,
            name1=w.name,
            data=[rest, *np.zeros(11)],
            solref=[-share * w.stiffness, -share * w.damping],  # (2)
            solimp=[SHARE, SHARE, 0.001, 0.5, 2.0],
        )


def _check(c: Cradle, ways: tuple[Mode, ...], step: float) -> None:
    # Explicit steps are stable while k h² + 2 c h < 4 m; half of that is used.
    m, k, d = (np.array([getattr(w, name) for w in ways]) for name in ("inertia", "stiffness", "damping"))
    longest = float(np.min((np.sqrt(d**2 + 2.0 * m * k) - d) / k))
    if step >= longest:
        raise ModelError(
            f"cradle.stiffness_npm = {c.stiffness_npm:g} and cradle.damping_nspm = {c.damping_nspm:g} are too much for "
            f"cradle.mass_kg = {c.mass_kg:g} at run.rate_hz = {1.0 / step:.0f}; it must be above {1.0 / longest:.0f}"
        )
