"""The board of a controller without an arm: messages, environment, what each stage is told and keeps.

Parts that the arm's controller has, too, have the same names and layouts: the same functions work on both.
"""

from functools import lru_cache

import numpy as np

from armland.mission import act, estimate, uav
from armland.mission.supervisor import limits
from armland.models.environment import environment_layout
from armland.records import Records, tick_layout


@lru_cache
def descent_told() -> np.dtype:
    """What coming down is told."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            ("stand", "f8", (3,)),  # m, pivot of a UAV that stands on the pad [D]
            ("eye", "f8", (3,)),  # m, optical centre [D]
            ("wait", "f8"),  # m, height at which the station is found
            ("ready", "f8"),  # m, height at which a quiet moment is waited for
            ("sink", "f8"),  # m/s
            ("align", "f8"),  # m
            ("speed", "f8"),  # m/s, of a UAV that is on its station
            ("give_up", "f8"),  # m
            ("timed", "i8"),
            ("quiet", "f8"),  # U, ratio, `control.laws.unaided.quiet`
            ("patience", "f8"),  # s
            ("cut", "f8"),  # m
            ("level", "f8"),  # m
            ("find_s", "f8"),  # s, after which a UAV that is not seen flies away
            ("retries", "i8"),
            ("pull", "f8"),  # N, beyond the weight, against the rope while it comes down; 0: there is none
        ]
    )


@lru_cache
def descent_kept() -> np.dtype:
    """What coming down is remembered by."""
    return np.dtype(
        [
            ("phase", "i8"),
            ("begin", "i8"),  # tick at which it began
            ("since", "i8"),  # tick since which what ends it holds; −1: it does not
            ("retries", "i8"),
            ("place", "f8"),  # m, height that is asked for
            ("sinking", "f8"),  # m/s, speed at which that falls
            ("mean_tilt", "f8", (2,)),  # rad, of the deck
            ("known", "i8"),  # 1 once that has been looked at
            ("carries", "f8"),  # N, command that carries the weight, as known before the rope pulls
            ("unrest", "f8"),  # U, ratio, `control.laws.unaided.quiet`
        ]
    )


@lru_cache
def board_layout(joints: int) -> np.dtype:
    """The board where the ground moves `joints` things."""
    told = [
        ("estimate", estimate.told_layout(joints)),
        ("descent", descent_told()),
        ("act", np.dtype([("uav", uav.told_layout())])),
        ("limit", limits.told_layout(joints)),
    ]
    kept = [("estimate", estimate.kept_layout(joints)), ("descent", descent_kept()), ("act", act.kept_layout())]
    return np.dtype(
        [
            ("tick", tick_layout(joints)),
            ("environment", environment_layout()),
            ("told", np.dtype(told)),
            ("kept", np.dtype(kept)),
        ]
    )


def new_board(joints: int) -> Records:
    """An empty board (1,)."""
    return np.zeros(1, board_layout(joints))
