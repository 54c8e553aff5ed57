"""Laws crossed with the controllers on board that they were compared with, under an arm model that is wrong either way.

A row of the comparison that sets the UAV's own controller changes two things at once. Here each law keeps its gains on the ground and
flies with each row's controller on board.
"""

from dataclasses import asdict, dataclass
from typing import Any

from armland.experiments.judge.tracking import Metrics
from armland.experiments.paper import Progress, fly_all, metrics_of, prepare, silent
from armland.mission.tuning import tuned
from armland.scenario import Scenario

LAWS = ("classical", "E2", "E3", "exact", "implied", "split", "observer")
BOARDS = {"as in the paper": "E3", "as in split": "split", "as in observer": "observer"}
"""Controllers on board by the row of `compare.toml` that has them; the first is the calibrated one of the paper's experiments."""

ARMS: dict[str, dict[str, Any]] = {
    "right": {},
    "believed 20 % light": {"belief": {"arm": {"inertia_scale": 0.8}}},
    "believed 20 % heavy": {"belief": {"arm": {"inertia_scale": 1.2}}},
    "truly 20 % light": {"arm": {"inertia_scale": 0.8}, "belief": {"arm": {"inertia_scale": 1.0}}},
    "truly 20 % heavy": {"arm": {"inertia_scale": 1.2}, "belief": {"arm": {"inertia_scale": 1.0}}},
}
"""What of the arm's masses and inertias is wrong: in the controller's model, or in the plant."""


@dataclass(frozen=True)
class Cell:
    """A law with a controller on board, under one arm."""

    law: str
    board: str
    arm: str
    metrics: Metrics


@dataclass(frozen=True)
class Factorial:
    """All cells."""

    cells: list[Cell]

    def result(self) -> dict[str, Any]:
        """The cells as plain data."""
        return {"cells": [asdict(c) for c in self.cells]}


def crossed(scenario: Scenario, law: str, board: str) -> Scenario:
    """The scenario whose experiment `law` flies with the controller on board of experiment `board`.

    Gains on the ground are those that the law has with its own board.
    """
    believed = scenario.believed()
    control = tuned(believed, law).control.model_dump(include={"k1", "k2", "k3", "k3_attitude"})
    onboard = tuned(believed, board).onboard.model_dump()
    return scenario.replaced({"control": control, "experiments": {law: {"onboard": onboard, "rule": None}}})


def cross(scenario: Scenario, progress: Progress = silent) -> Factorial:
    """Fly every law of `LAWS` with every board under every arm; `progress` is called with (arm, done, in all)."""
    cells: list[Cell] = []
    for done, (arm, change) in enumerate(ARMS.items()):
        progress(arm, done, len(ARMS))
        for board, row in BOARDS.items():
            # Gains are found for the arm that is believed, before it turns out to be another.
            chosen = {law: crossed(scenario, law, row).replaced(change) for law in LAWS}
            flown = fly_all({law: prepare(one, [law])[law] for law, one in chosen.items()})
            cells += [Cell(law, board, arm, metrics_of(episode)) for law, episode in flown.items()]
    progress("done", len(ARMS), len(ARMS))
    return Factorial(cells)
