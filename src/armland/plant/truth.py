"""The truth of a tick, read from MuJoCo's sensors: for the judge, and for the devices that sample it."""

import numpy as np
from numba import njit

from armland.plant.scene.composition import Scene
from armland.records import Record, Records
from armland.rotations import Array, matrix

SENSORS = ("r", "v", "r_cm", "v_cm", "quat", "gyro", "ee_pos", "ee_vel", "ee_quat", "hinge_force")
FOUL = ("arm_cradle_force", "arm_floor_force", "arm_uav_force", "plate_cradle_force", "ground_force")
CONTACTS = ("cradle_force", *FOUL)
DECK = ("deck_pos", "deck_quat", "deck_vel", "deck_rate", "deck_acc", "deck_alpha")
"""Where a scene has no such contact, the force is zero; where it has no deck, the deck is at rest in W."""


def told_layout(joints: int) -> np.dtype:
    """Addresses in sensordata, and how the hinge's sensor speaks."""
    names = ("q", "tau", *SENSORS, *CONTACTS, *DECK, "plate_quat", "hinge_quat")
    return np.dtype([*((name, "i8") for name in names), ("hinge_sign", "f8"), ("gravity", "f8", (3,))])


def tell(told: Records, scene: Scene) -> None:
    """Fill `told` (1,)."""
    if scene.joints:
        first = scene.model.joint(int(scene.model.dof_jntid[scene.joint_dof[0]])).name
        told["q"], told["tau"] = scene.sensor[f"q_{first}"], scene.sensor[f"tau_{first}"]
    for name in SENSORS:
        told[name] = scene.sensor[name]
    told["gravity"] = scene.model.opt.gravity
    for name in (*CONTACTS, *DECK):
        told[name] = scene.sensor.get(name, -1)
    free = scene.bond == "free"
    # A hinge's lower half that is fixed to the arm turns with the end effector.
    told["plate_quat"] = scene.sensor["plate_quat" if free else "ee_quat"]
    # On a free UAV the sensor measures the force on the plate in plate axes, on a hinged one that on the UAV in its own.
    told["hinge_quat"] = scene.sensor["plate_quat" if free else "quat"]
    told["hinge_sign"] = -1.0 if free else 1.0


@njit(cache=True)
def record(k: int, data: Array, told: Record, rotors: Record, mixer: Array, t: Record) -> None:
    """Fill the truth `t` of tick `k`, but for `touching`.

    Args:
        k: present tick.
        data: MuJoCo's `sensordata` (nsensordata,), in the units of each sensor: m, rad, N, 1 for quaternions.
        told: of `told_layout`.
        rotors: what the rotors keep, of `rotors.kept_layout`.
        mixer: (4, 8), 1 and m, thrust and torques per rotor's thrust, `models.airframe.rotor_set.effect_of`.
        t: written.
    """
    t.tick = k
    _take(data, told.q, t.q)
    _take(data, told.tau, t.tau)
    _take(data, told.r, t.r)
    _take(data, told.v, t.v)
    _take(data, told.r_cm, t.r_cm)
    _take(data, told.v_cm, t.v_cm)
    _take(data, told.gyro, t.omega)
    _take(data, told.ee_pos, t.ee)
    _take(data, told.ee_vel, t.ee_v)
    _take(data, told.quat, t.quat)
    _take(data, told.plate_quat, t.plate_quat)
    _take(data, told.ee_quat, t.ee_quat)
    _look_at_deck(data, told, t)
    t.rotor_thrust = rotors.lift
    _forces(data, told, t)
    for i in range(3):
        torque = 0.0
        for j in range(mixer.shape[1]):
            torque += mixer[i + 1, j] * t.rotor_thrust[j]
        t.tau_uav[i] = torque


@njit(cache=True)
def _take(data: Array, at: int, out: Array) -> None:
    for i in range(out.shape[0]):
        out[i] = data[at + i]


@njit(cache=True)
def _look_at_deck(data: Array, told: Record, t: Record) -> None:
    t.deck_quat[0] = 1.0
    if told.deck_pos < 0:
        return
    _take(data, told.deck_pos, t.deck)
    _take(data, told.deck_quat, t.deck_quat)
    _take(data, told.deck_vel, t.deck_v)
    _take(data, told.deck_rate, t.deck_omega)
    _take(data, told.deck_acc, t.deck_a)
    _take(data, told.deck_alpha, t.deck_alpha)
    for i in range(3):
        t.deck_a[i] += told.gravity[i]


@njit(cache=True)
def _forces(data: Array, told: Record, t: Record) -> None:
    quat = np.empty(4)
    _take(data, told.hinge_quat, quat)
    R = matrix(quat)
    for i in range(3):
        t.hinge_force[i] = 0.0
        for j in range(3):
            t.hinge_force[i] += told.hinge_sign * R[i, j] * data[told.hinge_force + j]
    if told.cradle_force >= 0:
        _take(data, told.cradle_force, t.cradle_force)
    t.foul[0] = _length(data, told.arm_cradle_force)
    t.foul[1] = _length(data, told.arm_floor_force)
    t.foul[2] = _length(data, told.arm_uav_force)
    t.foul[3] = _length(data, told.plate_cradle_force)
    t.foul[4] = _length(data, told.ground_force)


@njit(cache=True)
def _length(data: Array, at: int) -> float:
    if at < 0:
        return 0.0
    return float(np.sqrt(data[at] ** 2 + data[at + 1] ** 2 + data[at + 2] ** 2))
