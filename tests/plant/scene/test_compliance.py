"""The cradle gives way by the load over its stiffness, whatever the mass behind the load, and swings as its spring and damper say."""

import mujoco
import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.parameters import arm_model
from armland.plant.scene.compliance import SINK
from armland.plant.scene.composition import build_scene
from armland.scenario import load_scenario

G = 9.81
HOME = np.deg2rad([-3.0, -83.0, -6.0, -49.0, 11.0, 35.0, -11.0])
K, C, M = 1e4, 25.0, 0.3
"""Of a buffer, N/m and N·s/m; of the frame, kg."""


class Bed:
    """The cradle with a UAV on it, the arm led below it or, where it holds, pressing it down by a spring in the place of a magnet."""

    def __init__(self, held=False, **sections):
        scenario = load_scenario("landing").replaced(sections)
        self.scene = build_scene(scenario, "free", ("cradle",))
        self.model, self.data = self.scene.model, mujoco.MjData(self.scene.model)
        self.arm, self.held, self.q = arm_model(scenario.believed()), held, HOME
        self.lead(-0.0 if held else -0.08)
        s, d = self.scene, self.data
        d.qpos[s.joint_qpos] = self.q
        d.qpos[s.uav_qpos[:3]], d.qpos[s.uav_qpos[3]] = s.put_down - s.lever, 1.0
        mujoco.mj_forward(self.model, d)
        self.sink = int(self.model.joint(SINK).qposadr[0])

    def lead(self, height):
        """Send the end effector to `height` m above the put-down point, upright."""
        for _ in range(30):
            self.arm.update(self.q, np.zeros(7))
            up = self.arm.rotation[:, 2]
            error = self.scene.put_down + [0.0, 0.0, height] - self.arm.position
            e = np.concatenate([error, np.cross(up, [0.0, 0.0, 1.0])[:2]])
            J = self.arm.jacobian[:5]
            self.q = self.q + J.T @ np.linalg.solve(J @ J.T + 1e-9 * np.eye(5), e)
        return self

    def step(self, count=1):
        s, d = self.scene, self.data
        for _ in range(count):
            error = d.qpos[s.joint_qpos] - self.q
            d.ctrl[:] = d.qfrc_bias[s.joint_dof] - 3000.0 * error - 120.0 * d.qvel[s.joint_dof]
            if self.held:
                # A spring between end effector and pivot: the arm presses the UAV down.
                pull = 1e4 * (self.read("ee_pos") - self.read("r")) + 100.0 * (self.read("ee_vel") - self.read("v"))
                force = [0.0, 0.0, pull[2]]
                self.apply(s.uav_body, force, self.read("r"))
                self.apply(s.tool_body, [0.0, 0.0, -pull[2]], self.read("ee_pos"))
            mujoco.mj_step(self.model, d)
        return self

    def apply(self, body, force, point):
        lever = point - self.data.xipos[body]
        self.data.xfrc_applied[body] = np.concatenate([force, np.cross(lever, force)])

    def read(self, name):
        return self.data.sensordata[self.scene.sensor[name] :][:3].copy()

    @property
    def sunk(self):
        """How far the frame has sunk, m."""
        return -float(self.data.qpos[self.sink])


@pytest.mark.parametrize("k", [1e4, 2e4])
def test_eq1_free_uav_sinks_by_its_weight_over_four_buffers(k):
    bed = Bed(cradle={"stiffness_npm": k}).step(1500)
    sag = bed.scene.uav_mass * G / (4.0 * k)
    assert bed.sunk == pytest.approx(sag, rel=1e-3)
    # Skids and rails themselves are pressed together by no more than 1 µm.
    assert bed.scene.put_down[2] - bed.read("r")[2] == pytest.approx(sag, abs=1e-6)


def test_eq1_the_arm_meets_the_same_stiffness():
    bed = Bed(held=True).lead(-0.01).step(2500)
    load = bed.read("cradle_force")[2]
    assert load > 4.0 * bed.scene.uav_mass * G
    assert bed.sunk == pytest.approx(load / (4.0 * K), rel=2e-3)
    assert bed.scene.put_down[2] - bed.read("r")[2] == pytest.approx(load / (4.0 * K), rel=1e-2)


@pytest.mark.parametrize(("axis", "arm"), [(0, 0.137), (1, 0.15)])
def test_eq1_frame_rolls_and_pitches(axis, arm):
    bed = Bed()
    frame = bed.model.body("cradle").id
    bed.data.qpos[bed.scene.uav_qpos[2]] += 1.0
    bed.data.xfrc_applied[frame, 3 + axis] = 0.5
    bed.step(300)
    assert bed.data.qpos[bed.sink + 1 + axis] == pytest.approx(0.5 / (4.0 * K * arm**2), rel=2e-3)


def test_unloaded_frame_stays_where_it_was_put():
    bed = Bed()
    bed.data.qpos[bed.scene.uav_qpos[2]] += 1.0
    assert abs(bed.step(300).sunk) < 1e-9


@pytest.mark.parametrize(("rate", "off"), [(1000, 0.12), (4000, 0.03)])
def test_eq2_uav_and_frame_swing_together_as_mass_spring_and_damper(rate, off):
    # x¨ + 2ζω x˙ + ω² x = 0 about the loaded rest, small enough not to part; both start with one speed.
    bed, v = Bed(run={"rate_hz": rate}).step(2 * rate), 0.01
    rest = bed.sunk
    bed.data.qvel[bed.scene.uav_dof[2]] = bed.data.qvel[bed.model.joint(SINK).dofadr[0]] = -v
    mass = bed.scene.uav_mass + M
    w, z = np.sqrt(4.0 * K / mass), 4.0 * C / (2.0 * np.sqrt(4.0 * K * mass))
    t = np.arange(1, round(0.06 * rate)) / rate
    wd = w * np.sqrt(1.0 - z * z)
    swing = v / wd * np.exp(-z * w * t) * np.sin(wd * t)
    flown = np.array([bed.step().sunk - rest for _ in t])
    # What is left falls with the step: the order of the integrator.
    assert np.abs(flown - swing).max() < off * swing.max()


@pytest.mark.parametrize(
    ("numbers", "least", "enough"),
    [({"stiffness_npm": 1e6}, 4090, 5000), ({"damping_nspm": 300.0}, 8350, 10000), ({"mass_kg": 0.1}, 2267, 3000)],
)
def test_springs_too_fast_for_the_base_rate_are_refused(numbers, least, enough):
    with pytest.raises(
        ModelError, match=rf"too much for cradle\.mass_kg .* run\.rate_hz = 1000; it must be above {least}"
    ):
        build_scene(load_scenario("landing").replaced({"cradle": numbers}), "free")
    build_scene(load_scenario("landing").replaced({"cradle": numbers, "run": {"rate_hz": enough}}), "free")
