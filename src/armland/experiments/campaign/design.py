"""Which flights a campaign makes: run, point, seed and values of each, the same however often and in which order they are asked for.

Flight k of each point has the same seed and the same drawn values, so points are compared pair by pair. In the designs `random` and
`latin` each parameter has a stream of its own, which derives from the seed and its path: a further parameter moves no other's values.
"""

import warnings
from collections.abc import Iterator
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from scipy.stats import qmc

from armland.errors import ConfigurationError
from armland.experiments.campaign.description import Description
from armland.experiments.campaign.rows import Task
from armland.plant.noise import stream
from armland.rotations import Array

MOST_RUNS = 10_000_000
CHUNK = 1024
"""Flights whose values are drawn at once: few enough for memory, many enough for speed."""
MOST_SOBOL = 2**30


class Schedule:
    """All flights of a campaign.

    Args:
        description: what varies.
        runs: flights of each point.

    Raises:
        ConfigurationError: none, or more than a design can give.
    """

    def __init__(self, description: Description, runs: int) -> None:
        self.description, self.runs, self.points = description, runs, description.grid
        most = MOST_SOBOL if description.design == "sobol" else MOST_RUNS
        if not 1 <= runs * len(self.points) <= most:
            points = f" for each of {len(self.points)} points" if len(self.points) > 1 else ""
            raise ConfigurationError(f"--runs {runs}{points}: a campaign has 1 to {most} flights in all")
        self._chunk = lru_cache(maxsize=4)(self._draw)

    def __len__(self) -> int:
        return self.runs * len(self.points)

    def task(self, run: int) -> Task:
        """The flight in the row `run`."""
        flight, point = divmod(run, len(self.points))
        chunk = self._chunk(flight // CHUNK)
        values = {name: column[flight % CHUNK] for name, column in chunk.items()}
        return Task(run, point, self.description.first_seed + flight, self.points[point] | values)

    def tasks(self, flown: set[int] | frozenset[int] = frozenset()) -> Iterator[Task]:
        """The flights that are not among the rows `flown`, in their order."""
        return (self.task(run) for run in range(len(self)) if run not in flown)

    def _draw(self, chunk: int) -> dict[str, list[Any]]:
        d, first = self.description, chunk * CHUNK
        count = min(CHUNK, self.runs - first)
        if not d.drawn:
            return {}
        shares = {"random": self._random, "latin": self._latin, "sobol": self._sobol}[d.design](first, count)
        return {name: p.quantile()(shares[:, i]) for i, (name, p) in enumerate(d.drawn.items())}

    def _random(self, first: int, count: int) -> Array:
        out = np.empty((count, len(self.description.drawn)))
        for i, name in enumerate(self.description.drawn):
            generator = stream(self.description.first_seed, f"campaign {name}")
            # One number a flight, so a later flight's is found without drawing all before it.
            generator.bit_generator.advance(first)  # type: ignore[attr-defined]
            out[:, i] = generator.random(count)
        return out

    def _latin(self, first: int, count: int) -> Array:
        return self._hypercube[first : first + count]

    @cached_property
    def _hypercube(self) -> Array:
        # A hypercube is a shuffled ladder for each parameter: one of each from its own stream is one of all.
        seed, names = self.description.first_seed, self.description.drawn
        ladders = [qmc.LatinHypercube(1, rng=stream(seed, f"campaign {n}")).random(self.runs) for n in names]
        return np.hstack(ladders)

    def _sobol(self, first: int, count: int) -> Array:
        sampler = qmc.Sobol(
            len(self.description.drawn), scramble=True, rng=stream(self.description.first_seed, "sobol")
        )
        if first:
            sampler.fast_forward(first)
        with warnings.catch_warnings():
            # A campaign may end at any flight; the report says what that costs.
            warnings.simplefilter("ignore", UserWarning)
            return sampler.random(count)
