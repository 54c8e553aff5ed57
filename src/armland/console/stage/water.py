"""The sea of the scene in the browser: a patch of water that moves as the waves which move the deck, see `view.film.water`."""

from typing import Any

import numpy as np
from viser import SceneApi

from armland.errors import ConfigurationError
from armland.plant.sea.waves import Waves, drawn_waves
from armland.rotations import Array
from armland.scenario import Scenario
from armland.view.film.water import FREEBOARD_M

HALF_M, CELLS = 14.0, 36
"""Half the edge of the patch, and points along the edge."""

EVERY_S = 0.1
"""Between two surfaces: waves that move a hull take seconds."""

COLOR, LINES = (52, 104, 134), (96, 146, 172)


class Water:
    """The water below a deck; flat where nobody knows the waves: the deck's motion is recorded, a platform's own, or unknown.

    Args:
        api: of the server.
        name: of the node below which it stands.
        scenario: that is flown.
    """

    def __init__(self, api: SceneApi, name: str, scenario: Scenario | None) -> None:
        self.flow(scenario)
        self._base = np.zeros(3) if scenario is None else np.array(scenario.sea.base_m)
        self._at = np.linspace(-HALF_M, HALF_M, CELLS)
        x, y = np.meshgrid(self._at, self._at, indexing="ij")
        self._points = np.stack([x, y, np.full_like(x, -self._base[2] - FREEBOARD_M)], axis=2)
        # Slopes of a few degrees are seen by lines, hardly by light.
        self._meshes: list[Any] = [
            api.add_mesh_simple(
                f"{name}/sea{end}",
                self._vertices(0.0, 1.0),
                _triangles(),
                color=color,
                wireframe=end != "",
                side="double",
                flat_shading=end == "",
                cast_shadow=False,
                receive_shadow=False,
            )
            for end, color in (("", COLOR), ("_lines", LINES))
        ]

    def flow(self, scenario: Scenario | None) -> None:
        """Have the waves of another flight from the next `show` on, at the same sea level."""
        self._waves = None if scenario is None else _waves(scenario)
        self._shown = (-np.inf, 1.0)

    def show(self, time: float, share: float) -> None:
        """Be as at a time, s, with a share of the waves' height."""
        before, of = self._shown
        if self._waves is not None and (abs(time - before) >= EVERY_S or share != of):
            self._shown = time, share
            vertices = self._vertices(time, share)
            for mesh in self._meshes:
                mesh.vertices = vertices

    def _vertices(self, time: float, share: float) -> Array:
        points = self._points.copy()
        if self._waves is not None:
            points[..., 2] += share * self._waves.elevation(time, self._at + self._base[0], self._at + self._base[1])
        return points.reshape(-1, 3).astype(np.float32)


def _waves(scenario: Scenario) -> Waves | None:
    if not scenario.sea.waves or scenario.sea.trace is not None:
        return None
    try:
        return drawn_waves(scenario)
    except ConfigurationError:
        # A recorded flight whose tables of the sea are no longer there.
        return None


def _triangles() -> np.ndarray:
    # Two for each cell between points that are numbered row by row.
    first = (np.arange(CELLS - 1)[:, None] * CELLS + np.arange(CELLS - 1)).ravel()
    lower = np.stack([first, first + CELLS, first + 1], axis=1)
    upper = np.stack([first + 1, first + CELLS, first + CELLS + 1], axis=1)
    return np.vstack([lower, upper]).astype(np.uint32)
