"""A deviation's distribution and range, and the table of a device that is made of them.

A range is written as a number x (from −x to x, or from 0 to x where the deviation has one sign), as a pair [low, high], or as
{low, high} with `normal` or `ends`. A pair of equal numbers is that deviation exactly.
"""

from typing import Any, NamedTuple

from pydantic import ConfigDict, Field, model_validator

from armland.scenario import quantities as of
from armland.scenario.quantities import Section


class Spread(Section):
    """Range of a deviation."""

    rising = ()

    low: of.Angle = Field(description="smallest number, in the unit of the key")
    high: of.Angle = Field(description="largest number, in the unit of the key")
    normal: bool = Field(
        False,
        description="normal about the middle, a quarter of the range as standard deviation, cut off at its ends; else uniform",
    )
    ends: bool = Field(False, description="each number at one end of the range, by chance, and nothing between")

    def _contradictions(self) -> list[str]:
        found = [f"low = {self.low:g} is above high = {self.high:g}"] if self.low > self.high else []
        return found + ["normal and ends: a distribution is one of them"] * (self.normal and self.ends)


class Told(NamedTuple):
    """What stands beside a deviation's key."""

    low: float
    high: float
    """The published range."""
    least: float
    most: float
    """What a device can be at all."""
    size: str
    """How many numbers are drawn: a number, or `n` for one of each joint."""


def deviates(published: tuple[float, float], bound: tuple[float, float], meaning: str, size: str = "1") -> Any:
    """A key of a device's table: its `published` range, the `bound` of what a device can be, and what it means, with its source."""
    told: dict[str, Any] = {"published": list(published), "bound": list(bound), "size": size}
    return Field(None, description=meaning, json_schema_extra=told)


class Device(Section):
    """The deviations of one device; a key that is absent has the level's range."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    @classmethod
    def told(cls, name: str) -> Told:
        """What stands beside the key `name`."""
        extra: Any = cls.model_fields[name].json_schema_extra
        low, high = extra["published"]
        least, most = extra["bound"]
        return Told(low, high, least, most, extra["size"])

    @model_validator(mode="before")
    @classmethod
    def _short(cls, data: Any) -> Any:
        # Numbers and pairs, written out.
        if not isinstance(data, dict):
            return data
        out = dict(data)
        for name, value in data.items():
            if name not in cls.model_fields:
                continue
            if isinstance(value, int | float) and not isinstance(value, bool):
                # To the wrong side of a one-sided range, too: it is the bound that refuses it.
                one_sided = cls.told(name).low >= 0.0
                low, high = (min(value, 0.0), max(value, 0.0)) if one_sided else (-abs(value), abs(value))
                out[name] = {"low": low, "high": high}
            elif isinstance(value, list | tuple) and len(value) == 2:
                out[name] = {"low": value[0], "high": value[1]}
        return out

    def _contradictions(self) -> list[str]:
        found = []
        for name in type(self).model_fields:
            spread, told = getattr(self, name), self.told(name)
            if spread is not None and not told.least <= spread.low <= spread.high <= told.most:
                found.append(
                    f"{name} = [{spread.low:g}, {spread.high:g}] lies outside {told.least:g} to {told.most:g}, which is all that "
                    f"such a device can be; published: [{told.low:g}, {told.high:g}]"
                )
        return found
