"""Whether the arm reaches wherever it may have to follow the UAV before the capture, not the station alone."""

import numpy as np

from armland.errors import WorkspaceError
from armland.models.arm import ArmModel
from armland.models.posture import check_path
from armland.rotations import Array
from armland.scenario import Scenario

STEPS = 4
"""Points from the station to each end of the box."""


def tracked_points(scenario: Scenario) -> Array:
    """End effector positions (k, 3) m from the catch to the ends of the box about it, and back.

    The arm approaches once the UAV is within `bounds.uav_error_m` of its station, and follows it there from `place.standoff_m`
    below the plate up to the plate.
    """
    catch, error = np.array(scenario.place.catch_m), scenario.bounds.uav_error_m
    out = []
    for axis in np.eye(3):
        for sign in (-1.0, 1.0):
            end = catch + sign * error * axis
            if axis[2] and sign < 0.0:
                end[2] -= scenario.place.standoff_m
            there = np.linspace(catch, end, STEPS)
            out += [there, there[::-1]]
    return np.concatenate(out)


def out_of_reach(refusal: WorkspaceError) -> str:
    """What `check_path` says of the point, without time and advice, which are a trajectory's."""
    return str(refusal).partition(" s: ")[2].partition("; shorten")[0]


def check_tracking(arm: ArmModel, q: Array, R_d: Array, scenario: Scenario) -> None:
    """Refuse a catch about which the arm could not follow the UAV.

    Args:
        arm: the arm model (its state is overwritten).
        q: joint positions (n,) rad with the end effector below the catch, where the arm waits.
        R_d: orientation (3, 3), rotation matrix D<-E, 1, that it keeps.
        scenario: believed.

    Raises:
        WorkspaceError: names the point, the distance that remains and the joint at its limit.
    """
    points, place = tracked_points(scenario), scenario.place
    lead = np.linspace(np.array(place.catch_m) - [0.0, 0.0, place.wait_below_m], points[0], 8)
    points = np.concatenate([lead, points])
    try:
        check_path(arm, q, R_d, points, np.arange(len(points), dtype=float))
    except WorkspaceError as refusal:
        raise WorkspaceError(
            f"the arm must follow the UAV within bounds.uav_error_m = {scenario.bounds.uav_error_m:g} m about "
            f"place.catch_m = {place.catch_m}: {out_of_reach(refusal)}; move the catch or lower the bound"
        ) from refusal
