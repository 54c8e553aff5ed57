"""The coordinated controller as the loop sees it: owns the arm model and the parameters, fills the messages of a tick."""

import numpy as np
from numpy.typing import NDArray

from armland.control.coordinated import coordinated_tick, parameters_layout, screen
from armland.models.arm import ArmModel
from armland.records import Flag, Tick, layout
from armland.rotations import Array

SINGULARITY_PERIOD = 20
"""Ticks between evaluations of the Jacobian's smallest singular value, which is for the record and the supervisor."""

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
        self._good: NDArray[np.void] = np.zeros(1, layout("measurement", arm.joints))
        self._good["uav_quat"][0, 0] = 1.0
        self._calls = 0
        self._sigma_min = 0.0

    def update(self, tick: Tick) -> None:
        """Fill estimate, reference, command and health of `tick` from its measurement. Never raises on bad samples."""
        arm = self.arm
        screen(tick.buffer, self._good, arm.qpos, arm.qvel)
        arm.refresh()
        if self._calls % SINGULARITY_PERIOD == 0:
            self._sigma_min = float(np.linalg.svd(arm.jacobian, compute_uv=False)[-1])
        self._calls += 1
        tick.health["sigma_min"] = self._sigma_min
        if self._sigma_min < SINGULAR_BELOW:
            tick.health["flags"] |= Flag.NEAR_SINGULAR
        if self._coriolis:
            row = self.path[min(int(tick.measurement["tick"][0]), len(self.path) - 1)]
            self._mu[:] = arm.coriolis_wrench(np.concatenate([row[3:6], np.zeros(3)]))
        coordinated_tick(tick.buffer, self.path, self.parameters, arm.state, self._mu)
