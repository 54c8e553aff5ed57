"""What can be made to fail in the plant, as a scenario says it."""

from typing import Annotated, Literal, NamedTuple, get_args

from pydantic import Field

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key

FailureKind = Literal[
    "link_loss",
    "uplink_loss",
    "downlink_loss",
    "link_delay",
    "camera_frozen",
    "camera_lost",
    "camera_noise",
    "camera_outliers",
    "camera_flip",
    "wrong_marker",
    "wrench_frozen",
    "wrench_drift",
    "wrench_dead",
    "wrench_reversed",
    "wrench_gain",
    "arm_stale",
    "magnet_coil",
    "magnet_slip",
    "magnet_stuck",
    "rotor_loss",
    "thrust_loss",
    "power_loss",
    "overload",
    "unreachable",
    "non_finite",
    "encoder_offset",
    "encoder_drift",
    "encoder_frozen",
    "attitude_offset",
    "push",
    "twist",
    "gust",
]

FAILURES: tuple[str, ...] = get_args(FailureKind)

DEVICES = ("encoders", "wrench", "attitude", "camera")

GUST_MOST_S = 60.0
"""Longest gust, s: what rises and falls more slowly is the wind."""


class Shape(NamedTuple):
    """What a kind of failure makes use of."""

    unit: str = ""
    """Of `size`; empty where the size says nothing."""
    keys: tuple[str, ...] = ()
    """Which of `rotor`, `direction`, `device`, `body` and `joint`."""
    most: float | None = None
    """Largest size; where it is given, the size is above 0."""


SHAPES: dict[str, Shape] = dict.fromkeys(FAILURES, Shape()) | {
    "link_delay": Shape("ms/s", most=1000.0),
    "camera_noise": Shape("factor", most=100.0),
    "camera_outliers": Shape("m", most=10.0),
    "wrong_marker": Shape("m", ("direction",)),
    "wrench_drift": Shape("N/s"),
    "wrench_gain": Shape("factor", most=100.0),
    "magnet_coil": Shape("share", most=1.0),
    "magnet_slip": Shape("share", most=1.0),
    "magnet_stuck": Shape("share", most=1.0),
    "rotor_loss": Shape("share", ("rotor",), most=1.0),
    "thrust_loss": Shape("share", most=1.0),
    "overload": Shape("N"),
    "unreachable": Shape("m", ("direction",)),
    "non_finite": Shape("", ("device",)),
    "encoder_offset": Shape("rad", ("joint",)),
    "encoder_drift": Shape("rad/s", ("joint",)),
    "encoder_frozen": Shape("", ("joint",)),
    "attitude_offset": Shape("rad", ("direction",)),
    "push": Shape("N", ("direction", "body")),
    "twist": Shape("N·m", ("direction",)),
    "gust": Shape("m/s", ("direction",), most=50.0),
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
    rotor: Annotated[int, Field(ge=1, le=8)] = key(1, "number of the rotor; only for `rotor_loss`")
    size: Annotated[float, between(-1e4, 1e4)] = key(
        1.0,
        "drift in N/s or rad/s, share of coil, magnet, rotor or thrust that is lost, share of the magnet's rating that "
        "stays, factor on noise or force, load or push in N, twist in N·m, distance or standard deviation in m, offset in "
        "rad, delay that grows in ms/s, gust in m/s; not used by the others",
    )
    direction: of.Direction = key(
        (0.0, 0.0, 1.0),
        "components of the direction of a push or a gust, the axis of a twist or of an attitude offset, or the direction of "
        "an unreachable UAV or of a wrong marker, world; its length scales the size",
    )
    device: Literal["encoders", "wrench", "attitude", "camera"] = key("encoders", "whose samples are not finite")
    body: Literal["uav", "tool", "elbow"] = key("tool", "what is pushed; the tool is beyond the sensor")
    joint: Annotated[int, Field(ge=1, le=64)] = key(1, "number of the joint whose encoder is off, from 1")

    def _contradictions(self) -> list[str]:
        shape, problems = SHAPES[self.kind], []
        if shape.most is not None and not 0.0 < self.size <= shape.most:
            problems.append(
                f"size = {self.size:g} is the {shape.unit} of `{self.kind}`: above 0, at most {shape.most:g}"
            )
        if shape.unit == "factor" and self.size == 1.0:
            problems.append(f"size = 1 changes nothing: it is the factor of `{self.kind}`")
        if "direction" in shape.keys and not any(self.direction):
            problems.append("direction = [0, 0, 0] points nowhere; [0, 0, 1] points upwards")
        if self.kind == "gust":
            problems += self._gust_contradictions()
        for name in ("rotor", "direction", "device", "body", "joint"):
            if name not in shape.keys and getattr(self, name) != type(self).model_fields[name].default:
                problems.append(
                    f"{name} has no effect on `{self.kind}`; it uses {', '.join(shape.keys) or 'none of these'}"
                )
        if not shape.unit and self.size != 1.0:
            problems.append(f"size has no effect on `{self.kind}`")
        return problems

    def _gust_contradictions(self) -> list[str]:
        problems = []
        if self.direction[2] != 0.0:
            problems.append(f"direction = {list(self.direction)}: a gust is horizontal; [1, 0, 0] points along x")
        if self.lasts_s > GUST_MOST_S:
            problems.append(f"lasts_s = {self.lasts_s:g}: a gust rises and falls within at most {GUST_MOST_S:g} s")
        return problems
