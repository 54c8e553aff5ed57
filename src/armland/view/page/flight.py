"""The page of one flight: verdict, film strip, phases, figures with bounds, limits, what the supervisor did, plant against belief."""

import json
from collections.abc import Mapping
from typing import Any

from armland.errors import ArmlandError, PictureError
from armland.experiments.judge.judgement import PhaseTime, phase_times
from armland.experiments.operator.script import SCRIPT_NAME
from armland.runtime.log import Log
from armland.runtime.recorder import SCENARIO_NAME
from armland.scenario import Scenario
from armland.scenario.tables import leaves
from armland.view.figures.flight import overview_figure
from armland.view.film.film import stills, take_of, title_of
from armland.view.flown import Flown, flown, scenario_of
from armland.view.page.again import again, toml
from armland.view.page.belief import beliefs, deviations, learnt
from armland.view.page.course import course
from armland.view.page.grid import Cell, Grid
from armland.view.page.merits import figures, limits, tiles
from armland.view.page.pictures import drawing, photograph
from armland.view.page.sheet import Piece, Section, Sheet, Still, Verdict, settings_grid

STILL_PX = (440, 352)

STEERED = ("--operator", "LOG.mcap")
"""What a run that was steered by hand needs to be done again: its log, which holds the operator's messages."""

OVERVIEW = (
    "From top to bottom: height of the UAV's pivot and of the arm's end effector; their horizontal distance, logarithmic; force in "
    "the hinge; vertical force of rotors, arm and cradle on the UAV, which is who carries the weight; tilt of the UAV; largest joint "
    "torque asked for over its limit. Every second phase is shaded. Pale: every tick; in front of it the mean over 40 ms."
)
"""What the overview shows, in words."""


def flight_sheet(log: Log, result: Mapping[str, Any], pictures: bool = True) -> Sheet:
    """What the page of a flight says.

    Args:
        log: of the flight.
        result: of it, see `report.result_of`.
        pictures: whether to draw a film strip.

    Raises:
        LogError: a log that holds too little for figures.
    """
    run, scenario = flown(log), scenario_of(log)
    phases = phase_times(log.messages["mission"]["phase"], run.brief.phases, run.brief.rate_hz)
    verdict = Verdict("success" if result["success"] else "failure", bool(result["success"]), str(result["reason"]))
    sections = [
        strip(log) if pictures else Section("Film strip", ["No pictures were asked for."]),
        _phases(phases),
        Section("Figures", grids=[figures(result, run)]),
        Section(
            "Over time", drawings=[drawing("overview", "The flight over time", OVERVIEW, lambda: overview_figure(run))]
        ),
        Section("Limits", grids=[limits(result, run)]),
        _supervisor(run, phases, scenario, log.metadata, result),
        _belief(log, run, scenario),
        configuration(scenario, log.metadata, log.attachments.get(SCENARIO_NAME)),
        versions(log.metadata),
    ]
    return Sheet(
        title_of(log),
        scenario.title,
        verdict,
        tiles(result, run),
        sections,
        again(log.metadata, log.attachments.get(SCENARIO_NAME), STEERED if SCRIPT_NAME in log.attachments else ()),
    )


def strip(log: Log) -> Section:
    """A picture of each phase, or why there is none."""
    title = "Film strip"
    try:
        drawn = [
            Still(photograph(picture), phase.name.replace("_", " "), f"{phase.start_s:.1f} to {phase.end_s:.1f} s")
            for phase, picture in stills(take_of(log), *STILL_PX)
        ]
    except PictureError as e:
        return Section(title, [f"There is no film strip: {e}."])
    except ArmlandError as e:
        return Section(title, [f"There is no film strip, because its scene cannot be composed here: {e}"])
    return Section(title, ["The middle of each phase, and the end."], stills=drawn)


def _phases(phases: list[PhaseTime]) -> Section:
    whole = phases[-1].end_s - phases[0].start_s
    bar = [
        Piece(p.name.replace("_", " "), 100.0 * (p.end_s - p.start_s) / whole, f"{p.end_s - p.start_s:.2f} s")
        for p in phases
    ]
    rows = [
        (p.name.replace("_", " "), f"{p.start_s:.2f}", f"{p.end_s:.2f}", f"{p.end_s - p.start_s:.2f}") for p in phases
    ]
    return Section("Phases", bar=bar, grids=[Grid("Phases", ("phase", "start (s)", "end (s)", "duration (s)"), rows)])


def _supervisor(
    run: Flown, phases: list[PhaseTime], scenario: Scenario, metadata: Mapping[str, str], result: Mapping[str, Any]
) -> Section:
    events = course(run, phases, metadata, scenario)
    faults = [e for e in events if e.kind == "fault"]
    text = [
        "It found no fault." if not faults else f"It found {len(faults)} {'fault' if len(faults) == 1 else 'faults'}.",
        f"Missed captures: {result['retries']}. The flight ended in {result['end'].replace('_', ' ')}, the UAV {result['state']}.",
    ]
    text += [f"The law: {result['law_failure']}."] if result.get("law_failure") else []
    text += [f"Faults that never acted: {', '.join(result['never_acted'])}."] if result.get("never_acted") else []
    rows = [(f"{e.time_s:.2f}", Cell(e.what, "bad" if e.kind in ("fault", "retry") else ""), e.why) for e in events]
    return Section(
        "What the supervisor did and why",
        text,
        grids=[Grid("Events", ("time (s)", "what", "why"), rows, left=(1, 2))],
    )


def _belief(log: Log, run: Flown, scenario: Scenario) -> Section:
    found = deviations(scenario, int(log.metadata["joints"]), log.metadata.get("start") == "hinged")
    text = (
        []
        if found
        else ["Nothing deviates: the plant is as the controller believes it to be, but for noise and delays."]
    )
    grids = [grid for grid in (found, beliefs(scenario), learnt(log, run)) if grid is not None]
    return Section("Plant against belief", text, grids=grids)


def configuration(scenario: Scenario, metadata: Mapping[str, str], attached: bytes | None) -> Section:
    """What was set, and the scenario's file."""
    said = {
        "scenario": scenario.title,
        "mission": metadata["mission"],
        "experiment": metadata.get("experiment") or "-",
        "law of the held UAV": metadata["law"],
        "seed": metadata["seed"],
        "arm": scenario.arm.file,
        "UAV": scenario.airframe or scenario.uav.file or "by the scenario's numbers",
        "deviation": scenario.deviation.level,
        "wind": f"{scenario.air.wind_mps:g} m/s at 20 ft" if scenario.air.wind_mps else "calm",
        "sea": _sea(scenario),
        "base rate": f"{scenario.run.rate_hz} Hz",
    }
    data = json.loads(metadata.get("overrides") or "{}")
    rows = [(path, _at(data, path)) for path in leaves(data)]
    grids = [settings_grid("Configuration", said)]
    grids += [Grid("Set beside the file", ("key", "value"), rows, left=(0, 1))] if rows else []
    files = [(f"The scenario's file, {SCENARIO_NAME}", attached.decode("utf-8", "replace"))] if attached else []
    whole = json.dumps(json.loads(metadata.get("scenario", "{}")), indent=1)
    return Section("Configuration", grids=grids, unfolded=[*files, ("Every number that flew", whole)])


def versions(metadata: Mapping[str, str]) -> Section:
    """Of what made the log."""
    found = {"armland": metadata.get("version", "-"), **json.loads(metadata.get("versions", "{}"))}
    return Section("Versions", grids=[settings_grid("Versions that flew it", found)])


def _sea(scenario: Scenario) -> str:
    sea = scenario.sea
    if sea.trace is not None:
        return f"recorded deck {sea.trace}"
    if not sea.moves:
        return "none: the ground"
    return f"{sea.state}, hull of {sea.hull_m:g} m" if sea.waves else sea.state


def _at(data: Mapping[str, Any], path: str) -> str:
    value: Any = data
    for key in path.split("."):
        value = value[key]
    return value if isinstance(value, str) else toml(value)
