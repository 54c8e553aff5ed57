"""A controller's board filled by hand, at a healthy moment, and the plans that several tests look at."""

import numpy as np
import pytest

JOINTS, TICK_S = 7, 1e-3


@pytest.fixture(scope="session")
def landing_plan():
    from armland.mission.plan import plan
    from armland.scenario import load_scenario

    return plan(load_scenario("landing"), "landing")


@pytest.fixture(scope="session")
def takeoff_plan():
    from armland.mission.plan import plan
    from armland.scenario import load_scenario

    return plan(load_scenario("landing"), "takeoff")


class Bench:
    """The board of a landing at tick 1000, all devices alive, the arm at home, the UAV level."""

    def __init__(self, plan):
        from armland.mission.controller import Controller

        self.plan, self.controller = plan, Controller(plan)
        self.board = self.controller.board
        self.tick, self.told, self.kept = self.controller.tick, self.board["told"], self.board["kept"]
        self.m, self.e, self.c, self.h = (
            getattr(self.tick, name) for name in ("measurement", "estimate", "command", "health")
        )
        for name in ("tick", "arm_tick", "wrench_tick", "uav_tick", "uav_heard"):
            self.m[name] = 1000
        self.m["q"], self.m["uav_quat"][0, 0] = plan.home, 1.0
        self.e["quat"][0, 0], self.e["plate_valid"], self.e["tick"] = 1.0, 1, 1000
        self.kept["limit"]["joint_margin"], self.kept["limit"]["started"] = 1.0, 1
        self.kept["estimate"]["sigma"], self.kept["estimate"]["seen"], self.kept["estimate"]["grip_tick"] = 0.2, 1, 950
        plan.arm.update(plan.home, np.zeros(plan.joints))
        self.board["arm"], self.e["r"] = plan.arm.state, plan.scenario.place.catch_m

    @property
    def b(self):
        """The board as compiled code takes it."""
        return self.board[0]

    def enter(self, phase):
        """Be in a phase; returns its row of the table."""
        self.kept["decide"]["phase"] = self.plan.number(phase)
        return self.row

    @property
    def row(self):
        """Row of the phase in progress."""
        return self.board["table"]["phases"][0, int(self.kept["decide"]["phase"][0])]


@pytest.fixture
def bench(landing_plan):
    return Bench(landing_plan)


@pytest.fixture
def cradle_bench(takeoff_plan):
    return Bench(takeoff_plan)
