"""What is asked for and what is given back: a flight of a campaign, and its row. Nothing here needs more than Python itself."""

from typing import Any, NamedTuple

REFUSED, BROKE, KILLED = "refused", "broke", "killed"
"""Outcomes of what came to no flight: refused before anything moved, an error, a worker that died over it."""


class Job(NamedTuple):
    """What all flights of a campaign have in common."""

    scenario: str
    """As `Scenario.frozen` gives it."""
    mission: str
    law: str | None = None
    experiment: str | None = None


class Row(NamedTuple):
    """What is kept of a flight."""

    run: int
    point: int
    seed: int
    values: dict[str, Any]
    success: bool
    outcome: str
    """How the mission ended, or one of `REFUSED`, `BROKE`, `KILLED`."""
    result: dict[str, Any] | None = None
    """As `episode.Episode.result`; None of what came to no flight."""
    scenario: str = ""
    """Digest of the scenario as it flew, every value resolved."""
    digest: str = ""
    """Of the ticks."""
    error: str = ""
    wall_s: float = 0.0
    cpu_s: float = 0.0
    """Of the thread that flew."""

    def judged(self) -> dict[str, Any]:
        """The result as `summary.summarise` takes it; of what came to no flight a row that says why."""
        if self.result is not None:
            return self.result
        return {"seed": self.seed, "success": False, "reason": f"{self.outcome}: {self.error}", "state": "unknown"}


class Task(NamedTuple):
    """One flight that is to be made."""

    run: int
    """Row in the store: flight times number of points, plus point."""
    point: int
    seed: int
    values: dict[str, Any]
    """By path in the scenario."""


def lost(task: Task, why: str) -> Row:
    """The row of a flight over which workers died."""
    return Row(*task, success=False, outcome=KILLED, error=why)
