"""The messages that flow through the loop: NumPy structured dtypes, fixed size, one table.

Every message is held in a structured array of shape (1,): compiled code takes such an array for 0.1 µs, where a
structured scalar costs 1 µs. The fields of a message lie so that its bytes are also its CDR payload (8-byte fields only),
which is how the run log stores it. `n` is the number of the arm's joints.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.compiled import name_records_by_layout

name_records_by_layout()

Record = Any
"""A structured record inside compiled code, its fields read and written as attributes."""


class Field(NamedTuple):
    """One field of a message: its shape (`"n"` stands for the number of joints), unit, frame and meaning."""

    name: str
    shape: tuple[int | str, ...]
    unit: str
    frame: str
    meaning: str
    type: str = "f8"


_TICK = Field("tick", (), "ms", "-", "time of the message in ticks of the base rate", "i8")

MESSAGES: dict[str, tuple[Field, ...]] = {
    "measurement": (
        _TICK,
        Field("uav_tick", (), "ms", "-", "tick at which the UAV took the sample that arrived last", "i8"),
        Field("q", ("n",), "rad", "joint", "joint positions"),
        Field("qd", ("n",), "rad/s", "joint", "joint velocities"),
        Field("wrench", (6,), "N, N·m", "sensor", "force, torque of the flange on the tool at the sensor's origin"),
        Field("uav_quat", (4,), "1", "world<-body", "UAV attitude, scalar first"),
        Field("uav_rate", (3,), "rad/s", "body", "UAV angular velocity"),
    ),
    "estimate": (
        _TICK,
        Field("r", (3,), "m", "world", "pivot (hinge) position"),
        Field("v", (3,), "m/s", "world", "pivot velocity"),
        Field("quat", (4,), "1", "world<-body", "UAV attitude, scalar first"),
        Field("omega", (3,), "rad/s", "body", "UAV angular velocity"),
        Field("hinge_force", (3,), "N", "world", "force of the end effector on the UAV, from the force-torque sensor"),
        Field("disturbance", (3,), "N", "world", "force that the observer holds responsible for what the model misses"),
        Field("tau_att", (3,), "N·m", "body", "torque of the onboard attitude controller, as the ground predicts it"),
    ),
    "reference": (
        _TICK,
        Field("r", (3,), "m", "world", "desired pivot position r_d"),
        Field("v", (3,), "m/s", "world", "desired pivot velocity"),
        Field("a", (3,), "m/s²", "world", "desired pivot acceleration"),
        Field("quat", (4,), "1", "world<-body", "desired UAV attitude q_d"),
    ),
    "command": (
        _TICK,
        Field("tau", ("n",), "N·m", "joint", "joint torques"),
        Field("delta_tau", (3,), "N·m", "body", "torque Δτ_att asked of the UAV beyond its attitude controller"),
        Field("thrust", (), "N", "body", "total thrust f_T asked of the UAV"),
        Field("force", (3,), "N", "world", "force F_EE that the law wants the end effector to put on the UAV"),
        Field("torque", (3,), "N·m", "world", "orientation torque of the end effector"),
    ),
    "health": (
        _TICK,
        Field("flags", (), "bits", "-", "see `Flag`", "i8"),
        Field("sigma_min", (), "1", "-", "smallest singular value of the end effector's Jacobian"),
        Field("joint_margin", (), "rad", "joint", "smallest distance of a joint to its range's end"),
        Field("torque_ratio", (), "1", "joint", "largest joint torque over its limit"),
        Field("uav_age", (), "s", "-", "age of the UAV sample in use"),
    ),
    "proof": (
        _TICK,
        Field(
            "v2",
            (),
            "J",
            "-",
            "Lyapunov function V₂ (26) of the law in use, as its estimate had it at `tick`; every fifth tick",
        ),
        Field("v2_rate", (), "W", "-", "rate of V₂ that the proof promises (30)"),
    ),
    "truth": (
        _TICK,
        Field("r", (3,), "m", "world", "pivot position"),
        Field("v", (3,), "m/s", "world", "pivot velocity"),
        Field("v_cm", (3,), "m/s", "world", "velocity of the UAV's centre of mass"),
        Field("quat", (4,), "1", "world<-body", "UAV attitude, scalar first"),
        Field("omega", (3,), "rad/s", "body", "UAV angular velocity"),
        Field("hinge_force", (3,), "N", "world", "force of the end effector on the UAV at the pivot"),
        Field("rotor_thrust", (4,), "N", "body", "thrust of each rotor"),
        Field("tau_uav", (3,), "N·m", "body", "torque of the rotors on the UAV"),
        Field("tau", ("n",), "N·m", "joint", "joint torques that really acted"),
    ),
}
"""The messages by name. `truth` exists in the simulator only: the judge reads it, the controller never does."""


class Flag:
    """Bits of `health.flags`."""

    NON_FINITE = 1
    """A measurement was not a finite number and was replaced by the last good one."""
    TORQUE_LIMITED = 2
    """A joint torque reached its limit."""
    NEAR_SINGULAR = 4
    """The Jacobian's smallest singular value is below the damping threshold."""
    UAV_STALE = 8
    """The UAV sample in use is older than the link's watchdog."""


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
def tick_layout(joints: int) -> np.dtype:
    """The dtype of all messages of one tick, nested by name."""
    return np.dtype([(name, layout(name, joints)) for name in MESSAGES])


class Tick:
    """All messages of the tick in progress: views, shape (1,) each, of one buffer that the recorder copies whole."""

    def __init__(self, joints: int) -> None:
        self.buffer: NDArray[np.void] = np.zeros(1, tick_layout(joints))
        self.measurement = self.buffer["measurement"]
        self.estimate = self.buffer["estimate"]
        self.reference = self.buffer["reference"]
        self.command = self.buffer["command"]
        self.health = self.buffer["health"]
        self.proof = self.buffer["proof"]
        self.truth = self.buffer["truth"]
