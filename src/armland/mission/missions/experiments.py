"""The paper's experiments E1 to E3, and any other row of `[experiments]`: the UAV on the arm's hinge, along a path."""

from armland.errors import ConfigurationError
from armland.mission.missions.keys import HINGED, SHARED
from armland.mission.supervisor.ends import HINGED_FINALS
from armland.mission.table.mission import Criterion, Mission
from armland.mission.table.phases import Phase
from armland.scenario import Scenario
from armland.scenario.mission import Trajectory

GRACE_S = 1.0
"""By how much a phase's time-out is longer than the phase."""

DOC = """The UAV is bound to the arm by its hinge throughout. The arm follows the scenario's `[trajectory]`, septic moves with rests
between them, and the law of the row moves arm and UAV as one system. `run.settle_s` before the first move is not judged, `run.tail_s`
after the last one is."""


def path_of(scenario: Scenario) -> Trajectory:
    """The scenario's path.

    Raises:
        ConfigurationError: it has none.
    """
    if scenario.trajectory is None:
        raise ConfigurationError(
            "trajectory: the mission follows a path, and the scenario has none; the scenario `paper` has one"
        )
    return scenario.trajectory


def _times(scenario: Scenario) -> tuple[float, float, float]:
    # Durations of settling, of the moves with the rests between them, of the last rest, s.
    moves = path_of(scenario).moves
    under_way = sum(m.duration_s + m.rest_s for m in moves) - moves[-1].rest_s
    return scenario.run.settle_s, under_way, moves[-1].rest_s + scenario.run.tail_s


def _phases(scenario: Scenario) -> tuple[Phase, ...]:
    out = []
    targets = {"settle": "follow", "follow": "rest", "rest": "done"}
    for (name, target), duration in zip(targets.items(), _times(scenario), strict=True):
        held = Phase(
            name, "follow", "hinged", "hinge", link="hinged", held=True, observe=True, sight=False, load="impact"
        )
        timed = held._replace(duration_s=duration, timeout_s=duration + GRACE_S, on_timeout=target)
        out.append(timed.to(target, f"elapsed > {name}_s"))
    return (*out, *HINGED_FINALS)


def _thresholds(scenario: Scenario) -> dict[str, float]:
    settle, follow, rest = _times(scenario)
    tick = 1.0 / scenario.run.rate_hz
    # Between two ticks, so that rounding decides nothing; the mission is done in the path's last tick.
    return {"settle_s": settle - 0.5 * tick, "follow_s": follow - 0.5 * tick, "rest_s": rest - 1.5 * tick}


def experiment(name: str, row: str | None, summary: str, criteria: tuple[Criterion, ...] = ()) -> Mission:
    """The mission that flies row `row` of `[experiments]`; None: the row that the plan is given."""
    return Mission(
        name=name,
        summary=summary,
        start="hinged",
        phases=_phases,
        uses=(*SHARED, *HINGED),
        thresholds=_thresholds,
        criteria=criteria,
        experiment=row,
        judged_as="path",
        praise="followed",
        doc=DOC,
    )


E1 = experiment(
    "E1",
    "E1",
    "follow a path by impedance alone",
    (Criterion("attitude_max", 9.2, "deg", "largest attitude error that the paper reports"),),
)
E2 = experiment(
    "E2",
    "E2",
    "follow a path with the extra torque over the link",
    (Criterion("attitude_max", 6.8, "deg", "largest attitude error that the paper reports"),),
)
E3 = experiment("E3", "E3", "follow a path with the measured support force as well")
TRACK = experiment("track", None, "follow a path under any row of [experiments]")
