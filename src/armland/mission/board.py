"""One nested record of the controller: messages, arm, environment, what each stage is told and keeps, the mission's table."""

from functools import lru_cache

import numpy as np

from armland.linking import LAYOUTS
from armland.mission import act, decide, estimate
from armland.mission.reference import refer
from armland.mission.supervisor import limits
from armland.mission.table.arrays import TABLE
from armland.models.chain import state_layout
from armland.models.environment import environment_layout
from armland.records import Records, tick_layout


@lru_cache
def board_layout(joints: int) -> np.dtype:
    """The board for an arm with `joints` joints; its size and type are the same for every mission."""
    told = [
        ("estimate", estimate.told_layout(joints)),
        ("decide", decide.told_layout()),
        ("refer", refer.told_layout()),
        ("act", act.told_layout(joints)),
        ("limit", limits.told_layout(joints)),
    ]
    kept = [
        ("estimate", estimate.kept_layout(joints)),
        ("decide", decide.kept_layout()),
        ("refer", refer.kept_layout()),
        ("act", act.kept_layout()),
        ("limit", limits.kept_layout(joints)),
    ]
    return np.dtype(
        [
            ("tick", tick_layout(joints)),
            ("arm", state_layout(joints)),
            ("environment", environment_layout()),
            ("told", np.dtype(told)),
            ("kept", np.dtype(kept)),
            ("table", TABLE),
        ]
    )


LAYOUTS["board"] = board_layout


def new_board(joints: int) -> Records:
    """An empty board (1,)."""
    return np.zeros(1, board_layout(joints))
