"""The landing's controller as the loop sees it: owns the arm model, the tables and what is kept from tick to tick."""

import numpy as np

from armland.estimation.contact import LOAD
from armland.estimation.contact import MEMORY as CONTACT_MEMORY
from armland.estimation.plate import MEMORY as FILTER_MEMORY
from armland.estimation.plate import PLATE
from armland.estimation.wrench import MEMORY as WRENCH_MEMORY
from armland.mission.landing import COUNT, landing_tick
from armland.mission.landing_estimate import admit
from armland.mission.landing_setup import Setup
from armland.mission.landing_state import memory_layout
from armland.mission.records import LandingTick, landing_layout
from armland.mission.supervisor import DEBOUNCE_TICKS, fault_rows
from armland.models.operational import smallest_singular_value

SAMPLE = np.dtype([("capture", "i8"), ("position", "f8", (3,)), ("quat", "f8", (4,)), ("sigma", "f8", (6,))])
"""Camera sample as `pose_filter.fuse` takes it."""

SINGULARITY_PERIOD = 20
"""Ticks between evaluations of the Jacobian's smallest singular value."""


class LandingController:
    """Landing or take-off.

    Args:
        setup: of `landing_setup.set_up`.
    """

    def __init__(self, setup: Setup) -> None:
        self.setup, self.arm = setup, setup.arm
        n, table = setup.arm.joints, setup.table
        self.memory = np.zeros(1, memory_layout(n))
        self._good = np.zeros(1, landing_layout("measurement", n))
        self._records = (
            np.zeros(1, SAMPLE),
            setup.filter,
            np.zeros(1, FILTER_MEMORY),
            np.zeros(1, PLATE),
            setup.wrench,
            np.zeros(1, WRENCH_MEMORY),
            setup.contact,
            np.zeros(1, CONTACT_MEMORY),
            np.zeros(1, LOAD),
        )
        rows = fault_rows(setup.phases)
        miss = table.names.index("miss") if "miss" in table.names else -1
        self._tables = (
            table.phases,
            table.guards,
            table.conditions,
            np.zeros(len(table.guards), np.int64),
            np.zeros(COUNT),
            rows,
            np.array(DEBOUNCE_TICKS, np.int64),
            miss,
        )
        self.memory["q_d"][0, 0] = 1.0
        weight = float(setup.parameters["weight"][0])
        self.memory["hover"] = weight
        if setup.mission == "landing":
            self.memory["thrust"] = self.memory["acting"] = self.memory["thrust_log"] = weight
        self._first = True

    @property
    def phase(self) -> str:
        """Name of the phase in progress."""
        return self.setup.table.names[int(self.memory["phase"][0])]

    @property
    def final(self) -> bool:
        """Whether the mission has ended."""
        return bool(self.setup.table.phases["final"][int(self.memory["phase"][0])])

    def update(self, tick: LandingTick) -> None:
        """Fill estimate, mission, reference, command and health of `tick` from its measurement."""
        arm, m = self.arm, tick.measurement
        bad = admit(m, self._good, self.memory, arm.qpos, arm.qvel)
        arm.refresh(velocity_terms=True)
        if self._first or int(m["tick"][0]) % SINGULARITY_PERIOD == 0:
            self.memory["sigma"] = smallest_singular_value(arm.jacobian)
        if self._first:
            self._first = False
            tick.reference["r"] = self.memory["r0"] = arm.position
            tick.mission["progress"] = 0.0
            self.memory["tau"] = arm.gravity
        landing_tick(tick.buffer, self.setup.parameters, self.memory, arm.state, bad, *self._records, *self._tables)
