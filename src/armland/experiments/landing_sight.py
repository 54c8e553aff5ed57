"""What share of the marker the camera sees at every exposure of a landing, from the first image to the capture."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import mujoco

from armland.experiments.landing import run
from armland.mission.landing_scenario import LandingScenario
from armland.mission.landing_setup import set_up
from armland.plant.landing import LandingPlant
from armland.plant.landing_pictures import Photo
from armland.plant.landing_scene import LandingGear, build_landing_scene
from armland.plant.sight import Sight, marker_pose, sight
from armland.rotations import Array

HELD_FROM = "hand_over"
"""Phase from which the arm holds the UAV and needs no camera."""

BANDS_M = (0.0, 0.14, 0.17, 0.25, 0.35, 0.45, 0.7)
"""Bounds of the distances in `by_distance`."""


class Glance(NamedTuple):
    """One exposure."""

    phase: str
    sight: Sight


class Band(NamedTuple):
    """All exposures between two distances."""

    near_m: float
    far_m: float
    exposures: int
    least_seen: float
    least_in_picture: float
    hidden_by: tuple[str, ...]


def landing_sight(scenario: LandingScenario, gear: LandingGear | None = None) -> list[Glance]:
    """Fly a landing and look at each exposure until the arm holds the UAV.

    Args:
        scenario: of `landing_scenario`.
        gear: skids and plate in whose scene the same flight is looked at; the landing's own if absent.
    """
    setup = set_up(scenario)
    exposures: list[tuple[str, Array]] = []
    phase = ""

    def look(qpos: Array, qvel: Array) -> Photo:
        exposures.append((phase, qpos.copy()))
        data.qpos[:] = qpos
        mujoco.mj_kinematics(plant.scene.model, data)
        mujoco.mj_camlight(plant.scene.model, data)
        return marker_pose(plant.scene.model, data)

    def entered(name: str, _: float) -> None:
        nonlocal phase
        phase = name

    plant = LandingPlant(scenario, setup.home, photographer=look)
    data = mujoco.MjData(plant.scene.model)
    run(setup, plant, entered)
    names = [name for name, _ in exposures]
    last = names.index(HELD_FROM) if HELD_FROM in names else len(names)
    return glances(exposures[:last], plant.scene.model if gear is None else _model(scenario, gear))


def glances(exposures: Sequence[tuple[str, Array]], model: mujoco.MjModel) -> list[Glance]:
    """What the camera of `model` sees at each (phase, qpos)."""
    data, seen = mujoco.MjData(model), []
    for phase, qpos in exposures:
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_camlight(model, data)
        seen.append(Glance(phase, sight(model, data)))
    return seen


def by_distance(seen: Sequence[Glance]) -> list[Band]:
    """The least share that was seen at each distance, near to far; distances that did not occur are left out."""
    table = []
    for near, far in pairwise(BANDS_M):
        here = [g.sight for g in seen if near <= g.sight.depth < far]
        if here:
            hidden = sorted({name for s in here for name in s.hidden_by})
            least = min(s.seen for s in here), min(s.in_picture for s in here)
            table.append(Band(near, far, len(here), *least, tuple(hidden)))
    return table


def _model(scenario: LandingScenario, gear: LandingGear) -> mujoco.MjModel:
    return build_landing_scene(scenario.demonstrator, gear._replace(eye=scenario.landing.eye)).model
