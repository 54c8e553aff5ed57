"""From a scenario and a mission without an arm to everything that its controller is made of."""

from typing import NamedTuple

import numpy as np

from armland.mission.belief import flyer
from armland.mission.feasibility.keys import check_keys
from armland.mission.feasibility.weight import check_weight
from armland.mission.missions.weather import judged, weathered
from armland.mission.reference.path import Leg
from armland.mission.registry import mission_named
from armland.mission.table.mission import Mission
from armland.mission.table.phases import Phase
from armland.mission.unaided.told import tell
from armland.models.environment import on_land
from armland.records import Records
from armland.rotations import Array
from armland.scenario import Scenario


class UnaidedPlan(NamedTuple):
    """What the controller of a mission without an arm is made of; what `mission.plan.Plan` has, too, has the same name."""

    mission: Mission
    scenario: Scenario
    """As it is believed."""
    phases: tuple[Phase, ...]
    told: Records
    environment: Records
    ticks: int
    """Most ticks of the run."""
    watch: int
    """Ticks for which a mission that has ended is watched further."""
    weight_n: float
    """Of all that flies."""
    experiment: None = None
    law: None = None
    law_name: str = "deck_tracking"
    legs: tuple[Leg, ...] = ()
    joints: int = 0
    """Things that the ground moves."""

    @property
    def thresholds(self) -> dict[str, float]:
        """Of guards: none, the scenario's `descent` has them."""
        return {}

    @property
    def home(self) -> Array:
        """Where what the ground moves is at first (n,)."""
        return np.zeros(self.joints)

    @property
    def names(self) -> tuple[str, ...]:
        """What the mission's phases are called, by their numbers."""
        return tuple(p.name for p in self.phases)

    def again(self, seed: int) -> "UnaidedPlan":
        """The same for another seed."""
        return self._replace(scenario=self.scenario.with_seed(seed))


def unaided_plan(scenario: Scenario, mission: str) -> UnaidedPlan:
    """Check a mission without an arm and work out everything that its controller needs, from what the scenario believes.

    Raises:
        ConfigurationError: whatever is refused, with the value, the bound and what would have worked.
    """
    value = mission_named(mission)
    check_keys(scenario.own, value)
    believed = scenario.believed()
    flies, run = flyer(believed), scenario.run
    value, believed = judged(value, believed, flies.weight), weathered(believed, flies.mass)
    check_weight(believed, flies, False, False)
    stand, eye = places(believed, flies.body.lever)
    return UnaidedPlan(
        mission=value,
        scenario=believed,
        phases=value.phases(believed),
        told=tell(believed, flies, stand, eye, believed.tether.pull_n if mission == "tether" else 0.0),
        environment=on_land(believed.environment.gravity_mps2),
        ticks=round(run.duration_s * run.rate_hz),
        watch=round(run.watch_s * run.rate_hz),
        weight_n=flies.weight,
    )


def places(scenario: Scenario, lever: Array) -> tuple[Array, Array]:
    """Pivot of a UAV that stands in the middle of the pad, and the optical centre below its window, (3,) each, m, D.

    Args:
        scenario: its pad, skids and camera.
        lever: centre of mass to the pivot (3,), m, B.
    """
    skids, catch, pad = scenario.skids, scenario.place.catch_m, scenario.pad
    stand = np.array([catch[0], catch[1], pad.height_m + skids.radius_m - skids.z_m + lever[2]])
    beside = np.array(scenario.camera.marker_m[:2]) - lever[:2]
    return stand, np.array([*(stand[:2] + beside), pad.height_m - pad.recess_m])
