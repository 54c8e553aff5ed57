"""What can be made to fail in the plant, as a scenario says it."""

from typing import Literal, get_args

from pydantic import Field

from armland.scenario import Finite, NonNegative, Positive, Section, Vector3

FailureKind = Literal[
    "link_loss",
    "uplink_loss",
    "downlink_loss",
    "camera_frozen",
    "camera_lost",
    "wrench_frozen",
    "wrench_drift",
    "arm_stale",
    "magnet_coil",
    "magnet_slip",
    "rotor_loss",
    "overload",
    "unreachable",
    "non_finite",
    "encoder_offset",
    "attitude_offset",
    "push",
    "twist",
]

FAILURES: tuple[str, ...] = get_args(FailureKind)


class Fault(Section):
    """One failure: when it begins, how long it lasts, how bad it is."""

    kind: FailureKind
    phase: str | None = Field(None, description="phase at whose begin it is armed; the run's begin if absent")
    after_s: NonNegative = Field(0.0, description="time from there")
    lasts_s: Positive = Field(1e6, description="how long it lasts")
    rotor: int = Field(1, ge=1, le=4, description="which rotor; only for `rotor_loss`")
    size: Finite = Field(
        1.0,
        description="drift in N/s, coil or magnet or rotor's share that is lost, load or push in N, twist in N·m, distance in m, "
        "offset in rad; not used by the others",
    )
    direction: Vector3 = Field(
        (0.0, 0.0, 1.0),
        description="of a push, the axis of a twist or of an attitude offset, or the way of an unreachable UAV, world",
    )
    device: Literal["encoders", "wrench", "attitude", "camera"] = Field(
        "encoders", description="whose samples are not finite"
    )
    body: Literal["uav", "tool", "elbow"] = Field("tool", description="what is pushed; the tool is beyond the sensor")
    joint: int = Field(1, ge=1, description="whose encoder is off, from 1")
