"""The controller of every mission: screen, arm model, estimate, decide, refer, act, limit, in this order, in one compiled call."""

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numba import config, njit, typeof

from armland.linking import link
from armland.mission.act import act
from armland.mission.board import new_board
from armland.mission.decide import decide
from armland.mission.estimate import estimate, screen
from armland.mission.plan import Plan
from armland.mission.reference.refer import refer
from armland.mission.supervisor.limits import limit
from armland.models.arm import Views
from armland.models.chain import coriolis_wrench, feel, refresh
from armland.models.environment import carry_along
from armland.records import Record, Records, Tick
from armland.rotations import Array


@njit(cache=True, nogil=True)
def control(board: Records, path: Array, arm: Views) -> None:
    """One tick: from `measurement` to `command` of the board's messages. Never raises on bad samples.

    Args:
        board: (1,) of `mission.board.board_layout`.
        path: (k, 9), m, m/s, m/s², deck: what a mission with a path follows; (1, 9) for the others.
        arm: the controller's own arm model, whose memory is overwritten.
    """
    b = board[0]
    screen(b)
    refresh_arm(b, path, arm)
    if b.kept.limit.started == 0:
        begin(b)
    estimate(b)
    decide(b)
    refer(b, path)
    act(b, path)
    limit(b)


@njit(cache=True)
def refresh_arm(b: Record, path: Array, arm: Views) -> None:
    """Evaluate the arm's model at the screened joints into the board `b`; with it μ ẋ_d where that is fed forward.

    Args:
        b: board.
        path: (k, 9), m, m/s, m/s², D, of which ẋ_d is taken.
        arm: the controller's own arm model, whose memory is overwritten.
    """
    m = b.tick.measurement
    for i in range(m.q.shape[0]):
        arm.qpos[i], arm.qvel[i] = m.q[i], m.qd[i]
    feel(arm, b.environment, b.told.estimate.carried == 1)
    refresh(arm, b.arm, b.told.estimate.velocity_terms == 1)
    if b.told.estimate.coriolis:
        twist, mu = np.zeros(6), np.zeros(6)
        for i in range(3):
            twist[i] = path[min(m.tick, path.shape[0] - 1), 3 + i]
        coriolis_wrench(arm, b.arm, twist, mu)
        for i in range(6):
            b.kept.estimate.mu[i] = mu[i]
    if b.environment.moves and b.told.estimate.carried:
        carry_along(arm, b.environment, b.arm)


@njit(cache=True)
def begin(b: Record) -> None:
    """Before the first tick: the reference rests where the arm is, and the arm is held by its own weight's torques."""
    for i in range(3):
        b.kept.refer.r[i] = b.kept.refer.r0[i] = b.arm.position[i]
    for i in range(b.arm.gravity.shape[0]):
        b.kept.limit.tau[i] = b.arm.gravity[i]


class Controller:
    """The controller of a mission, for loops in Python.

    Args:
        plan: of `armland.mission.plan.plan`.
    """

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        link(plan.joints)
        self.board = new_board(plan.joints)
        """All that the controller is told and keeps (1,); its bytes and the arm model's are a snapshot of it."""
        self.board["told"], self.board["table"] = plan.told, plan.table
        self.board["environment"] = plan.environment
        self._begin(float(plan.thrust_n))
        self.tick = Tick(plan.joints, self.board["tick"])

    def _begin(self, thrust: float) -> None:
        kept = self.board["kept"]
        kept["estimate"]["filter"]["align"]["quat"][..., 0] = 1.0
        kept["estimate"]["good"]["uav_quat"][:, 0] = 1.0
        kept["estimate"]["thrust_log"] = kept["estimate"]["acting"] = kept["act"]["thrust"] = thrust
        kept["estimate"]["uplink"] = self.plan.told["estimate"]["uplink"]
        kept["estimate"]["weight"] = self.plan.told["estimate"]["weight"]
        kept["estimate"]["felt"] = 1.0
        kept["act"]["hover"], kept["act"]["q_d"][:, 0] = self.plan.weight_n, 1.0
        kept["decide"]["held"] = self.board["table"]["phases"]["held"][:, 0]

    @property
    def phase(self) -> str:
        """Name of the phase in progress."""
        return self.plan.names[self._index]

    @property
    def final(self) -> bool:
        """Whether the mission has ended."""
        return bool(self.board["table"]["phases"]["final"][0, self._index])

    @property
    def _index(self) -> int:
        return int(self.board["kept"]["decide"]["phase"][0])

    def ended_for(self) -> int:
        """Ticks for which the phase in progress has been watched, where it is a final one; else −1."""
        kept = self.board["kept"]["decide"]
        return int(self.tick.measurement["tick"][0] - kept["begin"][0]) if self.final else -1

    @cached_property
    def _control(self) -> Callable[..., None]:
        # `control` for arguments of these types: to find it out at every call takes as long as a fifth of a tick.
        if config.DISABLE_JIT:  # type: ignore[attr-defined]
            return control
        types = tuple(map(typeof, (self.board, self.plan.path, self.plan.arm.views)))
        control.compile(types)
        return control.overloads[types].entry_point  # type: ignore

    def update(self, tick: Tick) -> None:
        """Fill estimate, mission, reference, command, health and proof of `tick` from its measurement.

        Args:
            tick: the controller's own, `Controller.tick`.
        """
        assert tick.buffer is self.tick.buffer
        self._control(self.board, self.plan.path, self.plan.arm.views)
