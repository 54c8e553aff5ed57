"""What the actuators of an MJCF say of the joints that they drive: torque limits, and the speeds of velocity servos.

| actuator | torque of its joint |
|---|---|
| motor, or whatever turns its command into force | the smaller of `forcerange` and `ctrlrange` times its gain, times its gear |
| position, velocity and other servos | `forcerange` times its gear: their `ctrlrange` is no force |

Where several drive one joint, as where a file offers motor, position and velocity beside each other, the motor's counts.
"""

import mujoco
import numpy as np

from armland.models.arm_file.tree import ACTUATOR, Value

OF_JOINTS = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))


def forget_lengths(spec: mujoco.MjSpec) -> None:
    """Take out of `spec` what only a simulated actuator needs and could refuse: ranges of length, of activation."""
    spec.compiler.LRopt.mode = int(mujoco.mjtLRMode.mjLRMODE_NONE)


def limits(model: mujoco.MjModel) -> dict[int, dict[str, Value]]:
    """`torque` and `speed` of each joint, by its number, as far as actuators of a compiled model say them."""
    found: dict[int, list[tuple[bool, float]]] = {}
    speeds: dict[int, float] = {}
    for a in range(model.nu):
        if int(model.actuator_trntype[a]) not in OF_JOINTS:
            continue
        joint, gear = int(model.actuator_trnid[a, 0]), abs(float(model.actuator_gear[a, 0]))
        motor, force = _force(model, a)
        if force is not None and gear > 0.0:
            found.setdefault(joint, []).append((motor, force * gear))
        speed = _speed(model, a)
        if speed is not None and gear > 0.0:
            speeds[joint] = speed / gear
    out: dict[int, dict[str, Value]] = {}
    for joint, forces in found.items():
        of_motors = [f for motor, f in forces if motor]
        out.setdefault(joint, {})["torque"] = Value(min(of_motors or [f for _, f in forces]), ACTUATOR)
    for joint, speed in speeds.items():
        out.setdefault(joint, {})["speed"] = Value(speed, ACTUATOR)
    return out


def least(row: np.ndarray) -> float | None:
    """The smaller end of a range `row` (2,), N·m or rad/s, by its amount; the other where one is 0, as in `0 176`; None for both."""
    ends = np.abs(row)[np.abs(row) > 0.0]
    return float(ends.min()) if ends.size else None


def _force(model: mujoco.MjModel, a: int) -> tuple[bool, float | None]:
    motor = bool(
        model.actuator_gaintype[a] == int(mujoco.mjtGain.mjGAIN_FIXED)
        and model.actuator_biastype[a] == int(mujoco.mjtBias.mjBIAS_NONE)
    )
    force = least(model.actuator_forcerange[a]) if model.actuator_forcelimited[a] else None
    if motor and model.actuator_ctrllimited[a]:
        gain = abs(float(model.actuator_gainprm[a, 0]))
        asked = least(gain * model.actuator_ctrlrange[a])
        force = min(x for x in (force, asked) if x is not None) if asked is not None else force
    return motor, force


def _speed(model: mujoco.MjModel, a: int) -> float | None:
    # A velocity servo: force k (u - v).
    affine = model.actuator_biastype[a] == int(mujoco.mjtBias.mjBIAS_AFFINE)
    bias = model.actuator_biasprm[a]
    if not (affine and bias[1] == 0.0 and bias[2] < 0.0 and model.actuator_ctrllimited[a]):
        return None
    return least(model.actuator_ctrlrange[a])
