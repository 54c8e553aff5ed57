"""What share of the marker the camera sees at every exposure of a recorded landing, from the first image to the capture."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import mujoco
import numpy as np

from armland.experiments.episode import fly
from armland.experiments.judge.brief import Ticks
from armland.plant.scene.composition import Scene, build_scene
from armland.plant.sight import Sight, sight
from armland.records import Record
from armland.rotations import Array, matrix
from armland.scenario import Scenario

HELD_FROM = "hand_over"  # Phase from which the arm holds the UAV and needs no camera
BANDS_M = (0.0, 0.14, 0.17, 0.25, 0.35, 0.45, 0.7)  # Bounds of the distances in `by_distance`


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


def landing_sight(scenario: Scenario) -> list[Glance]:
    """Fly a landing and look at each exposure until the arm holds the UAV; errors as for `episode.fly`."""
    episode = fly(scenario, "landing")
    return glances(episode.ticks, tuple(episode.metadata["phases"].split(",")), scenario)


def glances(ticks: Ticks, phases: tuple[str, ...], scenario: Scenario) -> list[Glance]:
    """What the camera of `scenario` sees at each exposure of recorded `ticks` whose phases have the names `phases`.

    The scenario may have another gear than the one that was flown: then it is the same motion that is looked at.
    """
    scene = build_scene(scenario, "free")
    data, seen = mujoco.MjData(scene.model), []
    phase, truth = ticks["mission"]["phase"], ticks["truth"]
    held: Any = np.flatnonzero(phase == phases.index(HELD_FROM)) if HELD_FROM in phases else []
    rate, base = scenario.camera.rate_hz, scenario.run.rate_hz
    for k in range(int(held[0]) if len(held) else len(phase)):
        if (k * rate) % base < rate:
            put(scene, data, truth[k])
            seen.append(Glance(phases[int(phase[k])], sight(scene.model, data)))
    return seen


def put(scene: Scene, data: mujoco.MjData, truth: Record) -> None:
    """Put arm, UAV and hinge plate of a scene where a recorded `truth` has them."""
    data.qpos[scene.joint_qpos] = truth["q"]
    data.qpos[scene.uav_qpos[:3]], data.qpos[scene.uav_qpos[3:]] = truth["r_cm"], truth["quat"]
    body, plate = matrix(truth["quat"].copy()), matrix(truth["plate_quat"].copy())
    data.qpos[scene.hinge_qpos] = hinge_angles(body.T @ plate)
    mujoco.mj_kinematics(scene.model, data)
    mujoco.mj_camlight(scene.model, data)


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


def hinge_angles(R: Array) -> Array:
    """The hinge's angles (3,) rad of the plate's attitude R (3, 3) in the body's, R = Ry Rx Rz: about y, x, then the swivel."""
    return np.array([np.arctan2(R[0, 2], R[2, 2]), -np.arcsin(R[1, 2]), np.arctan2(R[1, 0], R[1, 1])])
