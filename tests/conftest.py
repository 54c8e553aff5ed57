"""The paper's controllers, fed by hand, and Pinocchio's forward dynamics of the same arm with its tool.

Everything heavy is imported where it is asked for: most tests need none of it.
"""

from types import SimpleNamespace

import numpy as np
import pytest


class ForwardDynamics:
    """Joint torques to the acceleration of the end effector, from the arm's file and the tool's numbers alone."""

    def __init__(self, file, tool):
        import pinocchio as pin

        self.pin = pin
        self.model = pin.buildModelFromMJCF(str(file))
        flange = self.model.frames[self.model.getFrameId("flange")]
        for mass, along in (
            (tool.sensor_mass, 0.5 * tool.sensor_length),
            (tool.tool_mass, tool.sensor_length + tool.tool_com),
        ):
            body = pin.Inertia(mass, np.array([0.0, 0.0, along]), mass * np.eye(3) * 0.03**2)
            self.model.appendBodyToJoint(flange.parentJoint, body, flange.placement)
        tip = flange.placement * pin.SE3(np.eye(3), np.array([0.0, 0.0, tool.length]))
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


@pytest.fixture(scope="session")
def paper():
    from armland.config import load_scenario

    return load_scenario("paper")


@pytest.fixture(scope="session")
def workplace(paper):
    from armland.experiments.assembly import survey

    return survey(paper)


@pytest.fixture(scope="session")
def dynamics(paper):
    from armland.models.description import ASSETS
    from armland.models.parameters import tool_of

    return ForwardDynamics(ASSETS / "lwr4.xml", tool_of(paper))


@pytest.fixture
def controller(paper, workplace):
    """The controller of an experiment with its messages; `sample` fills a measurement and updates."""
    from armland.config import load_scenario
    from armland.experiments.assembly import assemble

    def build(experiment="E1", overrides=None):
        scenario = load_scenario("paper", overrides) if overrides else paper
        assembly = assemble(scenario, experiment, workplace)
        law, tick = assembly.controller, assembly.tick

        def sample(k=0, q=workplace.home, qd=0.0, quat=(1.0, 0.0, 0.0, 0.0), rate=0.0, wrench=0.0, uav_tick=None):
            m = tick.measurement
            m["tick"], m["uav_tick"] = k, k if uav_tick is None else uav_tick
            m["q"], m["qd"], m["uav_quat"], m["uav_rate"], m["wrench"] = q, qd, quat, rate, wrench
            law.update(tick)
            return tick

        return SimpleNamespace(law=law, tick=tick, sample=sample, scenario=scenario)

    return build
