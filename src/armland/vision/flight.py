"""A landing that sees by rendered pictures: the real detector in the loop from the start to the hand-over."""

from collections.abc import Callable
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.experiments.episode import Episode, fly_prepared, prepare
from armland.plant.noise import stream
from armland.plant.pictures import Photo
from armland.plant.sight import marker_pose
from armland.plant.simulator import Simulator
from armland.rotations import Array, matrix, rotation_error
from armland.scenario import Scenario
from armland.vision.fiducial import Detection, detect, relocated
from armland.vision.frames import FrameStream
from armland.vision.imaging import Calibration, Imaging, Motion, draw_unit, photographed
from armland.vision.scene import EYE, MarkerScene, build_marker_scene


class Shot(NamedTuple):
    """One picture of a landing."""

    image: NDArray[np.uint8]  # (h, w)
    motion: Motion  # truth
    found: Detection | None

    @property
    def error(self) -> tuple[Array, Array]:
        """Position (3,), m, and rotation vector (3,), rad, found minus true, camera frame; NaN where nothing was found."""
        if self.found is None:
            return np.full(3, np.nan), np.full(3, np.nan)
        turn = rotation_error(matrix(self.motion.quat), matrix(self.found.quat))
        return self.found.position - self.motion.position, turn


class RenderedEye:
    """A photographer for `armland.plant.simulator.Simulator`, with one camera's calibration. Use it in a `with` statement.

    Args:
        scene: with the arm where the landing begins.
        seed: of calibration, light and noise.
        imaging: imperfections of its pictures.

    Raises:
        PictureError: no OpenGL that works, on entry.
    """

    def __init__(self, scene: MarkerScene, seed: int = 0, imaging: Imaging | None = None) -> None:
        self.scene, self.shots, self.closed = scene, list[Shot](), False
        self._imaging, self._rng = imaging or Imaging(), stream(seed, "rendered eye")
        self._unit = draw_unit(scene.intrinsics, Calibration(), self._rng)
        self._frames = FrameStream(scene.model, scene.width, scene.height, EYE)
        self._data = mujoco.MjData(scene.model)

    def __enter__(self) -> "RenderedEye":
        self._frames.__enter__()
        return self

    def __exit__(self, *error: object) -> None:
        self._frames.__exit__(*error)

    def __call__(self, qpos: Array, qvel: Array) -> Photo:
        """Take a picture one step before the state and find the marker in it; once `closed`, nothing is seen any more."""
        if self.closed:
            return None
        motion, then = self._motion(qpos, qvel)
        s = self.scene
        picture = self._frames.draw(then)
        image = photographed(picture, s.intrinsics, motion, self._imaging, self._rng, self._unit.k1)
        seen = detect(image, s.size_m, s.intrinsics)
        found = relocated(seen[0], s.size_m, self._unit.believed) if seen else None
        self.shots.append(Shot(image, motion, found))
        return None if found is None else (found.position, found.quat)

    def _motion(self, qpos: Array, qvel: Array) -> tuple[Motion, Array]:
        # Sensors sample as a step begins: the state is a step further than the exposure's middle.
        model, data, step = self.scene.model, self._data, self.scene.model.opt.timestep
        poses, then = [], np.zeros(0)
        for back in (step, 0.0):
            data.qpos[:] = qpos
            mujoco.mj_integratePos(model, data.qpos, qvel, -back)
            if back:
                then = data.qpos.copy()
            mujoco.mj_kinematics(model, data)
            mujoco.mj_camlight(model, data)
            poses.append(marker_pose(model, data))
        (before, q_before), (after, q_after) = poses
        turn = rotation_error(matrix(q_before), matrix(q_after))
        return Motion(before, q_before, (after - before) / step, turn / step), then


CLOSED_FROM = "hand_over"  # Phase from which no pictures are taken: the arm holds the UAV and needs none


class Flight(NamedTuple):
    """What came of it."""

    scene: MarkerScene
    episode: Episode
    shots: list[Shot]
    phases: list[tuple[str, float, int]]  # phase, its begin in s, pictures taken until then


def fly_rendered(
    scenario: Scenario, imaging: Imaging | None = None, progress: Callable[[str, float], None] | None = None
) -> Flight:
    """Fly a landing with rendered pictures in place of the camera's measurement model.

    Args:
        scenario: its seed also draws calibration, light and noise.
        imaging: imperfections of the pictures.
        progress: called with phase and time, s, when a phase begins.

    Raises:
        PictureError: no OpenGL that works.
        ArmlandError: no OpenCV, or a scenario that is refused.
    """
    flight = prepare(scenario, "landing")
    scene = build_marker_scene(scenario, home=flight.plan.home)
    phases: list[tuple[str, float, int]] = []
    with RenderedEye(scene, scenario.run.seed, imaging) as eye:

        def entered(phase: str, t: float) -> None:
            phases.append((phase, t, len(eye.shots)))
            eye.closed = eye.closed or phase == CLOSED_FROM
            if progress is not None:
                progress(phase, t)

        seeing = Simulator(scenario, flight.plan.home, "air", flight.plan.names, photographer=eye)
        episode = fly_prepared(flight._replace(simulator=seeing), progress=entered)
    return Flight(scene, episode, eye.shots, phases)


def summary(flight: Flight) -> dict[str, Any]:
    """The outcome as plain data; errors are root mean squares of each axis over all pictures in which the marker was found."""
    found = [s for s in flight.shots if s.found is not None]
    position, rotation = (np.array([s.error[i] for s in found]).reshape(-1, 3) for i in (0, 1))
    names = ("success", "reason", "retries", "capture", "touchdown")
    return {
        **{name: flight.episode.result[name] for name in names},
        "pictures": len(flight.shots),
        "found": len(found),
        "lateral_mm": _rms(1e3 * position[:, :2]),
        "depth_mm": _rms(1e3 * position[:, 2]),
        "tilt_deg": _rms(np.degrees(rotation[:, :2])),
        "yaw_deg": _rms(np.degrees(rotation[:, 2])),
    }


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else float("nan")
