"""The pages in `docs/missions/`: each made from the mission's own value, with the thresholds that the controller flies by."""

from collections.abc import Iterator

from armland.mission.plan import Plan, plan
from armland.mission.registry import MISSIONS, UNAIDED, mission_named
from armland.mission.table.mission import Mission
from armland.mission.table.phases import KINDS, SIGNALS, Guard, Phase
from armland.mission.unaided.plan import UnaidedPlan, unaided_plan
from armland.scenario import Scenario, load_scenario
from pages.unaided import phase_table

YES_OR_NO = ("uav_seen", "contact", "magnet_ready", "magnet_fault", "bias_known")
STARTS = {
    "air": "in the air",
    "cradle": "on the cradle",
    "hinged": "on the arm's hinge",
}
SHARES = {
    "none": "ramp to nothing",
    "carry": "ramp to a share of the weight",
    "whole": "ramp to the weight",
    "test": "ramp to the weight and a pull that tests the grip",
}

BY_ITSELF = (
    "No supervisor looks for faults in it: what a fault leads to is a matter of the arm's missions. How it compares with landing by "
    "the arm is in [methods.md](../methods.md).",
    "",
)


def mission_markdown(name: str, scenario: Scenario, experiment: str | None = None) -> str:
    """The page of a mission as Markdown, with the numbers of a scenario."""
    mission, by_itself = mission_named(name), name in UNAIDED
    planned: Plan | UnaidedPlan = (
        unaided_plan(scenario, name) if by_itself else plan(scenario, name, experiment=experiment)
    )
    options = f" {scenario_of(mission)}" if by_itself or experiment else ""
    options += f" --experiment {experiment}" if experiment else ""
    parts = [
        f"# {name}: {mission.summary}",
        "",
        f"Made from `mission/missions/` by `make pages`, with the numbers of the scenario `{scenario_of(mission)}`.",
        "",
        "```sh",
        f"armland run {name}{options}",
        "```",
        "",
        f"It begins with the UAV {STARTS[mission.start]}.",
        "",
        mission.doc,
        "",
        "## Phases",
        "",
        *(phase_table(planned) if isinstance(planned, UnaidedPlan) else _phases(planned)),
        *_timeouts(mission),
        *(BY_ITSELF if by_itself else _faults(mission, planned.phases)),
        *_criteria(mission, planned.phases),
        "## Keys of the scenario",
        "",
        "It uses these, and refuses others by name: " + ", ".join(f"`{key}`" for key in sorted(mission.uses)) + ".",
        "",
    ]
    return "\n".join(parts)


def scenario_of(mission: Mission) -> str:
    """Name of the scenario whose numbers a mission's page shows."""
    if mission.name in UNAIDED:
        return mission.name
    if mission.start != "hinged":
        return "landing"
    return "paper" if mission.experiment else "compare"


def pages() -> Iterator[tuple[str, str]]:
    """Name and text of every page."""
    for name, mission in {**MISSIONS, **UNAIDED}.items():
        scenario = load_scenario(scenario_of(mission))
        row = "observer" if mission.start == "hinged" and mission.experiment is None else None
        yield f"{name}.md", mission_markdown(name, scenario, row)


def _phases(planned: Plan) -> Iterator[str]:
    yield from ("| phase | kind | arm | UAV | magnet | ends when | or after |", "|---|---|---|---|---|---|---|")
    yield from (_phase(p, planned.thresholds) for p in planned.phases if not p.final)
    yield ""


def _phase(p: Phase, thresholds: dict[str, float]) -> str:
    uav = SHARES[p.share] if p.uav == "ramp" else p.uav
    ends = "; ".join(_way_out(g, thresholds) for g in p.guards)
    return f"| `{p.name}` | {p.kind} | {p.arm} | {uav} | {p.magnet} | {ends} | {p.timeout_s:g} s: `{p.on_timeout}` |"


def _way_out(guard: Guard, thresholds: dict[str, float]) -> str:
    conditions = []
    for c in guard.conditions:
        unit, value = SIGNALS[c.signal], ""
        if c.threshold != "half":
            value = f" {c.relation} {thresholds[c.threshold]:.4g}{'' if unit == '1' else ' ' + unit}"
        no = "not " if c.signal in YES_OR_NO and c.relation == "<" else ""
        conditions.append(f"{no}{c.signal}{value}")
    held = f" for {guard.hold_s:g} s" if guard.hold_s else ""
    return f"{', '.join(conditions)}{held}: `{guard.target}`"


def _timeouts(mission: Mission) -> Iterator[str]:
    if mission.timeouts:
        yield from ("## Where time runs out", "", "| phase | why, and what helps |", "|---|---|")
        for phase, why in mission.timeouts.items():
            yield f"| `{phase}` | {why} |"
        yield ""


def _faults(mission: Mission, phases: tuple[Phase, ...]) -> Iterator[str]:
    flown = [kind for kind in KINDS if any(p.kind == kind for p in phases)]
    rows = {f: row for f, row in mission.faults.items() if any(row.get(kind, "-") != "-" for kind in flown)}
    if rows:
        yield from ("## Where a fault leads", "", f"| fault | {' | '.join(flown)} |", "|---" * (len(flown) + 1) + "|")
        for fault, row in rows.items():
            yield f"| `{fault}` | {' | '.join(row.get(kind, '-') for kind in flown)} |"
        yield from ("", "Signs, remedies and trials: [faults.md](../faults.md).", "")


def _criteria(mission: Mission, phases: tuple[Phase, ...]) -> Iterator[str]:
    if mission.criteria:
        yield from ("## When it has succeeded", "", "| figure | bound | means |", "|---|---|---|")
        for c in mission.criteria:
            yield f"| {c.name.replace('_', ' ')} | {c.bound:g} {c.unit} | {c.meaning} |"
        yield ""
    touching = [f"`{p.name}`" for p in phases if p.on_cradle and (not p.final or p.name == "done")]
    if touching:
        what = "pad" if mission.name in UNAIDED else "cradle"
        yield f"The UAV may touch the {what} in {', '.join(touching)}; in another phase that is a failure."
        yield ""
