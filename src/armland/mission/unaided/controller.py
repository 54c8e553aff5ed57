"""The controller of a landing without an arm: perceive, decide, command, in one compiled call."""

from collections.abc import Callable
from functools import cached_property

from numba import config, njit, typeof

from armland.linking import LINKED
from armland.mission.unaided.board import new_board
from armland.mission.unaided.command import command
from armland.mission.unaided.decide import AWAY, DONE, SETTLE, decide
from armland.mission.unaided.perceive import perceive
from armland.mission.unaided.plan import UnaidedPlan
from armland.records import Records, Tick

NEEDED = ("follow", "know")
"""Linked functions that it calls."""


@njit(cache=True, nogil=True)
def control_unaided(board: Records) -> None:
    """One tick: from `measurement` to `command` of the messages of `board` (1,) of `unaided.board`. Never raises on bad samples."""
    b = board[0]
    phase = b.kept.descent.phase
    perceive(b, phase in (SETTLE, DONE))
    decide(b)
    command(b)


def link_needed(names: tuple[str, ...], joints: int) -> None:
    """Make the addresses of the linked functions `names` known where the ground moves `joints` things."""
    for function in LINKED:
        if function.name in names:
            function.link(joints)


class UnaidedController:
    """The controller of a mission without an arm.

    Args:
        plan: of the mission.
    """

    def __init__(self, plan: UnaidedPlan) -> None:
        self.plan = plan
        link_needed(NEEDED, plan.joints)
        self.board = new_board(plan.joints)
        """All that the controller is told and keeps (1,)."""
        self.board["told"], self.board["environment"] = plan.told, plan.environment
        kept = self.board["kept"]
        kept["estimate"]["filter"]["align"]["quat"][..., 0] = 1.0
        kept["estimate"]["good"]["uav_quat"][:, 0] = 1.0
        kept["estimate"]["thrust_log"] = kept["estimate"]["acting"] = kept["act"]["thrust"] = plan.weight_n
        kept["estimate"]["uplink"] = plan.told["estimate"]["uplink"]
        kept["estimate"]["weight"], kept["estimate"]["felt"] = plan.weight_n, 1.0
        kept["act"]["hover"], kept["act"]["q_d"][:, 0] = plan.weight_n, 1.0
        kept["descent"]["since"], kept["descent"]["place"] = -1, plan.told["descent"]["wait"]
        self.tick = Tick(plan.joints, self.board["tick"])

    @property
    def phase(self) -> str:
        """Name of the phase in progress."""
        return self.plan.names[int(self.board["kept"]["descent"]["phase"][0])]

    @property
    def final(self) -> bool:
        """Whether the mission has ended."""
        return int(self.board["kept"]["descent"]["phase"][0]) in (DONE, AWAY)

    def ended_for(self) -> int:
        """Ticks for which the phase in progress has been watched, where it is a final one; else −1."""
        begin = int(self.board["kept"]["descent"]["begin"][0])
        return int(self.tick.measurement["tick"][0]) - begin if self.final else -1

    @cached_property
    def _control(self) -> Callable[..., None]:
        # For arguments of this type: to find it out at every call takes long.
        if config.DISABLE_JIT:  # type: ignore[attr-defined]
            return control_unaided
        types = (typeof(self.board),)
        control_unaided.compile(types)
        return control_unaided.overloads[types].entry_point  # type: ignore

    def update(self, tick: Tick) -> None:
        """Fill estimate, mission, reference and command of `tick`, the controller's own, from its measurement."""
        assert tick.buffer is self.tick.buffer
        self._control(self.board)
