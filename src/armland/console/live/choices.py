"""What is chosen in the page for the next flight, and the command line that flies the same."""

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, ValidationError

from armland.errors import ConfigurationError
from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key
from armland.scenario.refusal import problems

SEAS = ("as in the scenario", "0", "1", "2", "3", "4", "tank", "usv")

OWN = "as in the mission"
"""Law: that which the mission or the scenario names."""


class Choices(Section):
    """One flight; what is empty is as the scenario has it."""

    mission: of.Text = key("landing", "name in the registry of missions")
    scenario: of.Text = key("landing", "file, or name of one that comes with armland")
    arm: of.Text = key("", "file, or name that collections of arms know")
    ee: of.Text = key("", "what carries the tool")
    uav: of.Text = key("", "file, or name of one that comes with armland")
    law: of.Text = key("", "row of the table of laws, or FILE.py:FUNCTION")
    sea: of.Text = key("", "sea state")
    wind: Annotated[float, between(0.0, 40.0)] = key(0.0, "mean wind, m/s at 20 ft; 0: as in the scenario")
    seed: Annotated[int, Field(ge=0, le=2**62)] = key(1, "of every random stream")

    def given(self, settings: Sequence[str] = ()) -> dict[str, Any]:
        """The options of a command line that mean the same, by name.

        Args:
            settings: values of the scenario that are replaced besides, `key=value`.
        """
        told: dict[str, Any] = {
            "arm": self.arm,
            "ee": self.ee,
            "uav": self.uav,
            "law": self.law,
            "sea": self.sea,
            "scenario": self.scenario,
        }
        options = {name: value.strip() or None for name, value in told.items()}
        return {**options, "wind": self.wind or None, "seed": self.seed, "settings": list(settings)}

    def command(self, operator: Path | None = None, settings: Sequence[str] = ()) -> str:
        """The command that flies the same again, the operator's messages included.

        Args:
            operator: log or script of the messages; none where nobody steered.
            settings: values of the scenario that are replaced besides, `key=value`.
        """
        words = ["armland", "run", self.mission, self.scenario, "--seed", str(self.seed)]
        for name in ("arm", "ee", "uav", "law", "sea"):
            if value := getattr(self, name).strip():
                words += [f"--{name}", value]
        words += ["--wind", f"{self.wind:g}"] if self.wind else []
        for setting in settings:
            words += ["--set", setting]
        words += [] if operator is None else ["--operator", str(operator)]
        return shlex.join(words)


def chosen(data: dict[str, Any]) -> Choices:
    """The choices of a page.

    Raises:
        ConfigurationError: all that is wrong with them.
    """
    try:
        return Choices.model_validate(data)
    except ValidationError as e:
        raise ConfigurationError("; ".join(problems(e, Choices))) from e
