"""A recorded run as figures and tables read it: its ticks, and what its log says about the mission."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from armland.errors import ConfigurationError, LogError
from armland.experiments.judge.brief import Brief, brief_of
from armland.experiments.judge.deck import seen_from_deck
from armland.runtime.log import Log
from armland.scenario import Scenario

Ticks = Mapping[str, NDArray[np.void]]  # Messages by name, (ticks,) each


class Flown(NamedTuple):
    """A run; its truth as the deck sees it."""

    name: str  # Of the experiment, or of the mission where it has none
    ticks: Ticks
    brief: Brief

    @property
    def time(self) -> NDArray[np.float64]:
        """Time of each tick, (ticks,), s, from the first one on."""
        return np.arange(len(self.ticks["truth"])) / self.brief.rate_hz


def flown(log: Log) -> Flown:
    """The run that a log holds.

    Raises:
        LogError: its metadata lacks something; it is of an older version or of another program.
    """
    brief = brief_of(log.metadata)
    return Flown(log.metadata.get("experiment") or brief.mission, seen_from_deck(log.messages), brief)


def scenario_of(log: Log) -> Scenario:
    """The scenario that stands in a log.

    Raises:
        LogError: there is none, or this version does not know it.
    """
    text, version = log.metadata.get("scenario"), log.metadata.get("version", "of another version")
    if text is None:
        raise LogError(f"the log holds no scenario; it has {', '.join(sorted(log.metadata))}")
    try:
        return Scenario.model_validate_json(text)
    except (ValidationError, ConfigurationError) as e:
        first = str(e).splitlines()[0][:120]
        raise LogError(
            f"this version does not know the log's scenario ({first}); read it with armland {version}"
        ) from e
