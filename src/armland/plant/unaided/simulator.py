"""The simulated world of a landing without an arm behind the same port."""

import numpy as np

from armland.errors import PlantError
from armland.mission.unaided.controller import UnaidedController, link_needed
from armland.mission.unaided.plan import UnaidedPlan
from armland.plant.cycle import APPLIED
from armland.plant.deviation.bodies import value
from armland.plant.noise import BLOCK
from armland.plant.scene.pad import PAD, build_pad_scene
from armland.plant.simulator import Simulator
from armland.plant.unaided.block import fly_unaided
from armland.records import Records
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
        super().__init__(scenario, plan.home, "air", plan.names, scene=build_pad_scene(scenario))

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
        some, board = rows[: BLOCK - k % BLOCK], controller.board
        flown, status = fly_unaided(k, self.world, self.views, self.noise, physics, board, controller.plan.watch, some)
        self.tick += flown
        return int(flown), None if status == APPLIED else self.diverged(self.tick)
