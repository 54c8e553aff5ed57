"""A landing in simulation that can be put back to a moment and flown on from there, as often as asked."""

from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.errors import PlantError
from armland.mission.landing_controller import LandingController
from armland.mission.landing_scenario import LandingScenario
from armland.mission.landing_setup import set_up
from armland.mission.records import LandingTick
from armland.plant.landing import LandingPlant
from armland.plant.landing_devices import STATE


def quiet(scenario: LandingScenario, camera: bool = False) -> LandingScenario:
    """The scenario without imperfections, faults and differences between seeds; `camera`: whether its imperfections stay."""
    landing = scenario.landing
    none = dict.fromkeys(type(landing.imperfections).model_fields, 0.0) | {"camera": camera, "noise": False}
    place = {"start_offset_m": (0.0, 0.0, 0.0), "start_speed_mps": 0.0, "start_heading_deg": 0.0}
    update = {
        "imperfections": landing.imperfections.model_copy(update=none),
        "place": landing.place.model_copy(update=place),
        "faults": (),
    }
    return scenario._replace(landing=landing.model_copy(update=update))


class Flight:
    """Plant, controller and messages of one landing.

    Args:
        scenario: of `landing_scenario`.

    Raises:
        ConfigurationError: what `set_up` refuses.
    """

    def __init__(self, scenario: LandingScenario) -> None:
        self.scenario, self.rate = scenario, scenario.demonstrator.run.rate_hz
        self.setup = set_up(scenario)
        self.plant = LandingPlant(scenario, self.setup.home)
        self.controller = LandingController(self.setup)
        self.tick = LandingTick(self.setup.arm.joints)
        self._data = mujoco.MjData(self.plant.scene.model)
        self.plant.connect()

    def step(self) -> None:
        """One tick."""
        self.plant.read(self.tick)
        self.controller.update(self.tick)
        self.plant.command(self.tick)

    def fly_until(self, there: Callable[[], bool], what: str) -> None:
        """Fly until `there` and keep that moment.

        Raises:
            PlantError: the mission ended, or its time was over, before it came to `what`.
        """
        for _ in range(round(self.scenario.landing.duration_s * self.rate)):
            self.step()
            if there():
                return self._keep()
            if self.controller.final:
                break
        raise PlantError(f"the landing ended in phase {self.controller.phase!r} and never came to {what}")

    def _keep(self) -> None:
        # From here on every run draws the same numbers, whatever was run before.
        self.plant._noise.draw = lambda: None  # type: ignore[method-assign]
        owners = (self.plant, self.controller)
        self._arrays = [self.tick.buffer, *(a for owner in owners for a in _arrays(list(vars(owner).values())))]
        self._kept = [a.copy() for a in self._arrays]
        self._numbers = [(o, {k: v for k, v in vars(o).items() if isinstance(v, bool | int | float)}) for o in owners]
        mujoco.mj_copyData(self._data, self.plant.scene.model, self.plant.data)

    def restore(self) -> None:
        """Back to the moment that was kept."""
        for a, b in zip(self._arrays, self._kept, strict=True):
            a[...] = b
        for owner, numbers in self._numbers:
            vars(owner).update(numbers)
        mujoco.mj_copyData(self.plant.data, self.plant.scene.model, self._data)

    def memory(self, layout: np.dtype) -> NDArray[np.void]:
        """What plant or controller keeps with this `layout`."""
        return next(a for a in self._arrays if a.dtype == layout)

    @property
    def devices(self) -> NDArray[np.void]:
        """State of the devices."""
        return self.memory(STATE)


def _arrays(values: list[Any]) -> list[NDArray[Any]]:
    """The arrays that can be written among `values` and inside their tuples and lists."""
    found: list[NDArray[Any]] = []
    for value in values:
        if isinstance(value, np.ndarray) and value.flags.writeable:
            found.append(value)
        elif isinstance(value, tuple | list):
            found += _arrays(list(value))
    return found
