"""What the judge is told beside the recorded ticks: the mission's plan as data, kept in the log's metadata."""

import json
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import LogError
from armland.mission.reference.path import Leg
from armland.mission.table.mission import Criterion
from armland.rotations import Array

Ticks = NDArray[np.void] | Mapping[str, NDArray[np.void]]
"""Recorded ticks (k,) of `records.tick_layout`, or the messages of a log by name."""


class Brief(NamedTuple):
    """A mission as the judge has to know it."""

    mission: str
    start: str
    """`hinged`, `air` or `cradle`."""
    rate_hz: int
    phases: tuple[str, ...]
    finals: frozenset[str]
    """Names of the phases that end the mission."""
    faults: tuple[str, ...]
    """Names of the faults that the controller can find, `none` first."""
    limits: dict[str, Any]
    """By the names of `judge.limits`; a limit that is not here is not judged."""
    put_down: Array
    """(3,) m, D: where the pivot is when the UAV stands in the middle of the cradle."""
    given: Array
    """(3,) m/s, D: velocity that the UAV keeps after the release."""
    legs: tuple[Leg, ...]
    """Of the path that the mission follows; none where it follows none."""
    judged_as: str
    """Row of `judgement.KINDS`."""
    praise: str
    """What to say where all is well."""
    criteria: tuple[Criterion, ...]
    """Largest values of figures, by `judge.figures.NAMES`."""
    timeouts: dict[str, str]
    """Phase -> why it can run out of time, and what helps."""


def brief_of(metadata: Mapping[str, str]) -> Brief:
    """The brief that stands in a log's metadata, where `episode` has put it.

    Raises:
        LogError: it lacks something; the log is of an older version or of another program.
    """
    try:
        return Brief(
            mission=metadata["mission"],
            start=metadata["start"],
            rate_hz=round(1e9 / int(metadata["period_ns"])),
            phases=tuple(metadata["phases"].split(",")),
            finals=frozenset(metadata["finals"].split(",")),
            faults=tuple(metadata["faults"].split(",")),
            limits={name: np.array(value) for name, value in json.loads(metadata["limits"]).items()},
            put_down=np.array(json.loads(metadata["put_down"])),
            given=np.array(json.loads(metadata["given"])),
            legs=tuple(_leg(leg) for leg in json.loads(metadata["legs"])),
            judged_as=metadata["judged_as"],
            praise=metadata["praise"],
            criteria=tuple(Criterion(*row) for row in json.loads(metadata["criteria"])),
            timeouts=dict(json.loads(metadata["timeouts"])),
        )
    except KeyError as e:
        raise LogError(
            f"the log's metadata has no {e.args[0]!r}, which judging it needs; it has {', '.join(metadata)}"
        ) from e
    except (TypeError, ValueError) as e:
        raise LogError(f"the log's metadata is damaged: {e}") from e


def _leg(data: dict[str, Any]) -> Leg:
    leg = Leg(**data)
    return leg._replace(origin=np.array(leg.origin), target=np.array(leg.target))
