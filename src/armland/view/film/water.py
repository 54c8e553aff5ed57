"""The sea of a film: a hull that carries the deck, and water around it that moves as the waves which move the hull.

Where the deck's motion is recorded or a platform's own, nobody knows the waves; the water is flat then.
"""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.plant.scene.deck import DECK
from armland.plant.sea.waves import BEAM, Waves, drawn_waves
from armland.rotations import Array
from armland.scenario import Scenario

HALF_M, CELLS = 45.0, 100
"""Half the edge of the square of water that is drawn, and points along the edge."""

FREEBOARD_M = 0.45
"""Of the deck above the water at rest."""

REACH_M = 1.15
"""From the arm's base to the deck's edge at least: what stands there stands on the deck."""

MIST = (0.87, 0.91, 0.94)
"""Colour into which sea and sky go at the horizon."""

DEEP, SHALLOW = np.array([34.0, 78.0, 100.0]), np.array([74.0, 126.0, 146.0])
"""Colours between which the ripples of the water lie, of 255."""

HULL, EDGE = (0.15, 0.19, 0.25, 1.0), (0.93, 0.94, 0.95, 1.0)

TILE, TILES = 256, 30
"""Pixels of the ripples' texture, and how often it repeats along the water's edge."""


class Water(NamedTuple):
    """What the water does."""

    waves: Waves | None
    base: Array  # (3,) m, of the arm from the point whose motion is stated
    half: float  # m, the largest elevation that is drawn

    def surface(self, t: float) -> NDArray[np.float32]:
        """Heights (CELLS · CELLS,) of the height field at the time `t`, s, each between 0 and 1."""
        if self.waves is None:
            return np.full(CELLS * CELLS, 0.5, np.float32)
        at = np.linspace(-HALF_M, HALF_M, CELLS)
        # Rows of a height field lie along y.
        height = self.waves.elevation(t, at + self.base[0], at + self.base[1]).T
        return np.clip(0.5 + 0.5 * height / self.half, 0.0, 1.0).astype(np.float32).ravel()


def add_water(spec: mujoco.MjSpec, scenario: Scenario) -> Water:
    """Put a hull below the deck in place of the floor, and water around it."""
    sea = scenario.sea
    waves = drawn_waves(scenario) if sea.waves and sea.trace is None else None
    half = 1.5 * sea.height_period[0] if waves is not None else 0.1
    cells = {"nrow": CELLS, "ncol": CELLS, "userdata": np.full(CELLS * CELLS, 0.5, np.float32)}
    spec.add_hfield(name="water", size=[HALF_M, HALF_M, 2.0 * half, 0.1], **cells)
    texture = spec.add_texture(name="water", type=mujoco.mjtTexture.mjTEXTURE_2D, width=TILE, height=TILE, nchannel=3)
    texture.data = ripples().tobytes()
    material = spec.add_material(name="water", texrepeat=[TILES, TILES], specular=0.4, shininess=0.5)
    material.textures[int(mujoco.mjtTextureRole.mjTEXROLE_RGB)] = "water"
    base = np.array(sea.base_m)
    place = [0.0, 0.0, -base[2] - half - FREEBOARD_M]
    spec.worldbody.add_geom(
        name="water",
        type=mujoco.mjtGeom.mjGEOM_HFIELD,
        hfieldname="water",
        material="water",
        pos=place,
        contype=0,
        conaffinity=0,
        group=2,
    )
    _add_hull(spec, scenario, base)
    visual = spec.visual
    visual.rgba.fog = visual.rgba.haze = [*MIST, 1.0]
    for texture in spec.textures:
        if texture.name == "sky":
            texture.rgb1, texture.rgb2 = [0.55, 0.7, 0.85], MIST
    return Water(waves, base, half)


def ripples() -> NDArray[np.uint8]:
    """A texture (TILE, TILE, 3) whose edges fit each other: small waves, mostly across one direction; always the same."""
    noise = np.fft.fft2(np.random.default_rng(1).standard_normal((TILE, TILE)))
    across, along = np.meshgrid(*2 * [np.fft.fftfreq(TILE, 1.0 / TILE)])
    number = np.hypot(2.0 * across, along)
    height = np.real(np.fft.ifft2(noise * number * np.exp(-((number / 16.0) ** 2))))
    share = np.clip(0.4 + 0.22 * height / height.std(), 0.0, 1.0)[..., None]
    return np.rint(DEEP + share * (SHALLOW - DEEP)).astype(np.uint8)


def _add_hull(spec: mujoco.MjSpec, scenario: Scenario, base: Array) -> None:
    sea = scenario.sea
    beam = BEAM * sea.hull_m if sea.beam_m is None else sea.beam_m
    x, y = max(0.5 * sea.hull_m, REACH_M + abs(base[0])), max(0.5 * beam, 0.6 * REACH_M + abs(base[1]))
    deck = next(b for b in spec.bodies if b.name == DECK)
    middle, flat = [-base[0], -base[1]], {"type": mujoco.mjtGeom.mjGEOM_BOX, "mass": 0, "group": 2}
    free = {"contype": 0, "conaffinity": 0}
    floor = next(g for g in spec.geoms if g.name == "floor")
    floor.size, floor.pos = [x, y, 0.02], [*middle, -0.02]
    deck.add_geom(name="hull", pos=[*middle, -0.56], size=[0.985 * x, 0.97 * y, 0.515], rgba=HULL, **flat, **free)
    deck.add_geom(name="edge", pos=[*middle, -0.035], size=[x + 0.03, y + 0.03, 0.03], rgba=EDGE, **flat, **free)
