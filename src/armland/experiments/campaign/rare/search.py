"""A rare campaign: stages of flights that learn where failures are, then flights that count for their rate.

What is drawn next depends on what was flown before, and on nothing else: rows of a store lead to the same stages again, so a campaign
goes on after whatever stopped it, and each row is flown again as any other. Flight k has the seed of any campaign's flight k; of the
parameters each has a stream of its own, and one more stream chooses the part of the mixture.
"""

import json
import math
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.special import ndtr

from armland.errors import ConfigurationError
from armland.experiments.campaign.crews.threads import Crew, Work
from armland.experiments.campaign.description import Description, Failure
from armland.experiments.campaign.design import CHUNK, MOST_RUNS
from armland.experiments.campaign.engine import Campaign, Told, begin
from armland.experiments.campaign.flight import attempt
from armland.experiments.campaign.rare.failure import score
from armland.experiments.campaign.rare.learning import Next, Stage, following
from armland.experiments.campaign.rows import Row, Task
from armland.experiments.campaign.store import Store
from armland.experiments.campaign.versions import versions
from armland.plant.noise import stream
from armland.rotations import Array

LEAST = 2
"""Stages that the flights of a rare campaign must be worth."""
_TINY = 2.0**-54


class Search:
    """The flights of a rare campaign, as far as its rows lead.

    Args:
        campaign: what is flown.

    Raises:
        ConfigurationError: it is none that this way of drawing is for.
    """

    def __init__(self, campaign: Campaign) -> None:
        # In an order that a store keeps, which a file's is not.
        self.drawn = dict(sorted(campaign.description.drawn.items()))
        self.campaign, self.names = campaign, list(self.drawn)
        self._failure = campaign.description.failure or Failure()
        check(campaign.description, campaign.runs)
        self.stages: list[Stage] = []
        """Of learning, those that are complete."""
        self.next: Next = following((), len(self.names))
        self.first = 0
        """Number of the first flight of the stage under way."""
        self.scores: dict[int, float] = {}
        """Of the flights of the stage under way, by number."""
        self._drawn = lru_cache(maxsize=4)(self._draw)

    @property
    def end(self) -> int:
        """Number after the last flight of the stage under way."""
        return self.campaign.runs if self.next.learnt else min(self.first + self._failure.stage, self.campaign.runs)

    def task(self, run: int) -> Task:
        """The flight `run` of the stage under way."""
        _, values = self._drawn(len(self.stages), run // CHUNK)
        d, at = self.campaign.description, run % CHUNK
        return Task(run, 0, d.first_seed + run, d.grid[0] | {name: column[at] for name, column in values.items()})

    def tasks(self) -> Iterator[Task]:
        """The flights of the stage under way that have no row yet."""
        return (self.task(run) for run in range(self.first, self.end) if run not in self.scores)

    def add(self, row: Row) -> None:
        """Take a row of the stage under way; after its last the next one is under way.

        Raises:
            ConfigurationError: a row that these stages do not lead to.
        """
        if not (self.first <= row.run < self.end and _alike(row.values, self.task(row.run).values)):
            raise ConfigurationError(
                f"row {row.run} is none that the rows before it lead to: rows of a rare campaign belong together"
            )
        self.scores[row.run] = score(row, self._failure, self.campaign.bounds)
        whole = len(self.scores) == self._failure.stage
        if whole and not self.next.learnt:
            self.stages.append(self.so_far())
            self.first, self.scores = self.end, {}
            self.next = following(self.stages, len(self.names))

    def so_far(self) -> Stage:
        """The flights of the stage under way that have a row, in the order of their numbers."""
        runs = sorted(self.scores)
        places = [self._drawn(len(self.stages), run // CHUNK)[0][run % CHUNK] for run in runs]
        z = np.array(places).reshape(len(runs), len(self.names))
        return Stage(self.next.proposal, z, np.array([self.scores[run] for run in runs]))

    def _draw(self, _: int, chunk: int) -> tuple[Array, dict[str, list[Any]]]:
        # Points and values of a chunk of flights, drawn as the stage under way draws.
        described = self.campaign.description
        columns = [_shares(described, f"rare {name}", chunk) for name in ("", *self.names)]
        z = self.next.proposal.places(np.column_stack(columns))
        shares = np.clip(ndtr(z), 1e-300, 1.0 - _TINY)
        return z, {n: p.quantile()(shares[:, i]) for i, (n, p) in enumerate(self.drawn.items())}


def check(described: Description, runs: int) -> None:
    """Refuse what cannot be flown so.

    Raises:
        ConfigurationError: several points, nothing that is drawn, a design that is not random, too few flights.
    """
    if len(described.grid) > 1:
        raise ConfigurationError(
            f"--rare finds one rate, and the file has {len(described.grid)} points; `fixed` or a distribution instead of `sweep` works"
        )
    if not described.drawn:
        raise ConfigurationError("--rare looks where failures are among drawn values; [parameters] has none")
    if described.design != "random":
        raise ConfigurationError(f"--rare draws by itself: design = {described.design!r} does not work, 'random' does")
    stage = (described.failure or Failure()).stage
    if not LEAST * stage <= runs <= MOST_RUNS:
        raise ConfigurationError(
            f"--runs {runs}: with --rare {LEAST * stage} to {MOST_RUNS} flights, as a stage of learning has {stage}"
        )


def conduct_rare(
    campaign: Campaign, store: Store, crew: Crew, told: Told = lambda _: None, work: Work = attempt
) -> Search:
    """Fly what the store lacks of a rare campaign, stage by stage, and add each row as it is done.

    Args:
        campaign: what is flown.
        store: open for writing, empty or of the same campaign.
        crew: who flies; called once for each stage.
        told: called with each row that is new.
        work: makes the row of a task.

    Raises:
        ConfigurationError: the store is of another campaign.
        StoreError: the disk takes no more; all rows before are there.
        ClusterError: there is nobody to fly.
    """
    search = Search(campaign)
    begin(campaign, store)
    made = json.dumps(versions(), sort_keys=True)
    for row in store.rows():
        search.add(row)
    while len(search.scores) < search.end - search.first:
        for row in crew(work, campaign.job, search.tasks()):
            store.add(row, made)
            search.add(row)
            told(row)
    return search


def _shares(described: Description, name: str, chunk: int) -> Array:
    generator = stream(described.first_seed, name)
    # One number a flight, so a later flight's is found without drawing all before it.
    generator.bit_generator.advance(chunk * CHUNK)  # type: ignore[attr-defined]
    return generator.random(CHUNK) + _TINY


def _alike(a: dict[str, Any], b: dict[str, Any]) -> bool:
    # Another machine may round otherwise.
    def same(x: Any, y: Any) -> bool:
        numbers = isinstance(x, float) and isinstance(y, float)
        return math.isclose(x, y, rel_tol=1e-6, abs_tol=1e-9) if numbers else x == y

    return a.keys() == b.keys() and all(same(a[name], b[name]) for name in a)
