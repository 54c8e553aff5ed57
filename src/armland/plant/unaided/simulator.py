"""The simulated world of a landing without an arm behind the same port."""

import mujoco
import numpy as np

from armland.errors import PlantError
from armland.mission.unaided.controller import UnaidedController, link_needed
from armland.mission.unaided.plan import UnaidedPlan
from armland.plant.cycle import APPLIED
from armland.plant.deviation.bodies import value
from armland.plant.noise import BLOCK, stream
from armland.plant.scene.pad import PAD, build_pad_scene
from armland.plant.scene.platform import has_platform
from armland.plant.simulator import Simulator
from armland.plant.unaided import hexapod, tether
from armland.plant.unaided.block import act_on, fly_unaided
from armland.records import Records, Tick
from armland.scenario import Scenario

NEEDED = ("look", "sense", "actuate")
"""Linked functions that it calls."""


class PadSimulator(Simulator):
    """UAV, pad and deck with all devices, as `Simulator` has them.

    Args:
        scenario: what to simulate.
        plan: of the mission.

    Raises:
        ConfigurationError: a scenario that cannot be simulated.
    """

    def __init__(self, scenario: Scenario, plan: UnaidedPlan) -> None:
        scene = build_pad_scene(scenario, plan.mission.name == "hexapod")
        self.machine: Records = np.zeros(1, hexapod.layout())
        self.tether: Records = np.zeros(1, tether.layout())
        self._hull_noise = np.zeros((BLOCK, 12))
        self._hull = stream(scenario.run.seed, "hull")
        super().__init__(scenario, plan.home, "air", plan.names, scene=scene)
        if has_platform(self.scene.model):
            hexapod.tell(self.machine, scenario, self.scene, self.world["told"]["reference"])
        if plan.mission.name == "tether":
            tether.tell(self.tether, scenario, self.scene)

    def connect(self) -> None:
        """Put everything at its start; the platform in its neutral pose."""
        if self.machine["fitted"].any():
            hexapod.forget(self.machine)
            self._hull = stream(self.scenario.run.seed, "hull")
        tether.forget(self.tether)
        super().connect()

    def draw_noise(self) -> None:
        """Draw the next block of noise."""
        super().draw_noise()
        if self.machine["fitted"].any():
            self._hull.standard_normal(out=self._hull_noise)

    def command(self, tick: Tick) -> Records:
        """Apply the command of `tick` and step the physics once, as `Simulator.command`."""
        phase = int(tick.mission["phase"][0])
        given = self.world, self.views, self.noise, phase, tick.command, tick.truth
        machine = self.machine, self._hull_noise, self.tether
        if act_on(self.tick, *given, machine) != APPLIED:
            error = self.diverged(self.tick)
            raise error
        self._applied[:] = tick.command
        mujoco.mj_step(self.scene.model, self.data)
        self.tick += 1
        return self._applied

    def _link(self) -> None:
        link_needed(NEEDED, self.scene.joints)

    def _deviate(self) -> None:
        super()._deviate()
        model = self.scene.model
        pad = model.geom(PAD).id
        pairs = np.isin(model.pair_geom1, [pad]) | np.isin(model.pair_geom2, [pad])
        # Skids on a pad differ as skids on rails do.
        model.pair_friction[pairs, :2] *= 1.0 + value(self.deviations, "cradle.friction")

    def advance(self, controller: UnaidedController, rows: Records) -> tuple[int, PlantError | None]:  # type: ignore[override]
        """Fly on in compiled code, as `Simulator.advance`, with the controller of a UAV without an arm."""
        if self.tick % BLOCK == 0:
            self.draw_noise()
        k, physics = self.tick, (self.scene.model._address, self.data._address)
        some, machine = rows[: BLOCK - k % BLOCK], (self.machine, self._hull_noise, self.tether)
        brain = controller.board, controller.plan.watch
        flown, status = fly_unaided(k, self.world, self.views, self.noise, physics, brain, machine, some)
        self.tick += flown
        return int(flown), None if status == APPLIED else self.diverged(self.tick)
