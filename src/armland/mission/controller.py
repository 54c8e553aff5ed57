"""The coordinated controller as the loop sees it: estimate, reference, law, limits, in this order at each tick."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.control.coordinated import (
    IMPLIED,
    arm_law,
    limit,
    parameters_layout,
    predict_attitude_torque,
    prove,
    uav_law,
)
from armland.estimation.state import estimate_state, memory_layout, observe_disturbance, screen
from armland.models.arm import ArmModel
from armland.models.operational import smallest_singular_value
from armland.records import Flag, Record, Tick, layout
from armland.rotations import Array

SINGULARITY_PERIOD = 20
"""Ticks between evaluations of the Jacobian's smallest singular value, which is for the record and the supervisor."""

PROOF_PERIOD = 5
"""Ticks between evaluations of V₂ for the record: as often as the UAV is heard of, at a fifth of the cost."""

SINGULAR_BELOW = 0.02
"""Smallest singular value of the Jacobian that does not raise the flag."""


class CoordinatedController:
    """UAV and arm as one system.

    Args:
        arm: the controller's own arm model.
        path: desired pivot position, velocity and acceleration at each tick (ticks, 9), m, m/s, m/s², world.
        parameters: (1,) of `parameters_layout`.
        coriolis_feedforward: whether μ ẋ_d of (35) is fed forward.
    """

    def __init__(
        self, arm: ArmModel, path: Array, parameters: NDArray[np.void], coriolis_feedforward: bool = False
    ) -> None:
        assert parameters.dtype == parameters_layout(arm.joints)
        self.arm = arm
        self.path = np.ascontiguousarray(path)
        self.parameters = parameters
        self._coriolis = coriolis_feedforward
        self._mu = np.zeros(6)
        self._velocity_terms = bool(parameters["acceleration"][0] == IMPLIED)
        self._good: NDArray[np.void] = np.zeros(1, layout("measurement", arm.joints))
        self._good["uav_quat"][0, 0] = 1.0
        self._memory: NDArray[np.void] = np.zeros(1, memory_layout())
        self._calls = 0
        self._sigma_min = 0.0

    def update(self, tick: Tick) -> None:
        """Fill estimate, reference, command and health of `tick` from its measurement. Never raises on bad samples."""
        arm = self.arm
        screen(tick.buffer, self._good, arm.qpos, arm.qvel)
        arm.refresh(self._velocity_terms)
        if self._calls % SINGULARITY_PERIOD == 0:
            # The message keeps it until the next time.
            tick.health["sigma_min"] = self._sigma_min = smallest_singular_value(arm.jacobian)
        self._calls += 1
        if self._sigma_min < SINGULAR_BELOW:
            tick.health["flags"] |= Flag.NEAR_SINGULAR
        if self._coriolis:
            row = self.path[min(int(tick.measurement["tick"][0]), len(self.path) - 1)]
            self._mu[:] = arm.coriolis_wrench(np.concatenate([row[3:6], np.zeros(3)]))
        coordinated_tick(tick.buffer, self.path, self.parameters, arm.state, self._mu, self._memory)


@njit(cache=True)
def follow(path: Array, tick: int, r: Record) -> None:
    """Fill the reference from row `tick` of `path` (ticks, 9): r_d, ṙ_d, r̈_d; past its end the last row holds."""
    row = path[min(tick, path.shape[0] - 1)]
    r.tick = tick
    for i in range(3):
        r.r[i] = row[i]
        r.v[i] = row[3 + i]
        r.a[i] = row[6 + i]
    r.quat[0] = 1.0
    for i in range(3):
        r.quat[1 + i] = 0.0


@njit(cache=True)
def coordinated_tick(
    tick: NDArray[np.void],
    path: Array,
    p_: NDArray[np.void],
    arm_: NDArray[np.void],
    mu: Array,
    memory_: NDArray[np.void],
) -> None:
    """The whole tick, in the order of the loop.

    Args:
        tick: all messages (1,), `tick_layout`; `health.flags` says what screening found.
        path: desired position, velocity, acceleration at each tick (ticks, 9), m, m/s, m/s², world.
        p_: parameters (1,), `parameters_layout`.
        arm_: the arm model's state (1,), `armland.models.arm.state_layout`.
        mu: μ ẋ_d (6,), N, N·m, world; zero where it is neglected.
        memory_: what is kept from tick to tick (1,), `memory_layout`.
    """
    t, p, arm, memory = tick[0], p_[0], arm_[0], memory_[0]
    estimate_state(t.measurement, p, arm, t.estimate)
    predict_attitude_torque(p, t.estimate)
    observe_disturbance(t.measurement, p, memory, t.estimate)
    follow(path, t.measurement.tick, t.reference)
    if t.measurement.tick % PROOF_PERIOD == 0:
        prove(t.estimate, t.reference, p, t.proof)
    r_ddot = uav_law(t.estimate, t.reference, p, path, t.command)
    arm_law(t.measurement, t.reference, p, arm, mu, r_ddot, t.command)
    limit(t.measurement, p, t.command, t.health)
    memory.thrust = t.command.thrust
    for i in range(3):
        memory.force[i] = t.command.force[i]
        memory.torque[i] = t.estimate.tau_att[i] + t.command.delta_tau[i]
