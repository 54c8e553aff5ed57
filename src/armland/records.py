"""The messages that flow through the loop: NumPy structured dtypes, fixed size, one table for each kind of run.

Every message is held in a structured array of shape (1,): compiled code takes such an array for 0.1 µs, where a
structured scalar costs 1 µs. The fields of a message lie so that its bytes are also its CDR payload (8-byte fields only),
which is how the run log stores it. `n` is the number of the arm's joints. The table here is that of the paper's loop; other
kinds of runs have their own, made of the same parts.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar, NamedTuple

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


@dataclass(frozen=True, eq=False)
class MessageTable:
    """The messages of one kind of run, and the layouts that follow from them.

    Each message begins with its `tick`; `measurement` has the joint positions `q`.
    """

    kind: str
    """What a run log calls it."""
    messages: Mapping[str, tuple[Field, ...]]
    """The fields of each message."""
    prefix: str = ""
    """What the ROS types of its messages begin with: a type's name has one definition."""

    def layout(self, message: str, joints: int) -> np.dtype:
        """The dtype of one message for an arm with `joints` joints.

        Raises:
            KeyError: unknown message; the known ones are the keys of `messages`.
        """
        return _layout(self, message, joints)

    def tick_layout(self, joints: int) -> np.dtype:
        """The dtype of all messages of one tick, nested by name."""
        return _tick_layout(self, joints)


# Kept, so that equal layouts are one object, which compiled code recognises fastest.
@lru_cache
def _layout(table: MessageTable, message: str, joints: int) -> np.dtype:
    spec = []
    for f in table.messages[message]:
        shape = tuple(joints if s == "n" else int(s) for s in f.shape)
        spec.append((f.name, f.type, shape) if shape else (f.name, f.type))
    return np.dtype(spec)


@lru_cache
def _tick_layout(table: MessageTable, joints: int) -> np.dtype:
    return np.dtype([(name, _layout(table, name, joints)) for name in table.messages])


class AnyTick:
    """All messages of the tick in progress: views, shape (1,) each, of one buffer that the recorder copies whole."""

    table: ClassVar[MessageTable]
    measurement: NDArray[np.void]

    def __init__(self, joints: int) -> None:
        self.buffer: NDArray[np.void] = np.zeros(1, self.table.tick_layout(joints))
        for name in self.table.messages:
            setattr(self, name, self.buffer[name])


TICK = Field("tick", (), "ms", "-", "time of the message in ticks of the base rate", "i8")

MESSAGES: dict[str, tuple[Field, ...]] = {
    "measurement": (
        TICK,
        Field("uav_tick", (), "ms", "-", "tick at which the UAV took the sample that arrived last", "i8"),
        Field("q", ("n",), "rad", "joint", "joint positions"),
        Field("qd", ("n",), "rad/s", "joint", "joint velocities"),
        Field("wrench", (6,), "N, N·m", "sensor", "force, torque of the flange on the tool at the sensor's origin"),
        Field("uav_quat", (4,), "1", "world<-body", "UAV attitude, scalar first"),
        Field("uav_rate", (3,), "rad/s", "body", "UAV angular velocity"),
    ),
    "estimate": (
        TICK,
        Field("r", (3,), "m", "world", "pivot (hinge) position"),
        Field("v", (3,), "m/s", "world", "pivot velocity"),
        Field("quat", (4,), "1", "world<-body", "UAV attitude, scalar first"),
        Field("omega", (3,), "rad/s", "body", "UAV angular velocity"),
        Field("hinge_force", (3,), "N", "world", "force of the end effector on the UAV, from the force-torque sensor"),
        Field("disturbance", (3,), "N", "world", "force that the observer holds responsible for what the model misses"),
        Field("tau_att", (3,), "N·m", "body", "torque of the onboard attitude controller, as the ground predicts it"),
    ),
    "reference": (
        TICK,
        Field("r", (3,), "m", "world", "desired pivot position r_d"),
        Field("v", (3,), "m/s", "world", "desired pivot velocity"),
        Field("a", (3,), "m/s²", "world", "desired pivot acceleration"),
        Field("quat", (4,), "1", "world<-body", "desired UAV attitude q_d"),
    ),
    "command": (
        TICK,
        Field("tau", ("n",), "N·m", "joint", "joint torques"),
        Field("delta_tau", (3,), "N·m", "body", "torque Δτ_att asked of the UAV beyond its attitude controller"),
        Field("thrust", (), "N", "body", "total thrust f_T asked of the UAV"),
        Field("force", (3,), "N", "world", "force F_EE that the law wants the end effector to put on the UAV"),
        Field("torque", (3,), "N·m", "world", "orientation torque of the end effector"),
    ),
    "health": (
        TICK,
        Field("flags", (), "bits", "-", "see `Flag`", "i8"),
        Field("sigma_min", (), "1", "-", "smallest singular value of the end effector's Jacobian"),
        Field("joint_margin", (), "rad", "joint", "smallest distance of a joint to its range's end"),
        Field("torque_ratio", (), "1", "joint", "largest joint torque over its limit"),
        Field("uav_age", (), "s", "-", "age of the UAV sample in use"),
    ),
    "proof": (
        TICK,
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
        TICK,
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


PAPER_TABLE = MessageTable("paper", MESSAGES)
layout, tick_layout = PAPER_TABLE.layout, PAPER_TABLE.tick_layout


class Tick(AnyTick):
    """The messages of a tick of the paper's loop."""

    table = PAPER_TABLE
    estimate: NDArray[np.void]
    reference: NDArray[np.void]
    command: NDArray[np.void]
    health: NDArray[np.void]
    proof: NDArray[np.void]
    truth: NDArray[np.void]
