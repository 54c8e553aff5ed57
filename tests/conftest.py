"""The paper's controllers, fed by hand, and Pinocchio's forward dynamics of the same arm with its tool.

Everything heavy is imported where it is asked for: most tests need none of it.
"""

import sys
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest


class Done(NamedTuple):
    """How a command ended."""

    code: int
    out: str
    err: str


class ForwardDynamics:
    """Joint torques to the acceleration of the end effector, from the arm's file and the tool's numbers alone."""

    def __init__(self, file, tool):
        import pinocchio as pin

        self.pin = pin
        self.model = pin.buildModelFromMJCF(str(file))
        flange = self.model.frames[self.model.getFrameId("flange")]
        for mass, along in (
            (tool.sensor_mass_kg, 0.5 * tool.sensor_length_m),
            (tool.tool_mass_kg, tool.sensor_length_m + tool.tool_com_m),
        ):
            body = pin.Inertia(mass, np.array([0.0, 0.0, along]), mass * np.eye(3) * 0.03**2)
            self.model.appendBodyToJoint(flange.parentJoint, body, flange.placement)
        tip = flange.placement * pin.SE3(np.eye(3), np.array([0.0, 0.0, tool.length_m]))
        self.frame = self.model.addFrame(pin.Frame("tip", flange.parentJoint, 0, tip, pin.FrameType.OP_FRAME))
        self.data = self.model.createData()

    def acceleration(self, q, qd, tau):
        pin = self.pin
        qdd = pin.aba(self.model, self.data, q, qd, tau).copy()
        pin.forwardKinematics(self.model, self.data, q, qd, qdd)
        return pin.getFrameClassicalAcceleration(
            self.model, self.data, self.frame, pin.LOCAL_WORLD_ALIGNED
        ).vector.copy()

    def gravity(self, q):
        return self.pin.computeGeneralizedGravity(self.model, self.data, q).copy()

    def jacobian(self, q):
        return self.pin.computeFrameJacobian(self.model, self.data, q, self.frame, self.pin.LOCAL_WORLD_ALIGNED).copy()

    def mobility(self, q):
        M = np.triu(self.pin.crba(self.model, self.data, q))
        M = M + np.triu(M, 1).T
        J = self.jacobian(q)
        return J @ np.linalg.solve(M, J.T)


@pytest.fixture
def armland(tmp_path, monkeypatch, capsys):
    """Run the command in this process, in a folder of its own."""
    from armland.cli import main

    monkeypatch.chdir(tmp_path)

    def call(*args: str) -> Done:
        monkeypatch.setattr(sys, "argv", ["armland", *args])
        with pytest.raises(SystemExit) as end:
            main()
        return Done(int(end.value.code or 0), *capsys.readouterr())

    return call


@pytest.fixture(scope="session")
def paper():
    from armland.scenario import load_scenario

    return load_scenario("paper")


@pytest.fixture(scope="session")
def plans(paper):
    """Plans of the paper's experiments, each made once; with overrides they are made anew."""
    from armland.mission.plan import plan
    from armland.scenario import load_scenario

    made = {}

    def of(experiment, overrides=None):
        if overrides:
            return plan(load_scenario("paper", overrides), "track", experiment=experiment)
        if experiment not in made:
            made[experiment] = plan(paper, "track", experiment=experiment)
        return made[experiment]

    return of


@pytest.fixture(scope="session")
def workplace(plans):
    """Home, path and legs of the paper's experiments."""
    return plans("E1")


@pytest.fixture(scope="session")
def dynamics(paper):
    from armland.models.description import ASSETS

    return ForwardDynamics(ASSETS / "lwr4.xml", paper.tool)


@pytest.fixture
def controller(plans, workplace):
    """The controller of an experiment with its messages; `sample` fills a measurement and updates."""
    from armland.mission.controller import Controller

    def build(experiment="E1", overrides=None):
        plan = plans(experiment, overrides)
        law = Controller(plan)
        tick = law.tick

        def sample(k=0, q=workplace.home, qd=0.0, quat=(1.0, 0.0, 0.0, 0.0), rate=0.0, wrench=0.0, uav_tick=None):
            m = tick.measurement
            m["tick"], m["uav_tick"] = k, k if uav_tick is None else uav_tick
            m["arm_tick"] = m["wrench_tick"] = m["uav_heard"] = k
            m["q"], m["qd"], m["uav_quat"], m["uav_rate"], m["wrench"] = q, qd, quat, rate, wrench
            law.update(tick)
            return tick

        return SimpleNamespace(law=law, arm=plan.arm, told=law.board["told"], tick=tick, sample=sample, plan=plan)

    return build


@pytest.fixture(scope="session")
def landing_scenario():
    from armland.scenario import load_scenario

    return load_scenario("landing")


@pytest.fixture(scope="session")
def flown(landing_scenario, tmp_path_factory):
    """A landing and a take-off with seed 1, each with its log and the phases that were told of."""
    from armland.experiments.episode import fly

    folder, out = tmp_path_factory.mktemp("flown"), {}
    for mission in ("landing", "takeoff"):
        told = []
        log = folder / f"{mission}.mcap"
        episode = fly(landing_scenario, mission, 1, log=log, progress=lambda *phase, told=told: told.append(phase))
        out[mission] = episode, told
    return out


@pytest.fixture(scope="session")
def landed(flown):
    return flown["landing"][0]


@pytest.fixture(scope="session")
def taken_off(flown):
    return flown["takeoff"][0]
