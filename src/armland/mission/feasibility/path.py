"""Whether the arm can follow a path, the pose from which it begins, and the box in which it may follow the plate."""

from typing import NamedTuple

import numpy as np

from armland.control.laws.realisation import elbow_of
from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.missions.experiments import path_of
from armland.mission.reference.path import Leg, legs, sample
from armland.mission.table.mission import Start
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


def room(scenario: Scenario, start: Start) -> Array:
    """Lowest and highest place (2, 3), m, D, to which the arm follows the plate's pivot.

    As far as `bounds.uav_error_m` from the catch, or of a UAV that takes off from the cradle's middle, and sideways no further
    than leaves `control.approach.clearance_m` to the rails between which it stands.

    Raises:
        ConfigurationError: a catch outside of the corridor.
    """
    place, cradle, reach = scenario.place, scenario.cradle, scenario.bounds.uav_error_m
    slot = np.array(place.put_down_m)
    catch = slot if start == "cradle" else np.array(place.catch_m)
    half = 0.5 * (cradle.gap_m - scenario.arm.width_m) - scenario.control.approach.clearance_m
    angle = np.deg2rad(cradle.heading_deg)
    across = np.array([-np.sin(angle), np.cos(angle)])
    aside = float(across @ (catch - slot)[:2])
    if abs(aside) > half:
        raise ConfigurationError(
            f"place.catch_m = {place.catch_m} lies {1e3 * abs(aside):.0f} mm beside the middle of the cradle's slot; the corridor, in "
            f"which the arm of {1e3 * scenario.arm.width_m:.0f} mm stays clear of rails {1e3 * cradle.gap_m:.0f} mm apart, is "
            f"{1e3 * half:.0f} mm wide to each side: move the catch, the cradle, or widen cradle.gap_m"
        )
    low, high = catch - reach, catch + reach
    low[2] -= scenario.place.standoff_m
    if scenario.foretold_mps > 0.0 or scenario.foretold_deck:
        # Down to where it waits: a plate that air takes down is to be followed, not to be met.
        low[2] = min(low[2], catch[2] - scenario.place.wait_below_m + scenario.place.standoff_m)
    for i in range(2):
        # Of a slot that stands askew the box takes what is inside for all of it.
        if abs(across[i]) > 1e-9:
            rest = (half - aside - reach * abs(across[1 - i])) / abs(across[i])
            back = (half + aside - reach * abs(across[1 - i])) / abs(across[i])
            up, down = (rest, back) if across[i] > 0.0 else (back, rest)
            high[i] = min(high[i], catch[i] + max(up, 0.0))
            low[i] = max(low[i], catch[i] - max(down, 0.0))
    return np.array([low, high])
