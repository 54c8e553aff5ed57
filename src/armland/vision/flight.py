"""A landing that sees by rendered pictures: the real detector in the loop from the start to the hand-over."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.episode import Episode, fly_prepared, prepare
from armland.plant.simulator import Simulator
from armland.scenario import Scenario
from armland.vision.eye import RenderedEye, Shot
from armland.vision.imaging import Calibration, Imaging
from armland.vision.scene import MarkerScene, build_marker_scene

CLOSED_FROM = "hand_over"
"""Phase from which no pictures are taken: the arm holds the UAV and needs none."""


class Flight(NamedTuple):
    """What came of it."""

    scene: MarkerScene
    episode: Episode
    shots: list[Shot]
    phases: list[tuple[str, float, int]]  # phase, its begin in s, pictures taken until then


def fly_rendered(
    scenario: Scenario,
    imaging: Imaging | None = None,
    calibration: Calibration | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> Flight:
    """Fly a landing with rendered pictures in place of the camera's measurement model.

    Args:
        scenario: its seed also draws calibration, light and noise.
        imaging: imperfections of the pictures.
        calibration: what is wrong with what the camera knows of itself.
        progress: called with phase and time, s, when a phase begins.

    Raises:
        PictureError: no OpenGL that works.
        ArmlandError: no OpenCV, or a scenario that is refused.
    """
    flight = prepare(scenario, "landing")
    scene = build_marker_scene(scenario, home=flight.plan.home)
    phases: list[tuple[str, float, int]] = []
    with RenderedEye(scene, scenario.run.seed, imaging, calibration) as eye:

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
