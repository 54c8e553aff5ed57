"""The scene in the browser: meshes hung on the frames of their bodies, and the arrows and lines that no body has.

| drawn | from |
|---|---|
| arm, tool, UAV, plate, cradle | the scene's shapes, at the poses of the tick |
| arrow at the pivot | `truth.hinge_force`; one weight of the UAV is `WEIGHT_M` long |
| arrow above the UAV | wind, `WIND_M` for 1 m/s |
| pyramid at the tool | what the camera may see; green where the plate's pose is known, else vermilion |
| disc on the magnet | the capture envelope: how far aside the plate may be |
| line | where the end effector is to go; what it did stays as a pale trail |
| floor, sea | the deck that arm and cradle stand on; water that moves as the waves which move the deck |
"""

from typing import Any

import numpy as np
import trimesh
from viser import SceneApi

from armland.console.page.often import put_place, put_turn
from armland.console.stage.frames import Frames
from armland.console.stage.poses import Poses, forces_from, to_world
from armland.console.stage.shapes import Mesh, look_of, meshes_of
from armland.console.stage.sight import Sight
from armland.console.stage.water import Water
from armland.plant.scene.composition import Scene
from armland.plant.scene.deck import DECK
from armland.plant.scene.eye import CAMERA
from armland.records import Records
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.sensing import Camera

WEIGHT_M, WIND_M = 0.25, 0.08
"""Lengths of the arrows, m."""

SHORTEST_M = 0.04
"""Length of an arrow that is worth to be seen, m."""

SEEN, LOST = (0, 158, 115), (213, 94, 0)
FORCE, WIND, PATH = (213, 94, 0), (86, 180, 233), (0, 114, 178)
"""Colours of Okabe and Ito, which colour-blind readers tell apart."""

GHOST = (160, 90, 200)
"""Colour of a second flight in the same scene."""


class Stage:
    """One flight's scene in a browser.

    Args:
        api: of the server.
        scene: whose shapes are drawn.
        name: of the node below which it stands; a second flight has another.
        weight: of all that flies, N, the unit of the force's arrow.
        scenario: that is flown; without it there is no camera, and the water is flat.
        envelope: radius of the disc on the magnet, m; 0: none.
        ghost: whether it is a second flight, drawn pale in one colour.
        armless: whether the scene's arm is none that flew, see `Poses`.
    """

    def __init__(
        self,
        api: SceneApi,
        scene: Scene,
        name: str,
        weight: float,
        scenario: Scenario | None = None,
        envelope: float = 0.0,
        ghost: bool = False,
        armless: bool = False,
    ) -> None:
        self.poses, self._api, self._name, self._ghost = Poses(scene, armless), api, name, ghost
        self._weight, self._look = _unit(weight), _look(scene, scenario, envelope)
        self._root = api.add_frame(name, show_axes=False)
        self._frames = Frames()
        for number, mesh in enumerate(meshes_of(scene.model)):
            if mesh.body not in self.poses.absent:
                self._hang(number, mesh)
        self._water: Water | None = None
        if not ghost:
            self._lay_floor(scene, scenario)
        camera = None if scenario is None or ghost or scene.bond != "free" else scenario.camera
        self._sight = None if camera is None else Sight(self.poses, camera)
        self._force = self._arrow("force", FORCE)
        self._wind = self._arrow("wind", WIND)
        self._path = self._line("path", GHOST if ghost else PATH, 3.0)
        self._eye = None if camera is None else self._add_eye(camera)
        self._disc = self._add_disc(envelope) if envelope > 0.0 and scene.bond == "free" and not ghost else None

    def show(self, tick: Records, wind: Array | None = None) -> None:
        """Pose everything as in one tick, a record of `records.tick_layout`.

        Args:
            tick: whose truth is shown.
            wind: (3,) m/s, W; no arrow where nothing is known.

        Raises:
            LogError: it is of another arm.
        """
        truth = tick["truth"]
        self.poses.set(truth)
        self._frames.show(*self.poses.bodies)
        self._point(self._force, np.array(truth["r"]), forces_from(truth) * WEIGHT_M / self._weight)
        above = np.array(truth["r_cm"]) + [0.0, 0.0, 0.25]
        self._point(self._wind, above, np.zeros(3) if wind is None else WIND_M * wind)
        if self._eye is not None and (seen := self.poses.camera(CAMERA)) is not None:
            put_place(self._eye, seen[0])
            put_turn(self._eye, seen[1])
            color = SEEN if tick["estimate"]["plate_valid"] else LOST
            if self._eye.color != color:
                self._eye.color = color
        if self._disc is not None:
            put_place(self._disc, self.poses.end_effector)
            put_turn(self._disc, truth["ee_quat"])

    def wave(self, time: float, share: float = 1.0) -> None:
        """Let the water be as at a time, s, with a `share` of its height."""
        if self._water is not None:
            self._water.show(time, share)

    def sight(self, tick: Records, period_s: float) -> str:
        """What the camera sees, see `Sight.svg`, at the tick that was shown last; empty where there is no camera."""
        return "" if self._sight is None else self._sight.svg(tick, period_s)

    def draw_path(self, truth: Records, points: Array) -> None:
        """Draw the way through points (k, 3), m, D, as the deck of one tick's truth has them."""
        world = to_world(truth, points)
        world = world[np.isfinite(world).all(axis=1)]
        if len(world) > 1:
            self._path.points = np.stack([world[:-1], world[1:]], axis=1).astype(np.float32)
        self._path.visible = len(world) > 1

    def take(self, scene: Scene, weight: float, scenario: Scenario, envelope: float) -> bool:
        """Stand for another flight, so that no page needs its shapes anew; arguments as for a stage.

        Returns:
            Whether its scene looks the same. If not, nothing is changed.
        """
        if _look(scene, scenario, envelope) != self._look:
            return False
        self.poses, self._weight = Poses(scene), _unit(weight)
        if self._sight is not None:
            self._sight.poses = self.poses
        if self._water is not None:
            self._water.flow(scenario)
        return True

    def remove(self) -> None:
        """Take the flight out of the scene."""
        self._root.remove()

    def _hang(self, number: int, mesh: Mesh) -> None:
        frame = f"{self._name}/body_{mesh.body}"
        if mesh.body not in self._frames:
            self._frames.add(mesh.body, self._api.add_frame(frame, show_axes=False))
        opacity = 0.3 if self._ghost else mesh.opacity
        self._api.add_mesh_simple(
            f"{frame}/mesh_{number}",
            mesh.vertices.astype(np.float32),
            mesh.faces.astype(np.uint32),
            color=GHOST if self._ghost else mesh.color,
            opacity=None if opacity >= 1.0 else opacity,
            side="double",
            cast_shadow=not self._ghost and opacity >= 1.0,
        )

    def _lay_floor(self, scene: Scene, scenario: Scenario | None) -> None:
        under = self._name
        if scene.deck_qpos >= 0:
            deck = scene.model.body(DECK).id
            under = f"{self._name}/body_{deck}"
            if deck not in self._frames:
                self._frames.add(deck, self._api.add_frame(under, show_axes=False))
            self._water = Water(self._api, self._name, scenario)
        size = 3.0 if scene.deck_qpos >= 0 else 8.0
        self._api.add_grid(
            f"{under}/floor",
            size,
            size,
            cell_size=0.25,
            section_size=1.0,
            cell_color=(165, 170, 176),
            section_color=(125, 130, 138),
            plane_color=(150, 156, 164),
            plane_opacity=0.9 if scene.deck_qpos >= 0 else 0.0,
        )

    def _add_eye(self, camera: Camera) -> Any:
        width, height = np.deg2rad(camera.field_of_view_deg)
        return self._api.add_camera_frustum(
            f"{self._name}/eye",
            fov=float(height),
            aspect=float(np.tan(0.5 * width) / np.tan(0.5 * height)),
            scale=0.08,
            thickness=0.002,
            color=SEEN,
            cast_shadow=False,
        )

    def _add_disc(self, radius: float) -> Any:
        disc = trimesh.creation.cylinder(radius=radius, height=0.004, sections=36)
        return self._api.add_mesh_simple(
            f"{self._name}/envelope",
            np.asarray(disc.vertices, dtype=np.float32),
            np.asarray(disc.faces, dtype=np.uint32),
            color=SEEN,
            opacity=0.35,
            cast_shadow=False,
        )

    def _arrow(self, name: str, color: tuple[int, int, int]) -> Any:
        color = GHOST if self._ghost else color
        points = np.zeros((1, 2, 3), np.float32)
        sizes: Any = {"shaft_radius": 0.006, "head_radius": 0.016, "head_length": 0.035}
        return self._api.add_arrows(f"{self._name}/{name}", points, color, visible=False, **sizes)

    def _line(self, name: str, color: tuple[int, int, int], width: float) -> Any:
        points = np.zeros((1, 2, 3), np.float32)
        return self._api.add_line_segments(
            f"{self._name}/{name}", points, color, thickness=width, thickness_units="screen", visible=False
        )

    @staticmethod
    def _point(arrow: Any, start: Array, along: Array) -> None:
        seen = bool(np.linalg.norm(along) > SHORTEST_M and np.isfinite(start).all())
        if seen:
            arrow.points = np.stack([start, start + along])[None].astype(np.float32)
        if arrow.visible != seen:
            arrow.visible = seen


def _unit(weight: float) -> float:
    return weight if np.isfinite(weight) and weight > 0.0 else 10.0


def _look(scene: Scene, scenario: Scenario | None, envelope: float) -> tuple[Any, ...]:
    of = () if scenario is None else (scenario.camera, scenario.sea)
    return (look_of(scene.model), scene.bond, scene.deck_qpos >= 0, envelope, *of)
