"""A row of a store flown once more, and whether it is the same bit for bit."""

from pathlib import Path
from typing import NamedTuple

from armland.experiments.campaign.flight import flown
from armland.experiments.campaign.rows import Job, Row, Task
from armland.experiments.campaign.store import Store
from armland.experiments.campaign.versions import versions
from armland.experiments.episode import Episode


class Replay(NamedTuple):
    """A row, and what came of it this time."""

    row: Row
    again: Row
    episode: Episode
    changed: tuple[str, ...]
    """Versions that are others than the row's, in words."""

    @property
    def same(self) -> bool:
        """Whether scenario and ticks are the same bit for bit; true of no row that came to no flight."""
        return bool(self.row.digest) and (self.row.digest, self.row.scenario) == (
            self.again.digest,
            self.again.scenario,
        )


def replay(store: Store, run: int, log: Path | None = None) -> Replay:
    """Fly the row numbered `run` again; `log` is the file of its run log where one is wanted.

    Raises:
        ConfigurationError: the store has no such row, or the row was refused and is so again.
        PlantError: the simulated world breaks, as it may have done the first time.
    """
    import json

    row = store.row(run)
    made, now = json.loads(store.versions_of(run)), versions()
    changed = tuple(f"{name} {made[name]} there, {now.get(name)} here" for name in made if made[name] != now.get(name))
    again, episode = flown(Job(**store.about["job"]), Task(row.run, row.point, row.seed, row.values), log)
    return Replay(row, again, episode, changed)
