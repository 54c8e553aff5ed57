"""What can be made to fail in the plant, as a scenario says it."""

from typing import Annotated, Literal, NamedTuple, get_args

from pydantic import Field

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key

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

DEVICES = ("encoders", "wrench", "attitude", "camera")


class Shape(NamedTuple):
    """What a kind of failure makes use of."""

    unit: str = ""
    """Of `size`; empty where the size says nothing, `share` where it is at most 1."""
    keys: tuple[str, ...] = ()
    """Which of `rotor`, `direction`, `device`, `body` and `joint`."""


SHAPES: dict[str, Shape] = dict.fromkeys(FAILURES, Shape()) | {
    "wrench_drift": Shape("N/s"),
    "magnet_coil": Shape("share"),
    "magnet_slip": Shape("share"),
    "rotor_loss": Shape("share", ("rotor",)),
    "overload": Shape("N"),
    "unreachable": Shape("m", ("direction",)),
    "non_finite": Shape("", ("device",)),
    "encoder_offset": Shape("rad", ("joint",)),
    "attitude_offset": Shape("rad", ("direction",)),
    "push": Shape("N", ("direction", "body")),
    "twist": Shape("N·m", ("direction",)),
}
"""What each kind of failure makes use of; the other keys are refused where they are set."""


class Fault(Section):
    """One failure: when it begins, how long it lasts, how bad it is."""

    kind: FailureKind = Field(description="what fails")
    phase: Annotated[str, Field(max_length=60)] | None = key(
        None, "phase at whose begin it is armed; the run's begin if absent"
    )
    after_s: of.Seconds = key(0.0, "time from there")
    lasts_s: of.PositiveSeconds = key(3600.0, "how long it lasts")
    rotor: Annotated[int, Field(ge=1, le=4)] = key(1, "number of the rotor; only for `rotor_loss`")
    size: Annotated[float, between(-1e4, 1e4)] = key(
        1.0,
        "drift in N/s, coil or magnet or rotor's share that is lost, load or push in N, twist in N·m, distance in m, "
        "offset in rad; not used by the others",
    )
    direction: of.Direction = key(
        (0.0, 0.0, 1.0),
        "components of the direction of a push, the axis of a twist or of an attitude offset, or the direction of an "
        "unreachable UAV, world; its length scales the size",
    )
    device: Literal["encoders", "wrench", "attitude", "camera"] = key("encoders", "whose samples are not finite")
    body: Literal["uav", "tool", "elbow"] = key("tool", "what is pushed; the tool is beyond the sensor")
    joint: Annotated[int, Field(ge=1, le=64)] = key(1, "number of the joint whose encoder is off, from 1")

    def _contradictions(self) -> list[str]:
        shape, problems = SHAPES[self.kind], []
        if shape.unit == "share" and not 0.0 < self.size <= 1.0:
            problems.append(f"size = {self.size:g} is the share that `{self.kind}` takes: above 0, at most 1")
        if "direction" in shape.keys and not any(self.direction):
            problems.append("direction = [0, 0, 0] points nowhere; [0, 0, 1] points upwards")
        for name in ("rotor", "direction", "device", "body", "joint"):
            if name not in shape.keys and getattr(self, name) != type(self).model_fields[name].default:
                problems.append(
                    f"{name} has no effect on `{self.kind}`; it uses {', '.join(shape.keys) or 'none of these'}"
                )
        if not shape.unit and self.size != 1.0:
            problems.append(f"size has no effect on `{self.kind}`")
        return problems
