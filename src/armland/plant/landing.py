"""The plant of a landing behind the port: connect, read, command, stop. Steps the landing scene and its devices."""

from typing import Literal, NamedTuple

import mujoco
import numpy as np

from armland.errors import ConfigurationError, PlantError
from armland.mission.landing_procedure import LANDING
from armland.mission.landing_scenario import LandingScenario
from armland.mission.launch_procedure import takeoff_phases
from armland.mission.records import LandingTick, UavMode
from armland.models.inflow import advance_of, disc_of
from armland.models.uav import mixer
from armland.plant.camera import NOISE_WIDTH, SAMPLE, camera_parameters
from armland.plant.camera import STATE as CAMERA_STATE
from armland.plant.landing_camera import landing_camera, see_all
from armland.plant.landing_cycle import BRAKE, NOT_FINITE, act, sample
from armland.plant.landing_devices import ADDRESSES, PARAMETERS, SENSORS, STATE
from armland.plant.landing_faults import FaultSchedule
from armland.plant.landing_onboard import RING
from armland.plant.landing_pictures import Photographer, Pictures
from armland.plant.landing_scene import PLATE, Cradle, LandingGear, LandingScene, build_landing_scene
from armland.plant.magnet import Magnet, device
from armland.plant.noise import BLOCK, WhiteNoise, stream
from armland.plant.scene import ROTORS, UAV
from armland.rotations import Array, from_rotation_vector, matrix, multiply

UAV_WATCHDOG_S = 0.3
"""Silence of the link after which the UAV helps itself. Assumption; the AR.Drone's own watchdogs lie around it."""

BRAKE_NM = 300.0
"""Friction of a joint whose brake is on. Assumption: enough for any pose with its load."""

LOWEST_CRADLE_M = 0.1
"""Least height of the cradle's rails above the floor: its legs stand on it."""

CLIMB_M = 0.4
"""How far a flying UAV without link climbs away."""


class Draw(NamedTuple):
    """What a seed makes of the imperfections."""

    position: Array  # (3,) m, pivot at the start, world
    velocity: Array  # (3,) m/s
    heading: float  # rad
    wrench_bias: Array  # (6,) N, N·m
    imu_bias: Array  # (4,)
    thrust_factor: float


def draw(scenario: LandingScenario, start: Array) -> Draw:
    """Start and imperfections of the scenario's seed about `start` (3,) m; independent of everything else that is random."""
    landing, rng = scenario.landing, stream(scenario.landing.seed, "landing")
    place, bad = landing.place, landing.imperfections
    u = rng.uniform(-1.0, 1.0, 20)
    tilt = np.deg2rad(bad.tilt_error_deg) * np.array([u[7], u[8], 0.0])
    heading = np.array([0.0, 0.0, np.deg2rad(bad.heading_error_deg) * u[9]])
    return Draw(
        position=start + u[:3] * place.start_offset_m,
        velocity=u[3:6] * place.start_speed_mps,
        heading=float(np.deg2rad(place.start_heading_deg) * u[6]),
        wrench_bias=np.concatenate([bad.force_bias_n * u[10:13], bad.torque_bias_nm * u[13:16]]),
        imu_bias=multiply(from_rotation_vector(heading), from_rotation_vector(tilt)),
        thrust_factor=float(1.0 + bad.thrust_error * u[16]),
    )


class LandingPlant:
    """Arm, magnet, camera, force-torque sensor, UAV with its hinge plate, cradle.

    Args:
        scenario: what to simulate.
        home: joint positions at the start (n,), rad.
        start: `air` puts the UAV above the catch, `cradle` on the rails with its rotors stopped.
        photographer: looks at real pictures in place of the camera's measurement model.
    """

    def __init__(
        self,
        scenario: LandingScenario,
        home: Array,
        start: Literal["air", "cradle"] = "air",
        photographer: Photographer | None = None,
    ) -> None:
        self.scenario = scenario
        gear = landing_gear(scenario)
        self.scene: LandingScene = build_landing_scene(scenario.demonstrator, gear)
        _load(self.scene, scenario.landing.extra_mass_kg)
        self.data = mujoco.MjData(self.scene.model)
        self._home, self._start = np.asarray(home, dtype=float), start
        self._magnet_p, self._magnet_s = device(self.scene.model, PLATE, gear.magnet)
        self._rated = float(self._magnet_p["rated"][0])
        self._draw = draw(
            scenario, np.array(scenario.landing.place.catch_m) + [0, 0, scenario.landing.place.start_above_m]
        )
        self._parameters = _parameters(scenario, self.scene, self._draw)
        self._state, self._camera_s, self._sample = np.zeros(1, STATE), np.zeros(1, CAMERA_STATE), np.zeros(1, SAMPLE)
        eye = scenario.landing.eye
        self._camera_p = camera_parameters(landing_camera(scenario.landing), scenario.demonstrator.run.rate_hz)
        self._pictures = Pictures(photographer) if photographer is not None else None
        if self._pictures is not None:
            see_all(self._camera_p)
        self._eye = np.array([eye.camera_m, eye.marker_m])
        self._addresses = np.zeros(1, ADDRESSES)
        first = self.scene.model.joint(int(self.scene.model.dof_jntid[self.scene.joint_dof[0]])).name
        for name in SENSORS:
            self._addresses[name] = self.scene.sensor[f"{name}_{first}" if name in ("q", "qd", "tau") else name]
        d = self.data
        self._physics = d.ctrl, self.scene.uav_body, d.geom_xpos, d.geom_xmat, d.xipos
        limits = self.scene.model.jnt_actfrcrange[self.scene.model.dof_jntid[self.scene.joint_dof]]
        self._tau_max = np.abs(limits).min(axis=1)
        self._friction = self.scene.model.dof_frictionloss[self.scene.joint_dof].copy()
        self._solimp, self._braked = self.scene.model.dof_solimp[self.scene.joint_dof].copy(), 0
        elbow = int(self.scene.model.dof_bodyid[self.scene.joint_dof[self.scene.joints // 2]])
        self._bodies = {"uav": self.scene.uav_body, "tool": int(self._magnet_p["tool"][0]), "elbow": elbow}
        phases = tuple(p.name for p in (LANDING if start == "air" else takeoff_phases(scenario.landing)))
        self.faults = FaultSchedule(
            scenario.landing.faults, phases, scenario.demonstrator.run.rate_hz, self.scene.joints
        )
        self._tick = 0

    def connect(self) -> None:
        """Put everything at its start: arm at home and at rest, the UAV hovering by itself or standing on the cradle."""
        s, d, drawn = self.scene, self.data, self._draw
        mujoco.mj_resetData(s.model, d)
        d.qpos[s.joint_qpos] = self._home
        flying = self._start == "air"
        pivot = drawn.position if flying else s.put_down + [0.0, 0.0, 2e-4]
        quat = from_rotation_vector(np.array([0.0, 0.0, drawn.heading if flying else 0.0]))
        d.qpos[s.uav_qpos[:3]] = pivot - matrix(quat) @ np.array(self.scenario.demonstrator.uav.lever_m)
        d.qpos[s.uav_qpos[3:]] = quat
        self._state[:] = np.zeros(1, STATE)
        self._camera_s[:] = np.zeros(1, CAMERA_STATE)
        self._magnet_s[:] = np.zeros(1, self._magnet_s.dtype)
        self._magnet_p["health"], self._magnet_p["rated"] = 1.0, self._rated
        self._brake(False)
        self._braked = 0
        self._state["health"], self._state["sent"] = 1.0, -1
        self._state["integral"][0, 2] = 9.81 * (1.0 / drawn.thrust_factor - 1.0)
        if flying:
            d.qvel[s.uav_dof[:3]] = drawn.velocity
            thrust = s.uav_mass * 9.81 / drawn.thrust_factor
            self._state["rotor"] = self._state["rotor_asked"] = thrust / ROTORS * drawn.thrust_factor
            d.xfrc_applied[s.uav_body] = [0.0, 0.0, s.uav_mass * 9.81, 0.0, 0.0, 0.0]
            self._state["lift"] = self._state["rotor"]
            self._state["rotor_due"] = self._state["rotor"]
        self._state["arrived"][0, 5] = UavMode.AUTONOMOUS if flying else UavMode.OFF
        self._state["arrived"][0, 0] = 1.0
        mujoco.mj_forward(s.model, d)
        d.ctrl[:] = -d.qfrc_smooth[s.joint_dof]
        mujoco.mj_forward(s.model, d)
        self._state["down"][0, 0, :4] = multiply(drawn.imu_bias, d.sensordata[s.sensor["quat"] :][:4].copy())
        self._noise = WhiteNoise(self.scenario.landing.seed, "landing devices", 2 * s.joints + 15 + NOISE_WIDTH)
        self.faults.reset()
        self._tick = 0

    def read(self, tick: LandingTick) -> None:
        """Fill measurement and truth of `tick`."""
        if self._tick % BLOCK == 0:
            self._noise.draw()
        sample(
            self._tick,
            self.data.sensordata,
            self._addresses,
            self._parameters,
            self._state,
            self._noise.rows[self._tick % BLOCK],
            self._eye,
            self._camera_p,
            self._camera_s,
            self._sample,
            self._magnet_s,
            tick.measurement,
            tick.truth,
        )
        if self._pictures is not None:
            self._show(self._pictures, tick.measurement)
        if self.faults:
            self.faults.corrupt(tick.measurement)

    def _show(self, pictures: Pictures, m: np.ndarray) -> None:
        rate = self.scenario.landing.eye.rate_hz
        if (self._tick * rate) % self.scenario.demonstrator.run.rate_hz < rate:
            pictures.expose(self._tick, self.data.qpos, self.data.qvel, bool(self._state["camera_frozen"][0]))
        if m["camera_fresh"][0]:
            m["camera_fresh"] = pictures.deliver(self._sample)
            m["camera_position"], m["camera_quat"] = self._sample["position"], self._sample["quat"]

    def command(self, tick: LandingTick) -> None:
        """Apply the command of `tick` and step the physics once.

        Raises:
            PlantError: command or state are no longer finite.
        """
        if self.faults:
            self.faults.apply(self._tick, int(tick.mission["phase"][0]), self._state, self._magnet_p, self._rated)
        d = self.data
        what = act(
            self._tick,
            tick.command,
            tick.truth,
            self._braked,
            self._tau_max,
            self._parameters,
            self._state,
            self._noise.rows[self._tick % BLOCK],
            *self._physics,
            self._magnet_p,
            self._magnet_s,
            d.xfrc_applied,
        )
        if what == NOT_FINITE:
            raise PlantError(f"command or state of tick {self._tick} are not finite numbers")
        if what == BRAKE:
            self._braked = int(tick.command["brake"][0])
            self._brake(self._braked == 1)
        if self.faults:
            self.faults.push(d.xfrc_applied, self._bodies)
        mujoco.mj_step(self.scene.model, d)
        self._tick += 1

    def _brake(self, on: bool) -> None:
        m, dof = self.scene.model, self.scene.joint_dof
        m.dof_frictionloss[dof] = BRAKE_NM if on else self._friction
        # MuJoCo's friction is soft: as it stands by default a brake under load creeps by a degree per second.
        m.dof_solimp[dof] = [0.9999, 0.9999, 0.001, 0.5, 2.0] if on else self._solimp

    def stop(self) -> None:
        """Nothing to let go of in a simulation. Never raises."""


def landing_gear(scenario: LandingScenario) -> LandingGear:
    """Gear of a scenario: its magnet, and the cradle where the UAV shall be put down.

    Raises:
        ConfigurationError: the rails would lie on the floor.
    """
    gear, down = LandingGear(), np.array(scenario.landing.place.put_down_m)
    # The skids' lower edge lies on the rails.
    down[2] += gear.skids.z - gear.skids.radius - scenario.demonstrator.uav.lever_m[2]
    if down[2] < LOWEST_CRADLE_M:
        raise ConfigurationError(
            f"place.put_down_m = {scenario.landing.place.put_down_m} puts the cradle's rails {down[2]:.3f} m above the floor; "
            f"they must lie at least {LOWEST_CRADLE_M:g} m above it"
        )
    x, y, z = (round(float(c), 9) for c in down)
    magnet = Magnet(rated_force=scenario.landing.magnet_rating_n)
    return gear._replace(magnet=magnet, cradle=Cradle(position=(x, y, z)), eye=scenario.landing.eye)


def _load(scene: LandingScene, mass: float) -> None:
    if mass > 0.0:
        scene.model.body_mass[scene.uav_body] += mass
        mujoco.mj_setConst(scene.model, mujoco.MjData(scene.model))


def _parameters(scenario: LandingScenario, scene: LandingScene, drawn: Draw) -> np.ndarray:
    p, landing = np.zeros(1, PARAMETERS), scenario.landing
    rate = scenario.demonstrator.run.rate_hz
    link, onboard, rotors, sensors = (
        scenario.demonstrator.link,
        scenario.demonstrator.onboard,
        scenario.demonstrator.rotors,
        scenario.demonstrator.sensors,
    )
    p["uplink"], p["downlink"] = round(link.uplink_delay_ms * rate / 1000), round(link.downlink_delay_ms * rate / 1000)
    if max(p["uplink"][0], p["downlink"][0]) >= RING:
        raise ConfigurationError(f"the link's delays must stay below {(RING - 1) * 1000.0 / rate:g} ms")
    p["link_period"], p["onboard_period"] = rate // link.rate_hz, rate // onboard.rate_hz
    p["watchdog"], p["climb"] = round(UAV_WATCHDOG_S * rate), CLIMB_M
    p["kp"], p["kd"], p["lead"] = landing.onboard_kp_nm, landing.onboard_kd_nms, landing.onboard_lead_s
    p["watch"] = landing.onboard_rotor_watch
    p["onboard_s"], p["mass"], p["tick_s"] = 1.0 / onboard.rate_hz, scene.uav_mass + landing.extra_mass_kg, 1.0 / rate
    position = np.array([scene.model.site(f"{UAV}rotor_{i + 1}").pos for i in range(ROTORS)])
    A = mixer(position - scene.model.site(f"{UAV}cm").pos, rotors.drag_torque_m)
    p["mixer"], p["mixer_inverse"] = A, np.linalg.inv(A)
    p["rotor_min"], p["rotor_max"] = rotors.min_thrust_n, rotors.max_thrust_n
    p["rotor_gain"] = 1.0 - np.exp(-1.0 / (rate * rotors.time_constant_s))
    inflow = landing.rotors
    p["inflow"], p["disc"], p["slope"] = inflow.inflow, disc_of(inflow.radius_m, inflow.density_kgm3), inflow.slope
    p["advance"], p["drag"] = advance_of(inflow.slope, inflow.inflow_ratio), inflow.drag_nspm
    p["thrust_factor"], p["imu_bias"], p["wrench_bias"] = drawn.thrust_factor, drawn.imu_bias, drawn.wrench_bias
    p["filter_gain"] = 1.0 - np.exp(-2.0 * np.pi * sensors.force_filter_hz / rate)
    p["hover_noise"] = landing.imperfections.hover_noise_m
    if landing.imperfections.noise:
        p["sigma_q"], p["sigma_qd"] = sensors.joint_position_rad, sensors.joint_velocity_rad_s
        p["sigma_force"], p["sigma_torque"] = sensors.force_n, sensors.torque_nm
        p["sigma_attitude"], p["sigma_rate"] = sensors.attitude_rad, sensors.rate_rad_s
    return p
