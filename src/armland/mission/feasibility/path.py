"""Whether the arm can follow a path, and the pose from which it begins."""

from typing import NamedTuple

import numpy as np

from armland.control.laws.realisation import elbow_of
from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.missions.experiments import path_of
from armland.mission.reference.path import Leg, legs, sample
from armland.models.arm import ArmModel
from armland.models.posture import check_path, home_poses, upright
from armland.rotations import Array
from armland.scenario import Scenario

CHECKED_HZ = 20
"""Rate at which the path is checked against the workspace before anything moves."""

CANDIDATES = 24
"""Home poses that are tried before a path is given up."""


class Workplace(NamedTuple):
    """Where the arm starts and the path it follows."""

    home: Array  # (n,) rad
    R_d: Array  # (3, 3) end effector's orientation
    legs: list[Leg]
    path: Array  # (ticks, 9)


def survey_path(arm: ArmModel, scenario: Scenario) -> Workplace:
    """Find a home pose from which the arm can follow the whole path of a believed scenario; the arm's state is overwritten.

    Raises:
        WorkspaceError: a start or a path outside the workspace.
        ConfigurationError: unknown elbow joint, home of the wrong length, no path.
    """
    trajectory = path_of(scenario)
    elbow, near = elbow_of(scenario, arm), _near(scenario, arm)
    start = None if trajectory.start_m is None else np.array(trajectory.start_m)
    refusal: WorkspaceError | None = None
    try:
        homes = home_poses(arm, start, near, elbow)[:CANDIDATES]
    except WorkspaceError as e:
        raise WorkspaceError(f"{e}; change trajectory.start_m or set arm.home_rad") from e
    for pose in homes:
        try:
            return _workplace(scenario, arm, pose.q)
        except WorkspaceError as e:
            refusal = refusal or e
    assert refusal is not None
    raise refusal


def _workplace(scenario: Scenario, arm: ArmModel, home: Array) -> Workplace:
    arm.update(home, np.zeros(arm.joints))
    R_d = upright(arm.rotation)
    run = scenario.run
    path = legs(path_of(scenario), arm.position.copy(), run.settle_s, run.tail_s)
    table = sample(path, run.rate_hz)
    every = max(run.rate_hz // CHECKED_HZ, 1)
    check_path(arm, home, R_d, table[::every, :3], np.arange(0, len(table), every) / run.rate_hz)
    return Workplace(home, R_d, path, table)


def _near(scenario: Scenario, arm: ArmModel) -> Array | None:
    home = scenario.arm.home_rad
    if home is None:
        return None
    if len(home) != arm.joints:
        raise ConfigurationError(
            f"arm.home_rad has {len(home)} values; the arm has {arm.joints} joints: {', '.join(arm.joint_names)}"
        )
    return np.array(home)
