"""The messages that flow through the loop: one table, NumPy structured dtypes of fixed size.

Every message is held in a structured array of shape (1,): compiled code takes such an array for 0.1 µs, where a
structured scalar costs 1 µs. The fields of a message lie so that its bytes are also its CDR payload (8-byte fields only),
which is how the run log stores it. `n` is the number of the arm's joints. Frames: `W` inertial, z up; `D` deck, in which the arm's
base, the cradle and the camera's mount are at rest, on land the same as W; `B` UAV body; `E` end effector.

| device | its clock |
|---|---|
| arm, force-torque sensor, UAV link | the tick of the newest sample stands beside it: a watchdog compares it with the present |
| camera | `camera_capture` is the tick of the exposure; `camera_fresh` is 1 in the tick of arrival |
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.compiled import set_up

set_up()

MOST_ROTORS = 8
"""Rotors that a UAV may have: messages and records hold as many, zero for those that there are not."""

Record = Any
"""A structured record inside compiled code, its fields read and written as attributes."""

Records = NDArray[np.void]
"""Structured records, shape (1,) where nothing else is said."""


class Field(NamedTuple):
    """One field of a message: its shape (`"n"` stands for the number of joints), unit, frame and meaning."""

    name: str
    shape: tuple[int | str, ...]
    unit: str
    frame: str
    meaning: str
    type: str = "f8"


TICK = Field("tick", (), "ticks", "-", "time of the message in ticks of the base rate", "i8")

MESSAGES: dict[str, tuple[Field, ...]] = {
    "measurement": (
        TICK,
        Field("arm_tick", (), "ticks", "-", "tick at which the joints were sampled", "i8"),
        Field("wrench_tick", (), "ticks", "-", "tick at which the force-torque sensor was sampled", "i8"),
        Field("uav_tick", (), "ticks", "-", "tick at which the UAV took the sample that arrived last", "i8"),
        Field("uav_heard", (), "ticks", "-", "tick at which the newest command had reached it by then", "i8"),
        Field("uav_echo", (), "ticks", "-", "tick at which that command was sent, as the UAV sends it back", "i8"),
        Field("camera_fresh", (), "1", "-", "1 where a camera sample arrived in this tick", "i8"),
        Field("camera_capture", (), "ticks", "-", "tick of that sample's exposure", "i8"),
        Field("magnet_fault", (), "1", "-", "1 where the coil's current did not rise as it should", "i8"),
        Field("wrench", (6,), "N, N·m", "sensor", "force, torque of the flange on the tool at the sensor's origin"),
        Field(
            "uav_quat",
            (4,),
            "1",
            "UAV's W<-B",
            "attitude as the UAV knows it, scalar first; on a moving deck turned into D",
        ),
        Field("uav_rate", (3,), "rad/s", "B", "UAV angular velocity; on a moving deck against it"),
        Field("uav_force", (3,), "m/s²", "B", "its specific force, mean over its sample; zeros where it sends none"),
        Field("uav_rotors", (MOST_ROTORS,), "N", "B", "thrust that the UAV says it asks of each rotor"),
        Field("uav_weak", (), "1", "-", "1 where the UAV says that a rotor gives less than its due", "i8"),
        Field("camera_position", (3,), "m", "camera", "marker's centre"),
        Field("camera_quat", (4,), "1", "camera<-marker", "marker's attitude, scalar first"),
        Field("camera_sigma", (6,), "m, rad", "camera", "claimed standard deviations"),
        Field("magnet_force", (), "N", "-", "force in contact that the coil's current promises"),
        Field("deck_known", (), "1", "-", "1 where there is a motion reference on the deck, which speaks", "i8"),
        Field("deck_tick", (), "ticks", "-", "tick of its newest sample", "i8"),
        Field("deck_quat", (4,), "1", "W<-D", "the deck's attitude, scalar first"),
        Field("deck_rate", (3,), "rad/s", "D", "its angular velocity"),
        Field("deck_v", (3,), "m/s", "D", "velocity of its origin"),
        Field("deck_a", (3,), "m/s²", "D", "acceleration of its origin, gravity taken off"),
        Field("q", ("n",), "rad", "joint", "joint positions"),
        Field("qd", ("n",), "rad/s", "joint", "joint velocities"),
    ),
    "estimate": (
        TICK,
        Field("r", (3,), "m", "D", "end effector point: the pivot of a plate that is held"),
        Field("v", (3,), "m/s", "D", "its velocity"),
        Field("plate", (3,), "m", "D", "pivot of the hinge on the UAV, from camera and link"),
        Field("plate_v", (3,), "m/s", "D", "its velocity"),
        Field("plate_a", (3,), "m/s²", "D", "acceleration of the UAV's centre of mass"),
        Field("plate_valid", (), "1", "-", "1 where the pose filter vouches for the three", "i8"),
        Field("plate_age", (), "s", "-", "age of the newest camera sample in use"),
        Field("quat", (4,), "1", "D<-B", "UAV attitude, scalar first"),
        Field("omega", (3,), "rad/s", "B", "UAV angular velocity"),
        Field("hinge_force", (3,), "N", "D", "force of the end effector on plate and UAV, bias and tool removed"),
        Field("disturbance", (3,), "N", "D", "force that the observer holds responsible for what the model misses"),
        Field("thrust", (), "N", "B", "thrust that acts as far as the ground knows"),
        Field("tau_att", (3,), "N·m", "B", "torque of the onboard attitude controller, as the ground predicts it"),
        Field("arm_share", (), "1", "-", "share of the weight on the arm"),
        Field("ground_share", (), "1", "-", "share of the weight on cradle or ground"),
        Field("camera_noise", (), "1", "-", "standard deviation of the camera over the one that it claims, as learnt"),
        Field("uplink", (), "s", "-", "delay of commands to the UAV, as its echoes say"),
        Field("downlink", (), "s", "-", "delay of its samples, as their stamps say"),
        Field("weight", (), "N", "-", "weight of all that flies, as the force-torque sensor finds it"),
        Field("hover", (), "N", "-", "thrust command that carries the weight, as learnt"),
    ),
    "mission": (
        TICK,
        Field("phase", (), "1", "-", "index into the mission's phases", "i8"),
        Field("retries", (), "1", "-", "missed captures so far", "i8"),
        Field("fault", (), "1", "-", "index into the faults; 0 is none", "i8"),
        Field("elapsed", (), "s", "-", "time in the phase"),
        Field("unmet", (), "1", "-", "bit i: the phase before ran out of time waiting for signal i of `SIGNALS`", "i8"),
        Field("progress", (), "1", "-", "how far the phase's move is, 0 to 1"),
    ),
    "reference": (
        TICK,
        Field("r", (3,), "m", "D", "desired position of the end effector point, r_d while the UAV is held"),
        Field("v", (3,), "m/s", "D", "its velocity"),
        Field("a", (3,), "m/s²", "D", "its acceleration"),
        Field("quat", (4,), "1", "D<-B", "desired UAV attitude q_d"),
    ),
    "command": (
        TICK,
        Field("uav_mode", (), "1", "-", "see `UavMode`", "i8"),
        Field("magnet", (), "1", "-", "0 off, 1 on, 2 self-test", "i8"),
        Field("brake", (), "1", "-", "1 where the arm's brakes shall be on", "i8"),
        Field("uav_quat", (4,), "1", "UAV's W<-B", "attitude set-point, scalar first"),
        Field("delta_tau", (3,), "N·m", "B", "torque Δτ_att asked of the UAV beyond its attitude controller"),
        Field("thrust", (), "N", "B", "total thrust f_T asked of the UAV"),
        Field("uav_step", (3,), "m", "UAV's W", "from where it began to hover by itself to where it shall hover"),
        Field("force", (3,), "N", "D", "force F_EE that the law wants the end effector to put on the UAV"),
        Field("torque", (3,), "N·m", "D", "orientation torque of the end effector"),
        Field("tau", ("n",), "N·m", "joint", "joint torques"),
    ),
    "health": (
        TICK,
        Field("flags", (), "bits", "-", "see `Limit`: what had to be cut or is out of its range", "i8"),
        Field("sigma_min", (), "1", "-", "smallest singular value of the end effector's Jacobian"),
        Field("joint_margin", (), "rad", "joint", "smallest distance of a joint to its range's end"),
        Field("speed_ratio", (), "1", "joint", "largest joint speed over its limit"),
        Field("torque_ratio", (), "1", "joint", "largest joint torque over its limit, before limiting"),
        Field("uav_age", (), "s", "-", "age of the UAV sample in use"),
    ),
    "proof": (
        TICK,
        Field(
            "v2",
            (),
            "J",
            "-",
            "Lyapunov function V₂ (26) of the law in use, as its estimate had it at `tick`; NaN: none",
        ),
        Field("v2_rate", (), "W", "-", "rate of V₂ that the proof promises (30)"),
    ),
    "truth": (
        TICK,
        Field("r", (3,), "m", "W", "pivot on the UAV"),
        Field("v", (3,), "m/s", "W", "its velocity"),
        Field("r_cm", (3,), "m", "W", "UAV's centre of mass"),
        Field("v_cm", (3,), "m/s", "W", "its velocity"),
        Field("quat", (4,), "1", "W<-B", "UAV attitude, scalar first"),
        Field("omega", (3,), "rad/s", "B", "UAV angular velocity"),
        Field("plate_quat", (4,), "1", "W<-plate", "attitude of the hinge plate"),
        Field("ee", (3,), "m", "W", "end effector point"),
        Field("ee_v", (3,), "m/s", "W", "its velocity"),
        Field("ee_quat", (4,), "1", "W<-E", "its attitude"),
        Field("hinge_force", (3,), "N", "W", "force on the UAV at the hinge"),
        Field("cradle_force", (3,), "N", "W", "force of the rails on the UAV"),
        Field(
            "foul",
            (5,),
            "N",
            "-",
            "contact force of the arm on cradle, floor, UAV; of the plate on the cradle; of the UAV on the floor: none may be",
        ),
        Field("touching", (), "1", "-", "pads of the magnet in contact with the plate", "i8"),
        Field("rotor_thrust", (MOST_ROTORS,), "N", "B", "thrust of each rotor"),
        Field("tau_uav", (3,), "N·m", "B", "torque of the rotors on the UAV"),
        Field("q", ("n",), "rad", "joint", "true joint positions"),
        Field("tau", ("n",), "N·m", "joint", "joint torques that really acted"),
        Field("deck", (3,), "m", "W", "the deck's origin; at rest in the world's on land"),
        Field("deck_v", (3,), "m/s", "W", "its velocity"),
        Field("deck_a", (3,), "m/s²", "W", "its acceleration"),
        Field("deck_quat", (4,), "1", "W<-deck", "the deck's attitude, scalar first"),
        Field("deck_omega", (3,), "rad/s", "W", "its angular velocity"),
        Field("deck_alpha", (3,), "rad/s²", "W", "its angular acceleration"),
    ),
}
"""The messages by name. `truth` exists in the simulator only: the judge reads it, the controller never does."""


# Kept, so that equal layouts are one object, which compiled code recognises fastest.
@lru_cache
def layout(message: str, joints: int) -> np.dtype:
    """The dtype of one message for an arm with `joints` joints.

    Raises:
        KeyError: unknown message; the known ones are the keys of `MESSAGES`.
    """
    spec = []
    for f in MESSAGES[message]:
        shape = tuple(joints if s == "n" else int(s) for s in f.shape)
        spec.append((f.name, f.type, shape) if shape else (f.name, f.type))
    return np.dtype(spec)


@lru_cache
def head_layout(message: str) -> np.dtype:
    """The dtype of the fields of one message that are the same for every arm: they come first, those per joint last.

    Raises:
        KeyError: unknown message.
    """
    one, other = layout(message, 1), layout(message, 2)
    same = [name for name in one.names or () if one[name] == other[name]]
    return np.dtype([(name, one[name]) for name in same])


@lru_cache
def tick_layout(joints: int) -> np.dtype:
    """The dtype of all messages of one tick, nested by name."""
    return np.dtype([(name, layout(name, joints)) for name in MESSAGES])


class Tick:
    """All messages of the tick in progress: views, shape (1,) each, of one buffer that the recorder copies whole.

    Args:
        joints: of the arm.
        buffer: of `tick_layout` (1,), e.g. a field of a larger record; a new one if absent.
    """

    measurement: Records
    estimate: Records
    mission: Records
    reference: Records
    command: Records
    health: Records
    proof: Records
    truth: Records

    def __init__(self, joints: int, buffer: Records | None = None) -> None:
        self.buffer: Records = np.zeros(1, tick_layout(joints)) if buffer is None else buffer
        for name in MESSAGES:
            setattr(self, name, self.buffer[name])


class UavMode:
    """What the UAV makes of thrust and attitude set-point."""

    AUTONOMOUS = 0
    """Hovers by its own means, `uav_step` from where it was when it began; the set-points are ignored."""
    GUIDED = 1
    """Flies by the set-points; if the link is lost it hovers by its own means."""
    HELD = 2
    """Follows the set-points; if the link is lost it stays level with the thrust it has: the arm carries the rest."""
    LANDED = 3
    """Follows the set-points; if the link is lost it lets the rotors run down: the cradle carries it."""
    OFF = 4
    """Rotors stopped."""
    CAUGHT = 5
    """As `GUIDED`; on the magnet already, so it stops its rotors if one of them fails, as in `HELD`."""
    HINGED = 6
    """Bound to the arm for good: what arrived last counts, however old; no rotor is watched."""


class Limit:
    """Bits of `health.flags`: what was cut or is out of its range."""

    NON_FINITE = 1
    JOINT_POSITION = 2
    JOINT_SPEED = 4
    JOINT_TORQUE = 8
    TORQUE_RATE = 16
    SINGULAR = 32
    HINGE_FORCE = 64
    UAV_STALE = 128


LIMIT_NAMES = {bit: name.lower() for name, bit in vars(Limit).items() if name.isupper()}
LIMIT_NAMES[Limit.SINGULAR] = "singularity"
"""What a flag is called in words."""
