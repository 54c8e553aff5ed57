"""The section `deviation` of a scenario, and what its levels mean."""

from collections.abc import Iterator
from typing import Literal, NamedTuple, get_args

from pydantic import Field

from armland.scenario.deviation import devices as of
from armland.scenario.deviation.spread import Device, Spread, Told
from armland.scenario.quantities import Section, key

Level = Literal["nominal", "mild", "published", "harsh"]

LEVELS: dict[str, float] = dict(zip(get_args(Level), (0.0, 0.5, 1.0, 2.0), strict=True))
"""Level -> by what the published ranges are multiplied."""


class Deviation(Section):
    """How the plant differs from what the controller believes, drawn for each seed."""

    level: Level = key(
        "nominal", "of all deviations that have no range of their own: none, half of, all of, twice the published range"
    )
    uav: of.UavDeviation = Field(of.UavDeviation(), description="body, rotors, attitude sensor, own hover")
    link: of.LinkDeviation = Field(of.LinkDeviation(), description="wireless link")
    camera: of.CameraDeviation = Field(of.CameraDeviation(), description="camera and marker")
    wrench: of.WrenchDeviation = Field(of.WrenchDeviation(), description="force-torque sensor and tool")
    arm: of.ArmDeviation = Field(of.ArmDeviation(), description="encoders, motors, bodies of the arm")
    magnet: of.MagnetDeviation = Field(of.MagnetDeviation(), description="electromagnet and plate's face")
    hinge: of.HingeDeviation = Field(of.HingeDeviation(), description="spherical hinge")
    cradle: of.CradleDeviation = Field(of.CradleDeviation(), description="cradle")
    air: of.AirDeviation = Field(of.AirDeviation(), description="wind, gusts, ground effect, downwash")


class Row(NamedTuple):
    """One deviation."""

    path: str
    """`device.key`."""
    told: Told
    meaning: str


def rows() -> Iterator[Row]:
    """All deviations, by device."""
    for name, field in Deviation.model_fields.items():
        kind = field.annotation
        if isinstance(kind, type) and issubclass(kind, Device):
            for entry, inner in kind.model_fields.items():
                yield Row(f"{name}.{entry}", kind.told(entry), inner.description or "")


def ranges(deviation: Deviation) -> dict[str, Spread]:
    """The range of each deviation that is not zero: its own, else the level's share of the published one, within its bound."""
    out, share = {}, LEVELS[deviation.level]
    for row in rows():
        device, entry = row.path.split(".")
        spread, t = getattr(getattr(deviation, device), entry), row.told
        if spread is None:
            spread = Spread(low=max(share * t.low, t.least), high=min(share * t.high, t.most))
        if spread.low != 0.0 or spread.high != 0.0:
            out[row.path] = spread
    return out
