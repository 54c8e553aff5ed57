"""The frames of a scene's bodies in the browser: each is told where it is when it has moved, since a message costs the page time."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from armland.console.page.often import put_place, put_turn
from armland.rotations import Array

STILL = 1e-5
"""Change of a place, m, and of a quaternion's numbers, 1, that nobody sees."""


class Frames:
    """Frames by the number of their body."""

    def __init__(self) -> None:
        self._nodes: dict[int, Any] = {}
        self._told = np.zeros((0, 7))

    def __contains__(self, body: int) -> bool:
        return body in self._nodes

    def __iter__(self) -> Iterator[int]:
        return iter(self._nodes)

    def __getitem__(self, body: int) -> Any:
        return self._nodes[body]

    def add(self, body: int, node: Any) -> None:
        """Add the frame of a body."""
        self._nodes[body] = node
        self._told = np.vstack([self._told, np.full((1, 7), np.inf)])

    def show(self, places: Array, turns: Array) -> None:
        """Stand where the bodies are.

        Args:
            places: (nbody, 3) m, W.
            turns: (nbody, 4), scalar first, W<-body.
        """
        bodies = list(self._nodes)
        now = np.hstack([places[bodies], turns[bodies]])
        moved = np.abs(now - self._told) >= STILL
        nodes = list(self._nodes.values())
        for k in np.flatnonzero(moved[:, :3].any(axis=1)):
            put_place(nodes[k], now[k, :3])
            self._told[k, :3] = now[k, :3]
        for k in np.flatnonzero(moved[:, 3:].any(axis=1)):
            put_turn(nodes[k], now[k, 3:])
            self._told[k, 3:] = now[k, 3:]
