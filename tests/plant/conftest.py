"""Scenarios without noise, a simulator whose arm is led by stiff joints, and devices that are fed by hand."""

import mujoco
import numpy as np
import pytest

ON_HINGE = np.array([0.3971, -1.6783, 0.6403, -1.297, -1.078, 0.7399, -0.3102])
"""Joint positions from which the paper's trajectory starts, rad."""

WAITING = np.deg2rad([-4.72, -109.96, -7.94, -71.39, 11.82, 39.34, -7.2])
"""Joint positions below the catch, rad."""

NOISELESS = {
    "joint_position_rad": 0.0,
    "joint_velocity_rad_s": 0.0,
    "force_n": 0.0,
    "torque_nm": 0.0,
    "attitude_rad": 0.0,
    "rate_rad_s": 0.0,
}

CALM = {
    "force_bias_n": 0.0,
    "torque_bias_nm": 0.0,
    "heading_error_deg": 0.0,
    "tilt_error_deg": 0.0,
    "hover_noise_m": 0.0,
    "noise": False,
}

STIFFNESS, DAMPING = 3000.0, 120.0


def merged(base, extra):
    out = dict(base)
    for key, value in extra.items():
        out[key] = merged(out.get(key, {}), value) if isinstance(value, dict) else value
    return out


@pytest.fixture(scope="session")
def paper():
    """The paper's scenario without noise, with changes."""
    from armland.scenario import load_scenario

    return lambda **sections: load_scenario("paper").replaced(merged({"sensors": NOISELESS}, sections))


@pytest.fixture(scope="session")
def landing():
    """The landing's scenario without sensor noise, bias and hover noise, with changes."""
    from armland.scenario import load_scenario

    return lambda **sections: load_scenario("landing").replaced(merged({"imperfections": CALM}, sections))


class Led:
    """A simulator whose joints follow `path(t)` (n,) stiffly; `watch(simulator)` is called after each step."""

    def __init__(self, scenario, start, home, path=None, phases=()):
        from armland.plant.simulator import Simulator
        from armland.records import Tick, UavMode

        self.sim, self.tick = Simulator(scenario, home, start, phases), Tick(len(home))
        self.path = path or (lambda t: home)
        c = self.tick.command
        c["uav_quat"][0, 0], c["thrust"] = 1.0, scenario.control.thrust_n
        c["uav_mode"] = {"hinged": UavMode.HINGED, "air": UavMode.AUTONOMOUS, "cradle": UavMode.OFF}[start]
        self.sim.connect()

    def step(self, count=1, watch=None, tau=None, **command):
        """Read and command `count` times; returns the ticks."""
        s, d, rows = self.sim.scene, self.sim.data, []
        for name, value in command.items():
            self.tick.command[name] = value
        for _ in range(count):
            self.sim.read(self.tick)
            if tau is None:
                error = d.qpos[s.joint_qpos] - self.path(self.sim.tick / self.sim.scenario.run.rate_hz)
                led = d.qfrc_bias[s.joint_dof] - STIFFNESS * error - DAMPING * d.qvel[s.joint_dof]
                self.tick.command["tau"] = led
            else:
                self.tick.command["tau"] = tau
            self.sim.command(self.tick)
            rows.append(self.tick.buffer[0].copy())
            if watch is not None:
                watch(self.sim)
        return np.array(rows)


@pytest.fixture(scope="session")
def hinged(paper):
    """An arm with the UAV on its hinge, at rest unless `path` moves it."""
    return lambda path=None, **sections: Led(paper(**sections), "hinged", ON_HINGE, path)


@pytest.fixture(scope="session")
def waiting(landing):
    """An arm that waits below the catch for a UAV in the air, or stands beside one on the cradle."""

    def build(start="air", phases=(), **sections):
        return Led(landing(**sections), start, WAITING, phases=phases)

    return build


@pytest.fixture(scope="session")
def sway():
    """A path of the joints, from `ON_HINGE` on."""
    return _sway


def _sway(t):
    """Joint positions that swing on all axes from rest, rad."""
    grow = 1.0 - np.exp(-((t / 0.1) ** 2))
    return ON_HINGE + grow * 0.08 * np.sin(np.array([7.0, 5.0, 8.0, 6.0, 9.0, 7.5, 8.5]) * t)


class Bench:
    """The devices of a connected simulator with MuJoCo's arrays in the test's hands; all noise is one number."""

    def __init__(self, simulator, joints=7):
        from armland.records import Tick

        self.sim = simulator
        simulator.connect()
        self.world = simulator.world
        self.told, self.kept = self.world["told"], self.world["kept"]
        self.data = np.zeros_like(simulator.data.sensordata)
        self.ctrl, self.applied = np.zeros(joints), np.zeros_like(simulator.data.xfrc_applied)
        self.views = simulator.views._replace(sensordata=self.data, ctrl=self.ctrl, xfrc_applied=self.applied)
        self.tick = Tick(joints)
        self.m, self.t, self.c = self.tick.measurement, self.tick.truth, self.tick.command
        self.c["uav_quat"][0, 0] = 1.0
        for name in ("quat", "ee_quat", "hinge_quat", "plate_quat"):
            self.put(name, [1.0, 0.0, 0.0, 0.0])
        self.t["quat"] = [1.0, 0.0, 0.0, 0.0]

    def put(self, name, values, of="truth"):
        """Let a sensor read `values`."""
        at = int(self.told[of][name][0])
        self.data[at : at + len(values)] = values

    def fill(self, noise):
        for rows in self.sim.noise:
            rows[:] = noise

    def read(self, k, noise=0.0):
        from armland.plant.simulator import _sense

        self.fill(noise)
        _sense(k, self.world, self.views, self.sim.noise, self.m, self.t)
        return self.m

    def act(self, k, phase=0, noise=0.0, **command):
        """Returns the wrench (6,) on the UAV, world."""
        from armland.plant.simulator import _actuate

        self.fill(noise)
        for name, value in command.items():
            self.c[name] = value
        self.answer = _actuate(k, self.world, self.views, self.sim.noise, phase, self.c, self.t)
        return self.applied[self.sim.scene.uav_body].copy()


PROMPT = {
    "link": {"uplink_delay_ms": 0.0, "downlink_delay_ms": 0.0, "rate_hz": 1000, "torque_effectiveness": 1.0},
    "onboard": {"rate_hz": 1000},
    "rotors": {"time_constant_s": 1e-6},
    "sensors": {"force_filter_hz": 1e5},
}
"""Devices without delay, lag and filter."""


@pytest.fixture
def bench(paper):
    """Devices of the hinged UAV, fed by hand: without noise, delay, lag and filter unless changed."""
    from armland.plant.simulator import Simulator
    from armland.records import UavMode

    def build(**sections):
        out = Bench(Simulator(paper(**merged(PROMPT, sections)), ON_HINGE, "hinged"))
        out.c["uav_mode"], out.c["thrust"] = UavMode.HINGED, out.sim.scenario.control.thrust_n
        return out

    return build


@pytest.fixture
def bench_in_air(landing):
    """The same of the free UAV."""
    from armland.plant.simulator import Simulator

    def build(start="air", phases=(), **sections):
        return Bench(Simulator(landing(**merged(PROMPT, sections)), WAITING, start, phases))

    return build


@pytest.fixture(scope="session")
def energy():
    """½ q̇ᵀMq̇ + Σ m g z of all bodies, J, from the state alone."""

    def of(sim, scratch={}):  # noqa: B006
        m, d = sim.scene.model, sim.data
        if scratch.get("model") is not m:
            scratch.update(model=m, data=mujoco.MjData(m), M=np.zeros((m.nv, m.nv)))
        there, M = scratch["data"], scratch["M"]
        there.qpos[:], there.qvel[:] = d.qpos, d.qvel
        mujoco.mj_kinematics(m, there)
        mujoco.mj_comPos(m, there)
        mujoco.mj_makeM(m, there)
        mujoco.mj_fullM(m, there, M)
        return 0.5 * d.qvel @ M @ d.qvel + 9.81 * m.body_mass @ there.xipos[:, 2], there.xipos[
            sim.scene.uav_body
        ].copy()

    return of
