"""A landing that sees by rendered pictures: the real detector in the loop from the start to the hand-over."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.landing import run
from armland.experiments.landing_judge import Judgement, judge_landing
from armland.mission.landing_scenario import LandingScenario
from armland.mission.landing_setup import set_up
from armland.plant.landing import LandingPlant
from armland.view.marker_figures import draw_contact_sheet
from armland.view.marker_imaging import Calibration, Imaging
from armland.view.marker_scene import MarkerScene, build_marker_scene
from armland.view.rendered_eye import RenderedEye, Shot

CLOSED_FROM = "hand_over"
"""Phase from which no pictures are taken: the arm holds the UAV and needs none."""


class Flight(NamedTuple):
    """What came of it."""

    scene: MarkerScene
    judgement: Judgement
    shots: list[Shot]
    phases: list[tuple[str, float, int]]  # phase, its begin in s, pictures taken until then
    records: NDArray[np.void]


def fly_rendered(
    scenario: LandingScenario,
    imaging: Imaging | None = None,
    calibration: Calibration | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> Flight:
    """Fly a landing with rendered pictures in place of the camera's measurement model.

    Args:
        scenario: of `landing_scenario`; its seed also draws calibration, light and noise.
        imaging: imperfections of the pictures.
        calibration: what is wrong with what the camera knows of itself.
        progress: called with phase and time, s, when a phase begins.

    Raises:
        PictureError: no OpenGL that works.
        ArmlandError: no OpenCV, or a scenario that is refused.
    """
    setup = set_up(scenario)
    scene = build_marker_scene(scenario, home=setup.home)
    phases: list[tuple[str, float, int]] = []
    with RenderedEye(scene, scenario.landing.seed, imaging, calibration) as eye:
        plant = LandingPlant(scenario, setup.home, photographer=eye)

        def entered(phase: str, t: float) -> None:
            phases.append((phase, t, len(eye.shots)))
            eye.closed = eye.closed or phase == CLOSED_FROM
            if progress is not None:
                progress(phase, t)

        records, _ = run(setup, plant, entered)
    judgement = judge_landing(records, setup, plant.scene.put_down, scenario.demonstrator.run.rate_hz)
    return Flight(scene, judgement, eye.shots, phases, records)


def summary(flight: Flight) -> dict[str, Any]:
    """The outcome as plain data; errors are root mean squares of each axis over all pictures in which the marker was found."""
    found = [s for s in flight.shots if s.found is not None]
    position, rotation = (np.array([s.error[i] for s in found]).reshape(-1, 3) for i in (0, 1))
    j = flight.judgement
    return {
        "success": j.success,
        "reason": j.reason,
        "retries": j.retries,
        "capture": j.capture,
        "touchdown": j.touchdown,
        "pictures": len(flight.shots),
        "found": len(found),
        "lateral_mm": _rms(1e3 * position[:, :2]),
        "depth_mm": _rms(1e3 * position[:, 2]),
        "tilt_deg": _rms(np.degrees(rotation[:, :2])),
        "yaw_deg": _rms(np.degrees(rotation[:, 2])),
    }


def draw_flight(out: Path, flight: Flight) -> list[Path]:
    """Write the contact sheet of a flight's pictures, `fig_marker_sheet`, into the folder `out`."""
    starts = np.array([taken for _, _, taken in flight.phases])
    names = [name for name, _, _ in flight.phases]
    # The first picture is taken before the mission knows its phase.
    titles = [names[max(int(np.searchsorted(starts, i, side="right")) - 1, 0)] for i in range(len(flight.shots))]
    return draw_contact_sheet(out, flight.shots, flight.scene, titles)


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else float("nan")
