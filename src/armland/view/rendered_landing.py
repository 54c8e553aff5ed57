"""A landing that sees by rendered pictures: the real detector in the loop from the start to the hand-over."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.landing import run
from armland.experiments.landing_judge import Judgement, judge_landing
from armland.mission.landing_scenario import LandingScenario
from armland.mission.landing_setup import set_up
from armland.plant.landing import LandingPlant
from armland.view.marker_imaging import Calibration, Imaging
from armland.view.marker_scene import build_marker_scene
from armland.view.rendered_eye import RenderedEye, Shot

CLOSED_FROM = "hand_over"
"""Phase from which no pictures are taken: the arm holds the UAV and needs none."""


class Flight(NamedTuple):
    """What came of it."""

    judgement: Judgement
    shots: list[Shot]
    phases: list[tuple[str, float, int]]  # phase, its begin in s, pictures taken until then
    records: NDArray[np.void]


def fly_rendered(
    scenario: LandingScenario,
    imaging: Imaging | None = None,
    calibration: Calibration | None = None,
) -> Flight:
    """Fly a landing with rendered pictures in place of the camera's measurement model.

    Args:
        scenario: of `landing_scenario`; its seed also draws calibration, light and noise.
        imaging: imperfections of the pictures.
        calibration: what is wrong with what the camera knows of itself.

    Raises:
        PictureError: no OpenGL that works.
        ArmlandError: no OpenCV, or a scenario that is refused.
    """
    setup = set_up(scenario)
    scene = build_marker_scene(scenario, home=setup.home)
    phases: list[tuple[str, float, int]] = []
    with RenderedEye(scene, scenario.landing.seed, imaging, calibration) as eye:
        plant = LandingPlant(scenario, setup.home, photographer=eye)

        def progress(phase: str, t: float) -> None:
            phases.append((phase, t, len(eye.shots)))
            eye.closed = eye.closed or phase == CLOSED_FROM

        records, _ = run(setup, plant, progress)
    judgement = judge_landing(records, setup, plant.scene.put_down, scenario.demonstrator.run.rate_hz)
    return Flight(judgement, eye.shots, phases, records)
