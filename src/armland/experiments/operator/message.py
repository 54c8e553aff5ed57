"""One message of an operator: what is to be done, from which tick on; checked before anything hears of it."""

import json
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError

from armland.errors import ConfigurationError
from armland.scenario.faults import Fault
from armland.scenario.quantities import Section, key
from armland.scenario.refusal import problems

Verb = Literal["hold", "resume", "abort", "wind", "sea", "delay", "noise", "mass", "fault"]

RANGES: dict[str, tuple[float, float, str]] = {
    "wind": (0.0, 40.0, "m/s at 20 ft"),
    "sea": (0.0, 3.0, "times the sea of the scenario"),
    "delay": (0.0, 400.0, "ms more, each way"),
    "noise": (0.0, 10.0, "times the sensors' noise"),
    "mass": (0.5, 2.0, "times the UAV's mass"),
}
"""Lowest and highest value of each verb that has one, and what it means."""

LAST_TICK = 100_000_000


class Message(Section):
    """A message that acts from the begin of tick `tick` on."""

    tick: Annotated[int, Field(ge=0, le=LAST_TICK)] = key(0, "at whose begin it acts")
    do: Verb = Field(description="what is to be done")
    value: Annotated[float, Field(allow_inf_nan=False)] = key(0.0, "of wind, sea, delay, noise and mass; see RANGES")
    fault: Fault | None = key(None, "what fails, of `fault`; where it names no phase, from the tick on")

    def _contradictions(self) -> list[str]:
        found = super()._contradictions()
        if self.do in RANGES:
            low, high, unit = RANGES[self.do]
            if not low <= self.value <= high:
                found.append(f"value = {self.value:g} of {self.do} lies outside {low:g} to {high:g} {unit}")
        elif self.value != 0.0:
            found.append(f"value has no effect on {self.do}; leave it out")
        if (self.fault is None) == (self.do == "fault"):
            found.append("fault has to be there" if self.do == "fault" else f"fault has no effect on {self.do}")
        return found

    def words(self) -> str:
        """What the operator did, in words."""
        if self.do in RANGES:
            return f"{self.do} {self.value:g} {RANGES[self.do][2]}"
        if self.fault is not None:
            when = f"when {self.fault.phase} begins" if self.fault.phase else "at once"
            return f"{self.fault.kind.replace('_', ' ')} thrown in, {when}"
        return self.do

    def at(self, tick: int) -> "Message":
        """The same at another tick."""
        return self.model_copy(update={"tick": tick})


def message_of(data: Any) -> Message:
    """The message that plain data means.

    Raises:
        ConfigurationError: all that is wrong with it.
    """
    try:
        # As text: there lists stand for tuples, and nothing else is taken for something that it is not.
        return Message.model_validate_json(json.dumps(data))
    except ValidationError as e:
        raise ConfigurationError("; ".join(problems(e, Message, "message"))) from e
    except (RecursionError, OverflowError, TypeError, ValueError) as e:
        raise ConfigurationError(f"message: no plain data: {type(e).__name__}") from e


def asked(do: str, value: float = 0.0, fault: Fault | None = None) -> Message:
    """A message for the tick that comes next, whichever that will be; errors as for `message_of`."""
    data: dict[str, Any] = {"do": do, "value": value}
    return message_of(data if fault is None else {**data, "fault": fault.model_dump()})
