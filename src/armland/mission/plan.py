"""From a scenario and a mission to everything that its controller is made of, with all refusals before anything moves."""

from typing import NamedTuple

import numpy as np

from armland.control.laws.own import OwnLaw
from armland.control.laws.settings import row_of
from armland.control.laws.table import EXACT
from armland.errors import ConfigurationError
from armland.mission.belief import Flyer, flyer, hinged
from armland.mission.feasibility.capture import check_capture
from armland.mission.feasibility.keys import check_by_hand, check_keys
from armland.mission.feasibility.launch import Carrying, Launch, plan_launch, timed
from armland.mission.feasibility.pace import paced
from armland.mission.feasibility.path import survey_path
from armland.mission.feasibility.reach import survey, targets
from armland.mission.feasibility.steadiness import steadied
from armland.mission.feasibility.touchdown import gently
from armland.mission.feasibility.weight import check_hinged_thrust, check_weight, flies_on
from armland.mission.missions.takeoff import gives_speed
from armland.mission.missions.weather import judged, weathered
from armland.mission.reference.path import Leg
from armland.mission.registry import mission_named
from armland.mission.supervisor.table import debounce_ticks, fault_rows
from armland.mission.table.arrays import compile_table
from armland.mission.table.mission import Mission
from armland.mission.table.phases import Phase
from armland.mission.table.thresholds import loads_of, shares_of, thresholds_of
from armland.mission.told import Telling, tell
from armland.mission.tuning import tuned
from armland.models.arm import ArmModel
from armland.models.environment import on_land
from armland.models.parameters import arm_model
from armland.models.posture import UPRIGHT
from armland.records import Records
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.control import Experiment


class Plan(NamedTuple):
    """What a mission's controller is made of."""

    mission: Mission
    scenario: Scenario
    """As it is believed, with the gains of the experiment."""
    experiment: str | None
    """Row of `[experiments]`."""
    arm: ArmModel
    home: Array
    """(n,) rad."""
    phases: tuple[Phase, ...]
    thresholds: dict[str, float]
    table: Records
    told: Records
    environment: Records
    path: Array
    """(k, 9), m, m/s, m/s², deck; (1, 9) zeros where the mission follows none."""
    legs: list[Leg]
    ticks: int
    """Most ticks of the run."""
    watch: int
    """Ticks for which a mission that has ended is watched further."""
    weight_n: float
    """Of all that flies."""
    thrust_n: float
    """That acts when the mission begins."""
    law_name: str
    law: OwnLaw | None
    """A user's own."""

    @property
    def joints(self) -> int:
        """Number of the arm's joints."""
        return self.arm.joints

    @property
    def names(self) -> tuple[str, ...]:
        """What the mission's phases are called, by their numbers."""
        return tuple(p.name for p in self.phases)

    def number(self, phase: str) -> int:
        """Index of the phase of that name."""
        return self.names.index(phase)

    def again(self, seed: int) -> "Plan":
        """The same for another seed, which nothing of a plan depends on, with an arm model of its own: two flights share no memory
        that is written to."""
        return self._replace(arm=arm_model(self.scenario), scenario=self.scenario.with_seed(seed))


def plan(
    scenario: Scenario,
    mission: str,
    law: str | None = None,
    trial: bool = False,
    experiment: str | None = None,
) -> Plan:
    """Check a mission and work out everything that its controller needs, from what the scenario believes.

    Args:
        scenario: what is wanted.
        mission: name of a row of `registry.MISSIONS`.
        law: row of the law table, or `FILE.py:FUNCTION`, for the held UAV; the scenario's or the mission's own if absent.
        trial: whether a UAV may be too heavy for its rotors: for a study that wants to see it fall.
        experiment: row of `[experiments]` that `track` flies.

    Raises:
        ConfigurationError: whatever is refused, with the value, the bound and what would have worked.
        WorkspaceError: a place or a path out of the arm's reach.
    """
    value = mission_named(mission)
    check_keys(scenario.own, value)
    believed = scenario.believed()
    if value.start == "hinged":
        return _path_plan(believed, value, law, _row(believed, value, experiment))
    return _flight_plan(believed, value, law, trial)


def _row(scenario: Scenario, mission: Mission, experiment: str | None) -> str:
    name = mission.experiment or experiment
    known = ", ".join(scenario.experiments) or "none"
    if name is None:
        raise ConfigurationError(f"mission {mission.name!r} needs the name of an experiment; the scenario has: {known}")
    if name not in scenario.experiments:
        raise ConfigurationError(f"experiments.{name}: the scenario has no such experiment; it has: {known}")
    return name


def _path_plan(scenario: Scenario, mission: Mission, law: str | None, row: str) -> Plan:
    check_hinged_thrust(scenario)
    arm, scenario = arm_model(scenario), tuned(scenario, row)
    c, carried, experiment = scenario.control, hinged(scenario), scenario.experiments[row]
    phases, work = mission.phases(scenario), survey_path(arm, scenario)
    chosen = row_of(law or c.law or experiment.law)
    nowhere = np.zeros((0, 3))
    told = tell(Telling(scenario, arm, carried, arm.qd_max, work.R_d, nowhere, experiment, chosen, mission.start, None))
    return Plan(
        mission=mission,
        scenario=scenario,
        experiment=row,
        arm=arm,
        home=work.home,
        told=told,
        path=work.path,
        legs=work.legs,
        ticks=len(work.path),
        watch=0,
        thrust_n=c.thrust_n,
        **_table(mission, phases, scenario, carried),
        law_name=chosen.name,
        law=chosen.own,
    )


def _flight_plan(scenario: Scenario, mission: Mission, law: str | None, trial: bool) -> Plan:
    arm, takes_off, run = arm_model(scenario), mission.start == "cradle", scenario.run
    flies = flyer(scenario)
    mission, scenario = judged(mission, scenario, flies.weight), weathered(scenario, flies.mass, mission.start == "air")
    check_weight(scenario, flies, takes_off and flies_on(scenario), trial)
    if not takes_off:
        check_capture(scenario, flies.mass)
    phases = mission.phases(scenario)
    # Contradictions are told before the arm is asked where it can go.
    _table(mission, phases, scenario, flies)
    home = survey(arm, scenario, mission, flies.weight)
    scenario = steadied(scenario, mission, arm, home)
    if not takes_off:
        check_by_hand(scenario, flies)
        scenario = gently(scenario, arm, home)
    phases = paced(phases, mission, arm, home, scenario, flies.weight)
    launch: Launch | None = None
    if takes_off and gives_speed(scenario):
        launch = plan_launch(Carrying(arm, arm.qd_max, flies.mass, scenario), home)
        phases = timed(phases, launch)
    chosen = row_of(law or scenario.control.law or "exact")
    # The published laws need the weight that the rotors leave from the model; the exact ones know it.
    switches = Experiment(acceleration="implied", support="none" if chosen.law >= EXACT else "model")
    ends = _targets(mission, phases, scenario, launch)
    told = tell(Telling(scenario, arm, flies, arm.qd_max, UPRIGHT, ends, switches, chosen, mission.start, launch, home))
    return Plan(
        mission=mission,
        scenario=scenario,
        experiment=None,
        arm=arm,
        home=home,
        told=told,
        path=np.zeros((1, 9)),
        legs=[],
        ticks=round(run.duration_s * run.rate_hz),
        watch=round(run.watch_s * run.rate_hz),
        thrust_n=0.0 if takes_off else flies.weight,
        **_table(mission, phases, scenario, flies),
        law_name=chosen.name,
        law=chosen.own,
    )


def _table(mission: Mission, phases: tuple[Phase, ...], scenario: Scenario, flies: Flyer) -> dict:
    # The fields of a plan that come from the mission's table.
    thresholds = thresholds_of(mission, scenario)
    tick_s = 1.0 / scenario.run.rate_hz
    table = compile_table(phases, thresholds, shares_of(scenario, flies.weight), loads_of(scenario), tick_s)
    table["faults"], table["debounce"] = fault_rows(phases, mission.faults, mission.escalation), debounce_ticks(tick_s)
    environment = on_land(scenario.environment.gravity_mps2)
    return {
        "phases": phases,
        "thresholds": thresholds,
        "table": table,
        "environment": environment,
        "weight_n": flies.weight,
    }


def _targets(mission: Mission, phases: tuple[Phase, ...], scenario: Scenario, launch: Launch | None) -> Array:
    ends, names = targets(mission, phases, scenario), [p.name for p in phases]
    if launch is not None:
        ends[names.index("carry_up")] = scenario.place.launch_m
        ends[names.index("bring")] = ends[names.index("hand_back")] = launch.start
    return ends
