"""A recorded run as figures and tables read it: its ticks, and what its log says about the mission."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.judge.brief import Brief, brief_of
from armland.experiments.judge.deck import seen_from_deck
from armland.runtime.log import Log

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
