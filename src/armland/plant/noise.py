"""Named random streams: each derives from (seed, name), so that one more sensor does not move the others' noise."""

import zlib

import numpy as np
from numpy.typing import NDArray

BLOCK = 1000
"""Ticks drawn at once."""


def stream(seed: int, name: str) -> np.random.Generator:
    """The random stream `name` of a run with `seed`."""
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, zlib.crc32(name.encode())])))


class WhiteNoise:
    """Standard normal numbers, a row of `width` each tick, drawn block by block into `rows` (BLOCK, width)."""

    def __init__(self, seed: int, name: str, width: int) -> None:
        self._generator = stream(seed, name)
        self.rows: NDArray[np.float64] = np.zeros((BLOCK, width))

    def draw(self) -> None:
        """Replace the block."""
        self._generator.standard_normal(out=self.rows)
