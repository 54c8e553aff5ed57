"""The study `sensors`: which hardware helps a landing at sea, better and worse than what the scenario has."""

from typing import Any

from armland.experiments.study.table import Change, Study, Values
from armland.models.parameters import arm_file
from armland.scenario import Scenario

CAMERA, UAV, MAGNET, ARM, DECK = "camera", "the UAV", "magnet and plate", "the arm", "the deck"

WIDE = {
    "plate.radius_m": 0.030,
    # Its pads are covered up to 15 mm beside the middle, of which as large a share is used as of the usual 7 mm.
    "bounds.align_offset_m": 0.008,
    "bounds.lost_offset_m": 0.012,
    "bounds.slipped_m": 0.018,
    "limits.slip_m": 0.018,
}
"""A plate of 88 g, and the thresholds that make use of it."""


def _joints(factor: float, **further: float) -> Any:
    def values(scenario: Scenario) -> Values:
        speeds = [factor * row.speed.number for row in arm_file(scenario).rows]
        return {"arm.joint_speed_rad_s": speeds, **{f"control.approach.{name}": v for name, v in further.items()}}

    return values


def _thrust(factor: float) -> Any:
    def values(scenario: Scenario) -> Values:
        most, hover = scenario.rotors.max_thrust_n, scenario.onboard.hover.thrust_max_n
        return {"rotors.max_thrust_n": factor * most, "onboard.hover.thrust_max_n": factor * hover}

    return values


SENSORS = Study(
    "sensors",
    "Which hardware helps a landing at sea",
    "as it is",
    False,
    (
        Change("camera 15 Hz", CAMERA, "images a second", {"camera.rate_hz": 15}),
        Change("camera 60 Hz", CAMERA, "images a second", {"camera.rate_hz": 60}),
        Change("camera 120 Hz", CAMERA, "images a second", {"camera.rate_hz": 120}),
        Change("camera late", CAMERA, "100 to 150 ms from exposure to arrival", {"camera.delay_ms": [100.0, 150.0]}),
        Change("camera prompt", CAMERA, "10 to 15 ms from exposure to arrival", {"camera.delay_ms": [10.0, 15.0]}),
        Change("120 Hz and prompt", CAMERA, "both", {"camera.rate_hz": 120, "camera.delay_ms": [10.0, 15.0]}),
        Change("no accelerometer", UAV, "the UAV does not send it", {"estimation.plate.accelerometer": False}),
        Change("rotors +20 %", UAV, "largest thrust", _thrust(1.2)),
        Change("half a magnet", MAGNET, "half of the pull", {"magnet.rating_n": 88.5}),
        Change("twice a magnet", MAGNET, "twice the pull", {"magnet.rating_n": 354.0}),
        Change("plate 30 mm", MAGNET, "radius, of 22 mm; 88 g; caught from 8 mm beside", WIDE),
        Change("joints x 0.5", ARM, "rated speed", _joints(0.5)),
        Change("joints x 1.5", ARM, "rated speed; follows at up to 0.6 m/s", _joints(1.5, track_max_mps=0.6)),
        Change("motion late", DECK, "motion reference 50 ms late", {"motion_reference.delay_ms": 50.0}),
    ),
)
"""One thing exchanged at a time."""
