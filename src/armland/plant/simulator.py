"""The simulated demonstrator behind the port: connect, read, command, stop. The only place that steps physics in Python."""

from typing import Any

import mujoco
import numpy as np
from numba import njit

from armland.control.laws.station_keeping import attitude_of
from armland.errors import PlantError
from armland.linking import link
from armland.mission.controller import Controller
from armland.models.airframe.allocation import share_out
from armland.plant.block import fly_block
from armland.plant.cycle import APPLIED, Views, actuate, sense, views_of
from armland.plant.deviation.bodies import deviate_bodies
from armland.plant.deviation.devices import deviate_devices
from armland.plant.deviation.drawn import Values, drawn
from armland.plant.devices import brake
from armland.plant.devices.camera_numbers import see_all
from armland.plant.draw import Start, draw
from armland.plant.faults import table as faults
from armland.plant.noise import BLOCK, Noise, NoiseSource
from armland.plant.pictures import Photographer, Pictures
from armland.plant.scene.composition import Scene, build_scene
from armland.plant.sea.timed import on_deck, timed_deck, velocity_on_deck
from armland.plant.wind.limits import lift_gain, steady_wind
from armland.plant.wind.timed import timed_wind
from armland.plant.world import absent, build_world
from armland.records import MOST_ROTORS, Records, Tick, UavMode, layout
from armland.rotations import Array, from_rotation_vector, matrix, multiply
from armland.scenario import Scenario


class Simulator:
    """Arm, force-torque sensor, UAV and the gear of a mission in MuJoCo, with all devices.

    One tick is one cycle of a real bus: `read` gives what the sensors sampled at the start of the last step, `command` acts
    from now on until the next. A compiled loop does the same with `world`, `views`, `noise` and the addresses of `scene.model`
    and `data`, and draws noise by `draw_noise` before each tick that is a multiple of `noise.BLOCK`.

    Args:
        scenario: what to simulate.
        home: joint positions at the start (n,), rad.
        start: where the UAV is at first.
        phases: names of the mission's phases, in the order of the numbers in `tick.mission`; faults are armed by them.
        photographer: looks at real pictures in place of the camera's measurement model; then only the Python loop works.
        scene: another one than that of the scenario's arm.

    Raises:
        ConfigurationError: a scenario that cannot be simulated, or faults of the camera that cannot act on pictures.
        PlantError: a camera that cannot be.
    """

    def __init__(
        self,
        scenario: Scenario,
        home: Array,
        start: Start,
        phases: tuple[str, ...] = (),
        photographer: Photographer | None = None,
        scene: Scene | None = None,
    ) -> None:
        self.scenario, self.start = scenario, start
        self.scene: Scene = scene or build_scene(scenario, "hinged" if start == "hinged" else "free")
        self._link()
        self.data = mujoco.MjData(self.scene.model)
        self.drawn = draw(scenario, start)
        self.deviations: Values = {}
        self.world: Records = build_world(scenario, self.scene, start, self.drawn, phases)
        if start != "hinged":
            self._deviate()
        self.views: Views = views_of(self.scene.model, self.data)
        self.noise_source = NoiseSource(scenario.run.seed, self.scene.joints, absent(self.world))
        self.tick, self.timed_wind, self.timed_deck = 0, timed_wind(scenario), timed_deck(scenario)
        self._home = np.asarray(home, dtype=float)
        self._applied: Records = np.zeros(1, layout("command", self.scene.joints))
        self._pictures = Pictures(photographer) if photographer is not None else None
        if self._pictures is not None:
            faults.refuse_detected(scenario)
            see_all(self.world["told"]["camera"])

    def _link(self) -> None:
        link(self.scene.joints)

    def _deviate(self) -> None:
        # A UAV that is hinged on the arm has been calibrated there.
        self.deviations = drawn(self.scenario, self.scene.joints)
        if self.deviations:
            self.scene = deviate_bodies(self.deviations, self.scenario, self.scene)
            deviate_devices(self.deviations, self.scenario, self.scene, self.world["told"])

    @property
    def noise(self) -> Noise:
        """The block of noise in use; the same arrays for good."""
        return self.noise_source.rows

    @property
    def compilable(self) -> bool:
        """Whether a compiled loop does the same as `read` and `command`: not where pictures are taken."""
        return self._pictures is None

    @property
    def acted(self) -> tuple[bool, ...]:
        """For each fault of the scenario whether it has ever acted since `connect`."""
        return tuple(bool(a) for a in self.world["kept"]["faults"]["acted"][0, : len(self.scenario.faults)])

    def connect(self) -> None:
        """Put everything at its start: arm at home and at rest, the UAV level on the hinge, in hover, or on the cradle."""
        m, d, s = self.scene.model, self.data, self.scene
        mujoco.mj_resetData(m, d)
        self._forget()
        d.qpos[s.joint_qpos] = self._home
        if len(self.timed_deck):
            d.qpos[s.deck_qpos :][:6], d.qvel[s.deck_dof :][:6] = self.timed_deck[0, :6], self.timed_deck[0, 6:12]
        if self.start == "hinged":
            self._hinge()
        else:
            self._put()
        mujoco.mj_forward(m, d)
        # The motors hold what gravity and the rotors leave: the arm is handed over standing still.
        d.ctrl[:] = -d.qfrc_smooth[s.joint_dof]
        mujoco.mj_forward(m, d)
        quat = d.sensordata[s.sensor["quat"] :][:4].copy()
        self.world["kept"]["link"]["down"]["quat"][0, 0] = multiply(self.drawn.imu_bias, quat)
        self.world["kept"]["link"]["down"]["rotors"][0, 0] = self.world["kept"]["rotors"]["asked"][0]
        self.noise_source.restart()
        self.tick = 0

    def _forget(self) -> None:
        told, kept, views = self.world["told"], self.world["kept"], self.views
        kept[:] = np.zeros_like(kept)
        faults.reset(kept["faults"], told["faults"])
        brake.switch(told["brake"][0], kept["brake"][0], views.dof_frictionloss, views.dof_solimp)
        link = kept["link"]
        link["up"]["sent"], link["down"]["sent"], link["received"], link["arrived"]["sent"] = -1, -1, -1, -1
        link["arrived"]["quat"] = [1.0, 0.0, 0.0, 0.0]

    def _hinge(self) -> None:
        s, d, thrust = self.scene, self.data, self.scenario.control.thrust_n
        mujoco.mj_kinematics(s.model, d)
        d.qpos[s.hinge_qpos] = level_hinge(d.xmat[s.uav_body].reshape(3, 3))
        self._spin(thrust, thrust)
        arrived = self.world["kept"]["link"]["arrived"]
        arrived["thrust"], arrived["mode"] = thrust, UavMode.HINGED

    def _put(self) -> None:
        s, d, drawn, kept = self.scene, self.data, self.drawn, self.world["kept"]
        flying, gravity = self.start == "air", -self.scenario.environment.gravity_mps2[2]
        pivot = drawn.position if flying else s.put_down + [0.0, 0.0, 2e-4]
        quat = from_rotation_vector(np.array([0.0, 0.0, drawn.heading if flying else 0.0]))
        if len(self.timed_deck):
            pivot, quat = on_deck(self.timed_deck[0], pivot, quat, level=flying)
        told, weight = self.world["told"], float(s.model.body_subtreemass[s.uav_body]) * gravity
        believed, factor = (
            told["onboard"]["mass"][0],
            _mean(told["rotors"]["gain"][0, : told["rotors"]["count"][0]]),
        )
        lift, pull = np.array([0.0, 0.0, weight]), weight
        if flying and told["air"]["moves"][0]:
            # It has hovered for long: it leans against the wind.
            wind = told["air"]["mean"][0]
            if told["air"]["blows"][0]:
                wind = wind + steady_wind(self.scenario, float(told["air"]["floor"][0] + pivot[2]), self.timed_wind)
            lift = lift - told["rotors"]["drag"][0] * wind
            quat = attitude_of(lift, drawn.heading)
            if told["air"]["blows"][0]:
                gain = lift_gain(told["rotors"][0], float(np.linalg.norm(lift)), wind, matrix(quat)[:, 2])
                factor, pull = factor * gain, float(np.linalg.norm(lift)) / gain
        d.qpos[s.uav_qpos[:3]] = pivot - matrix(quat) @ s.lever
        d.qpos[s.uav_qpos[3:]] = quat
        # A UAV that hovers knows what its rotors really give.
        needed = weight / (believed * gravity) / factor
        kept["onboard"]["integral"][0, 2] = gravity * (needed - 1.0) + told["onboard"]["trim"][0]
        if flying and (self.deviations or told["air"]["blows"][0]):
            # Sideways, too: against the wind, and against what it gets wrong about its own tilt.
            seen = matrix(multiply(told["imu"]["bias"][0], quat))[:, 2]
            kept["onboard"]["integral"][0, :2] = np.linalg.norm(lift) / (believed * factor) * seen[:2]
        kept["link"]["arrived"]["mode"] = UavMode.AUTONOMOUS if flying else UavMode.OFF
        if not flying and len(self.timed_deck):
            d.qvel[s.uav_dof] = velocity_on_deck(self.timed_deck[0], d.qpos[s.uav_qpos[:3]], matrix(quat))
        if flying:
            d.qvel[s.uav_dof[:3]] = drawn.velocity
            self._spin(pull / factor, weight, factor)

    def _spin(self, asked: float, thrust: float, factor: float = 1.0) -> None:
        # All rotors turn as if they had been asked for `asked` N long ago, and give `thrust` N upwards.
        hover = self._hover(asked * factor)
        for name in ("asked", "static", "due", "lift"):
            self.world["kept"]["rotors"][name] = hover
        self.data.xfrc_applied[self.scene.uav_body] = [0.0, 0.0, thrust, 0.0, 0.0, 0.0]

    def _hover(self, thrust: float) -> Array:
        # Thrusts (8,) N that lift without turning; four upright rotors share alike.
        p, out = self.world["told"]["onboard"]["allocation"], np.zeros(MOST_ROTORS)
        if p["exact"][0]:
            out[:4] = thrust / 4
            return out
        out[:] = share_out(thrust, np.zeros(3), p[0])
        return out

    def draw_noise(self) -> None:
        """Draw the next block of noise."""
        self.noise_source.draw()
        ticks = np.arange(self.tick, self.tick + BLOCK)
        for rows, timed in ((self.noise.wind, self.timed_wind), (self.noise.deck, self.timed_deck)):
            if len(timed):
                rows[:] = timed[np.minimum(ticks, len(timed) - 1)]

    def read(self, tick: Tick) -> None:
        """Fill measurement and truth of `tick`."""
        if self.tick % BLOCK == 0:
            self.draw_noise()
        _sense(self.tick, self.world, self.views, self.noise, tick.measurement, tick.truth)
        if self._pictures is not None:
            self._show(self._pictures, tick.measurement)

    def _show(self, pictures: Pictures, m: Records) -> None:
        told, kept = self.world["told"]["camera"][0], self.world["kept"]
        if (self.tick * told["rate_hz"]) % told["base_hz"] < told["rate_hz"]:
            frozen = bool(kept["faults"]["camera"]["frozen"][0])
            pictures.expose(self.tick, self.data.qpos, self.data.qvel, frozen)
        if m["camera_fresh"][0]:
            sample = kept["camera"]["sample"]
            m["camera_fresh"] = pictures.deliver(sample)
            # What a failed device made of the position stays.
            if np.isfinite(m["camera_position"]).all():
                m["camera_position"] = sample["position"]
            m["camera_quat"] = sample["quat"]

    def command(self, tick: Tick) -> Records:
        """Apply the command of `tick` and step the physics once; returns the command (1,) as it was really applied.

        Raises:
            PlantError: command or state are no longer finite.
        """
        phase, c = int(tick.mission["phase"][0]), tick.command
        if _actuate(self.tick, self.world, self.views, self.noise, phase, c, tick.truth) != APPLIED:
            error = self.diverged(self.tick)
            raise error
        self._applied[:] = c
        self._applied["tau"] = self.views.ctrl
        mujoco.mj_step(self.scene.model, self.data)
        self.tick += 1
        return self._applied

    def advance(self, controller: Controller, rows: Records) -> tuple[int, PlantError | None]:
        """Fly on in compiled code until `rows` (k,) of `tick_layout` are full, the mission is over, or noise has to be drawn.

        Returns:
            How many rows were filled, and the error that ends the run where command or state are no longer finite after them.
        """
        if self.tick % BLOCK == 0:
            self.draw_noise()
        flown, status = fly_block(*self.block_arguments(controller, rows))
        self.tick += flown
        return int(flown), None if status == APPLIED else self.diverged(self.tick)

    def block_arguments(self, controller: Controller, rows: Records) -> tuple[Any, ...]:
        """What `block.fly_block` takes to fly on into `rows` (k,) of `tick_layout`, as far as the block of noise lasts."""
        k, plan = self.tick, controller.plan
        physics = self.scene.model._address, self.data._address
        brain = controller.board, plan.path, plan.arm.views
        return k, self.world, self.views, self.noise, physics, brain, plan.watch, rows[: BLOCK - k % BLOCK]

    def diverged(self, k: int) -> PlantError:
        """The error that ends a run whose tick `k` was refused as `NOT_FINITE`."""
        return PlantError(f"command or state of tick {k} are not finite numbers; are gains too high for the base rate?")

    def stop(self) -> None:
        """Nothing to let go of in a simulation. Never raises."""


def level_hinge(R: Array) -> Array:
    """Swivel, x and y angles (3,), rad, that level a hinged UAV with zero yaw: Rz Rx Ry = Rᵀ.

    Args:
        R: attitude (3, 3) of the end effector, a rotation W<-E.
    """
    E = R.T
    return np.array(
        [np.arctan2(-E[0, 1], E[1, 1]), np.arcsin(np.clip(E[2, 1], -1.0, 1.0)), np.arctan2(-E[2, 0], E[2, 2])]
    )


@njit(cache=True)
def _sense(k: int, world: Records, views: Views, noise: Noise, measurement: Records, truth: Records) -> None:
    sense(k, world[0], views, noise, measurement[0], truth[0])


@njit(cache=True)
def _actuate(k: int, world: Records, views: Views, noise: Noise, phase: int, command: Records, truth: Records) -> int:
    return int(actuate(k, world[0], views, noise, phase, command[0], truth[0]))


@njit(cache=True)
def _mean(gain: Array) -> float:
    # Added in pairs.
    return float(np.append(gain, np.zeros(len(gain) % 2)).reshape(-1, 2).sum(axis=1).sum()) / len(gain)
