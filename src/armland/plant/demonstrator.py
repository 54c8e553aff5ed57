"""The simulated demonstrator behind the port: connect, read, command, stop. The only place that steps physics."""

import mujoco
import numpy as np

from armland.errors import ConfigurationError, PlantError
from armland.models.parameters import rotor_mixer
from armland.plant.devices import ADDRESSES, CONTROLLERS, PARAMETERS, RING, STATE, actuate, sense
from armland.plant.noise import BLOCK, WhiteNoise
from armland.plant.scene import ROTORS, UAV, Scene, build_scene
from armland.records import Tick
from armland.rotations import Array
from armland.scenario import Scenario


class Demonstrator:
    """Arm, force-torque sensor, hinge and UAV in MuJoCo.

    One tick is one cycle of a real bus: `read` gives what the sensors sampled at the start of the last step, `command` acts
    from now on until the next.
    """

    def __init__(self, scenario: Scenario, home: Array, thrust: float) -> None:
        self.scenario = scenario
        self.scene: Scene = build_scene(scenario)
        self.data = mujoco.MjData(self.scene.model)
        self._home = np.asarray(home, dtype=float)
        n = self.scene.joints
        self._tick = 0
        self._noise = _noise(scenario.run.seed, n)
        self._parameters = _parameters(scenario, self.scene)
        self._parameters["idle_thrust"] = thrust
        self._thrust = thrust
        self._state = np.zeros(1, STATE)
        self._addresses = _addresses(self.scene)
        self._sensordata = self.data.sensordata
        self._ctrl = self.data.ctrl
        self._applied = self.data.xfrc_applied[self.data.body(f"{UAV}uav").id]
        limits = self.scene.model.jnt_actfrcrange[[self.scene.model.dof_jntid[d] for d in self.scene.joint_dof]]
        limited = self.scene.model.jnt_actfrclimited[[self.scene.model.dof_jntid[d] for d in self.scene.joint_dof]]
        self._tau_max = np.where(limited.astype(bool), np.abs(limits).min(axis=1), np.inf)

    def connect(self) -> None:
        """Put the demonstrator at its home pose, at rest, UAV level, rotors at the commanded thrust."""
        m, d = self.scene.model, self.data
        mujoco.mj_resetData(m, d)
        d.qpos[self.scene.joint_qpos] = self._home
        mujoco.mj_kinematics(m, d)
        d.qpos[self.scene.hinge_qpos] = level_hinge(d.body(f"{UAV}uav").xmat.reshape(3, 3))
        rotor = self._thrust / ROTORS
        self._state[:] = np.zeros(1, STATE)
        self._state["rotor_asked"] = self._state["rotor"] = rotor
        self._applied[:] = [0.0, 0.0, self._thrust, 0.0, 0.0, 0.0]
        mujoco.mj_forward(m, d)
        # The motors hold what gravity and the rotors leave: the arm is handed over standing still.
        d.ctrl[:] = -d.qfrc_smooth[self.scene.joint_dof]
        mujoco.mj_forward(m, d)
        self._state["down"][0, 0, :4] = d.sensordata[self.scene.sensor["quat"] :][:4]
        self._noise = _noise(self.scenario.run.seed, self.scene.joints)
        self._tick = 0

    def read(self, tick: Tick) -> None:
        """Fill measurement and truth of `tick`."""
        row = self._tick % BLOCK
        if row == 0:
            for noise in self._noise:
                noise.draw()
        encoders, wrench, imu = self._noise
        sense(
            self._tick,
            self._sensordata,
            self._addresses,
            self._parameters,
            self._state,
            encoders.rows[row],
            wrench.rows[row],
            imu.rows[row],
            tick.measurement,
            tick.truth,
        )

    def command(self, tick: Tick) -> None:
        """Apply the command of `tick` and step the physics once.

        Raises:
            PlantError: the state is no longer finite.
        """
        finite = actuate(
            self._tick,
            tick.command,
            tick.truth,
            self._tau_max,
            self._parameters,
            self._state,
            self._ctrl,
            self._applied,
        )
        if not finite:
            raise PlantError(
                f"the simulation diverged before tick {self._tick}; the gains are too high for the base rate"
            )
        mujoco.mj_step(self.scene.model, self.data)
        self._tick += 1

    def stop(self) -> None:
        """Nothing to let go of in a simulation. Never raises."""


def _noise(seed: int, joints: int) -> list[WhiteNoise]:
    return [WhiteNoise(seed, *x) for x in (("encoders", 2 * joints), ("wrench", 6), ("imu", 6))]


def level_hinge(R: Array) -> Array:
    """Swivel, x and y angles (3,), rad, that level the UAV with zero yaw on an end effector R: Rz Rx Ry = Rᵀ."""
    E = R.T
    return np.array(
        [np.arctan2(-E[0, 1], E[1, 1]), np.arcsin(np.clip(E[2, 1], -1.0, 1.0)), np.arctan2(-E[2, 0], E[2, 2])]
    )


def _addresses(scene: Scene) -> np.ndarray:
    s = scene.sensor
    a = np.zeros(1, ADDRESSES)
    first = scene.model.joint(int(scene.model.dof_jntid[scene.joint_dof[0]])).name
    for name, sensor in (("q", f"q_{first}"), ("qd", f"qd_{first}"), ("tau", f"tau_{first}")):
        a[name] = s[sensor]
    for name in ("force", "quat", "gyro", "r", "v", "v_cm"):
        a[name] = s[name]
    a["hinge"] = s["hinge_force"]
    return a


def _parameters(scenario: Scenario, scene: Scene) -> np.ndarray:
    p = np.zeros(1, PARAMETERS)
    rate = scenario.run.rate_hz
    link, onboard, rotors, sensors = scenario.link, scenario.onboard, scenario.rotors, scenario.sensors
    p["uplink"] = _ticks("link.uplink_delay_ms", link.uplink_delay_ms, rate)
    p["downlink"] = _ticks("link.downlink_delay_ms", link.downlink_delay_ms, rate)
    p["link_period"] = rate // link.rate_hz
    p["onboard_period"] = rate // onboard.rate_hz
    p["effectiveness"] = link.torque_effectiveness
    p["torque_limit"] = link.torque_limit_nm
    p["controller"], p["kp"], p["kd"] = CONTROLLERS.index(onboard.controller), onboard.kp_nm, onboard.kd_nms
    p["lead"], p["observer"], p["onboard_s"] = onboard.lead_s, onboard.observer_rad_s, 1.0 / onboard.rate_hz
    p["lag_gain"] = 1.0 - np.exp(-1.0 / (onboard.rate_hz * rotors.time_constant_s))
    p["inertia"] = scenario.uav.inertia_kgm2
    A = rotor_mixer(scenario)
    p["mixer"], p["mixer_inverse"] = A, np.linalg.inv(A)
    p["rotor_min"], p["rotor_max"] = rotors.min_thrust_n, rotors.max_thrust_n
    p["rotor_gain"] = 1.0 - np.exp(-1.0 / (rate * rotors.time_constant_s))
    p["tick_s"] = 1.0 / rate
    p["force"], p["moment"] = scenario.disturbance.force_n, scenario.disturbance.torque_nm
    p["sigma_q"], p["sigma_qd"] = sensors.joint_position_rad, sensors.joint_velocity_rad_s
    p["sigma_force"], p["sigma_torque"] = sensors.force_n, sensors.torque_nm
    p["force_bias"] = sensors.force_bias_n
    p["filter_gain"] = 1.0 - np.exp(-2.0 * np.pi * sensors.force_filter_hz / rate)
    p["sigma_attitude"], p["sigma_rate"] = sensors.attitude_rad, sensors.rate_rad_s
    return p


def _ticks(name: str, delay_ms: float, rate: int) -> int:
    ticks = round(delay_ms * rate / 1000.0)
    if ticks >= RING:
        longest = (RING - 1) * 1000.0 / rate
        raise ConfigurationError(f"{name} = {delay_ms:g} ms is too long; the link's delay line holds {longest:g} ms")
    return ticks
