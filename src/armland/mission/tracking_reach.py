"""Whether the arm reaches wherever it may have to follow the UAV before the capture, not the station alone."""

import numpy as np

from armland.errors import WorkspaceError
from armland.mission.landing_scenario import Landing
from armland.models.arm import ArmModel
from armland.models.workspace import check_path
from armland.rotations import Array

STEPS = 4
"""Points on the way from the station to each end of the box."""


def tracked_points(landing: Landing) -> Array:
    """End effector positions (k, 3) m on the ways from the catch to the ends of the box about it, and back.

    The arm approaches once the UAV is within `bounds.uav_error_m` of its station, and follows it there from `place.standoff_m`
    below the plate up to the plate.
    """
    catch, error = np.array(landing.place.catch_m), landing.bounds.uav_error_m
    ways = []
    for axis in np.eye(3):
        for sign in (-1.0, 1.0):
            end = catch + sign * error * axis
            if axis[2] and sign < 0.0:
                end[2] -= landing.place.standoff_m
            way = np.linspace(catch, end, STEPS)
            ways += [way, way[::-1]]
    return np.concatenate(ways)


def out_of_reach(refusal: WorkspaceError) -> str:
    """What `check_path` says of the point, without time and advice, which are a trajectory's."""
    return str(refusal).partition(" s: ")[2].partition("; shorten")[0]


def check_tracking(arm: ArmModel, q: Array, R_d: Array, landing: Landing) -> None:
    """Refuse a catch about which the arm could not follow the UAV.

    Args:
        arm: the arm model (its state is overwritten).
        q: joint positions (n,) rad with the end effector below the catch, where the arm waits.
        R_d: orientation (3, 3) that it keeps.
        landing: what is wanted.

    Raises:
        WorkspaceError: names the point, the distance that remains and the joint at its limit.
    """
    points = tracked_points(landing)
    place = landing.place
    lead = np.linspace(np.array(place.catch_m) - [0.0, 0.0, place.wait_below_m], points[0], 8)
    points = np.concatenate([lead, points])
    try:
        check_path(arm, q, R_d, points, np.arange(len(points), dtype=float))
    except WorkspaceError as refusal:
        raise WorkspaceError(
            f"the arm must follow the UAV within bounds.uav_error_m = {landing.bounds.uav_error_m:g} m about "
            f"place.catch_m = {place.catch_m}: {out_of_reach(refusal)}; move the catch or lower the bound"
        ) from refusal
