"""Named random streams: each derives from (seed, name), so that one more sensor does not move the others' noise."""

import math
import zlib
from collections.abc import Collection
from typing import NamedTuple

import numpy as np
from numba import njit

from armland.rotations import Array

BLOCK = 1000
"""Ticks drawn at once."""

CAMERA_WIDTH = 12
"""Numbers of the camera's stream: position 3, rotation 3, delay, drop-out, outlier, the outlier's displacement 3."""


class Noise(NamedTuple):
    """Standard normal numbers of all devices, arrays (BLOCK, width); tick k uses row k % BLOCK. The last two arrays are not drawn."""

    encoders: Array
    """(BLOCK, 2n): positions, then velocities."""
    wrench: Array
    """(BLOCK, 6)."""
    imu: Array
    """(BLOCK, 6): attitude, rates."""
    hover: Array
    """(BLOCK, 3): the position that the UAV believes."""
    camera: Array
    """(BLOCK, CAMERA_WIDTH)."""
    link: Array
    """(BLOCK, 4): loss and lateness upwards, loss and lateness downwards."""
    speed: Array
    """(BLOCK, 3): the velocity that the UAV believes."""
    motors: Array
    """(BLOCK, n): torques."""
    air: Array
    """(BLOCK, 3): gusts."""
    flip: Array
    """(BLOCK, 1): whether the camera takes the second solution of a pose."""
    turbulence: Array
    """(BLOCK, 5): along the mean wind 1, across it 2, upwards 2."""
    reference: Array
    """(BLOCK, 12): attitude, rates, velocity, acceleration of the deck."""
    force: Array
    """(BLOCK, 3): specific force that the UAV reads."""
    wind: Array
    """(BLOCK, 3) m/s, W: what `wind.timed` knows of these ticks."""
    deck: Array
    """(BLOCK, 18) m, rad, per s and s²: what `sea.timed` knows of them."""


def stream(seed: int, name: str) -> np.random.Generator:
    """The random stream `name` of a run with `seed`."""
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, zlib.crc32(name.encode())])))


class NoiseSource:
    """The devices' streams and the block that was drawn of them last.

    Args:
        seed: of the run.
        joints: of the arm.
        absent: streams of devices that the scene lacks: they stay at zero, and cost nothing.
    """

    def __init__(self, seed: int, joints: int, absent: Collection[str] = ()) -> None:
        widths = (2 * joints, 6, 6, 3, CAMERA_WIDTH, 4, 3, joints, 3, 1, 5, 12, 3, 3, 18)
        self._seed, self._names = seed, [name for name in Noise._fields[:-2] if name not in absent]
        self.rows = Noise(*(np.zeros((BLOCK, width)) for width in widths))
        self.generators: tuple[np.random.Generator, ...] = ()
        self.restart()

    def restart(self) -> None:
        """Put all streams to their begin; the block stays as it is until `draw`."""
        self.generators = tuple(stream(self._seed, name) for name in self._names)

    def draw(self) -> None:
        """Replace the block, in place."""
        for name, generator in zip(self._names, self.generators, strict=True):
            generator.standard_normal(out=getattr(self.rows, name))


@njit(cache=True)
def uniform(normal: float) -> float:
    """A standard normal number as one uniform in [0, 1): the streams are normal."""
    return min(0.5 * math.erfc(-normal / math.sqrt(2.0)), 1.0 - 1e-12)
