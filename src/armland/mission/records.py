"""The messages of a landing: the same kind of table as `armland.records`, with camera, magnet and mission.

| device | its clock |
|---|---|
| arm, force-torque sensor, UAV link | the tick of the newest sample stands beside it: a watchdog compares it with the present |
| camera | `camera_capture` is the tick of the exposure; `camera_fresh` is 1 in the tick of arrival |
"""

import numpy as np
from numpy.typing import NDArray

from armland.records import TICK, AnyTick, Field, MessageTable

LANDING_MESSAGES: dict[str, tuple[Field, ...]] = {
    "measurement": (
        TICK,
        Field("arm_tick", (), "ms", "-", "tick at which the joints were sampled", "i8"),
        Field("wrench_tick", (), "ms", "-", "tick at which the force-torque sensor was sampled", "i8"),
        Field("uav_tick", (), "ms", "-", "tick at which the UAV took the sample that arrived last", "i8"),
        Field("uav_heard", (), "ms", "-", "tick at which the newest command had reached it by then", "i8"),
        Field("camera_fresh", (), "1", "-", "1 where a camera sample arrived in this tick", "i8"),
        Field("camera_capture", (), "ms", "-", "tick of that sample's exposure", "i8"),
        Field("magnet_fault", (), "1", "-", "1 where the coil's current did not rise as it should", "i8"),
        Field("q", ("n",), "rad", "joint", "joint positions"),
        Field("qd", ("n",), "rad/s", "joint", "joint velocities"),
        Field("wrench", (6,), "N, N·m", "sensor", "force, torque of the flange on the tool at the sensor's origin"),
        Field("uav_quat", (4,), "1", "uav's world<-body", "attitude as the UAV knows it, scalar first"),
        Field("uav_rate", (3,), "rad/s", "body", "UAV angular velocity"),
        Field("camera_position", (3,), "m", "camera", "marker's centre"),
        Field("camera_quat", (4,), "1", "camera<-marker", "marker's attitude, scalar first"),
        Field("camera_sigma", (6,), "m, rad", "camera", "claimed standard deviations"),
        Field("magnet_force", (), "N", "-", "force in contact that the coil's current promises"),
    ),
    "estimate": (
        TICK,
        Field("r", (3,), "m", "world", "end effector point: the pivot of a plate that is gripped flush"),
        Field("v", (3,), "m/s", "world", "its velocity"),
        Field("plate", (3,), "m", "world", "pivot of the hinge on the UAV, from camera and link"),
        Field("plate_v", (3,), "m/s", "world", "its velocity"),
        Field("plate_a", (3,), "m/s²", "world", "acceleration of the UAV's centre of mass"),
        Field("plate_valid", (), "1", "-", "1 where the pose filter vouches for the three", "i8"),
        Field("plate_age", (), "s", "-", "age of the newest camera sample in use"),
        Field("quat", (4,), "1", "world<-body", "UAV attitude, scalar first"),
        Field("omega", (3,), "rad/s", "body", "UAV angular velocity"),
        Field("hinge_force", (3,), "N", "world", "force of the end effector on plate and UAV, bias and tool removed"),
        Field("disturbance", (3,), "N", "world", "force that the observer holds responsible for what the model misses"),
        Field("thrust", (), "N", "body", "thrust that acts as far as the ground knows"),
        Field("arm_share", (), "1", "-", "share of the weight on the arm"),
        Field("ground_share", (), "1", "-", "share of the weight on cradle or ground"),
    ),
    "mission": (
        TICK,
        Field("phase", (), "1", "-", "index into the mission's phases", "i8"),
        Field("retries", (), "1", "-", "missed captures so far", "i8"),
        Field("fault", (), "1", "-", "index into the faults; 0 is none", "i8"),
        Field("elapsed", (), "s", "-", "time in the phase"),
        Field("progress", (), "1", "-", "how far the phase's move is, 0 to 1"),
    ),
    "reference": (
        TICK,
        Field("r", (3,), "m", "world", "desired position of the end effector point"),
        Field("v", (3,), "m/s", "world", "its velocity"),
        Field("a", (3,), "m/s²", "world", "its acceleration"),
        Field("quat", (4,), "1", "world<-body", "desired UAV attitude"),
    ),
    "command": (
        TICK,
        Field("uav_mode", (), "1", "-", "see `UavMode`", "i8"),
        Field("magnet", (), "1", "-", "0 off, 1 on, 2 self-test", "i8"),
        Field("brake", (), "1", "-", "1 where the arm's brakes shall be on", "i8"),
        Field("tau", ("n",), "N·m", "joint", "joint torques"),
        Field("uav_quat", (4,), "1", "uav's world<-body", "attitude set-point, scalar first"),
        Field("thrust", (), "N", "body", "total thrust asked of the UAV"),
        Field("force", (3,), "N", "world", "force that the law wants the end effector to put on the UAV"),
    ),
    "health": (
        TICK,
        Field("flags", (), "bits", "-", "see `Limit`: what the supervisor had to cut", "i8"),
        Field("sigma_min", (), "1", "-", "smallest singular value of the end effector's Jacobian"),
        Field("joint_margin", (), "rad", "joint", "smallest distance of a joint to its range's end"),
        Field("speed_ratio", (), "1", "joint", "largest joint speed over its limit"),
        Field("torque_ratio", (), "1", "joint", "largest joint torque over its limit, before limiting"),
    ),
    "truth": (
        TICK,
        Field("r", (3,), "m", "world", "pivot on the UAV"),
        Field("v", (3,), "m/s", "world", "its velocity"),
        Field("r_cm", (3,), "m", "world", "UAV's centre of mass"),
        Field("v_cm", (3,), "m/s", "world", "its velocity"),
        Field("quat", (4,), "1", "world<-body", "UAV attitude, scalar first"),
        Field("omega", (3,), "rad/s", "body", "UAV angular velocity"),
        Field("plate_quat", (4,), "1", "world<-plate", "attitude of the hinge plate"),
        Field("ee", (3,), "m", "world", "end effector point"),
        Field("ee_v", (3,), "m/s", "world", "its velocity"),
        Field("ee_quat", (4,), "1", "world<-end effector", "its attitude"),
        Field("hinge_force", (3,), "N", "world", "force on the UAV at the hinge"),
        Field("cradle_force", (3,), "N", "world", "force of the rails on the UAV"),
        Field("foul", (3,), "N", "-", "contact force of the arm on cradle, floor and UAV: none of them may be touched"),
        Field("touching", (), "1", "-", "pads of the magnet in contact with the plate", "i8"),
        Field("rotor_thrust", (4,), "N", "body", "thrust of each rotor"),
        Field("tau", ("n",), "N·m", "joint", "joint torques that really acted"),
    ),
}
"""The messages of a landing by name. `truth` exists in the simulator only: the judge reads it, the controller never does."""


class UavMode:
    """What the UAV makes of thrust and attitude set-point."""

    AUTONOMOUS = 0
    """Hovers where it is by its own means; the set-points are ignored."""
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


class Limit:
    """Bits of `health.flags`: limits that the supervisor enforced."""

    NON_FINITE = 1
    JOINT_POSITION = 2
    JOINT_SPEED = 4
    JOINT_TORQUE = 8
    TORQUE_RATE = 16
    SINGULAR = 32
    HINGE_FORCE = 64


LIMIT_NAMES = {
    Limit.NON_FINITE: "non_finite",
    Limit.JOINT_POSITION: "joint_position",
    Limit.JOINT_SPEED: "joint_speed",
    Limit.JOINT_TORQUE: "joint_torque",
    Limit.TORQUE_RATE: "torque_rate",
    Limit.SINGULAR: "singularity",
    Limit.HINGE_FORCE: "hinge_force",
}


LANDING_TABLE = MessageTable("landing", LANDING_MESSAGES, prefix="Landing")
landing_layout, landing_tick_layout = LANDING_TABLE.layout, LANDING_TABLE.tick_layout


class LandingTick(AnyTick):
    """The messages of a tick of a landing or a take-off."""

    table = LANDING_TABLE
    estimate: NDArray[np.void]
    mission: NDArray[np.void]
    reference: NDArray[np.void]
    command: NDArray[np.void]
    health: NDArray[np.void]
    truth: NDArray[np.void]
