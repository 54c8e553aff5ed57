"""The pages of many flights: a campaign, the paper's experiments, laws compared."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from armland import __version__
from armland.experiments.campaign.summary import Row, Summary
from armland.experiments.episode import Flight
from armland.runtime.log import Log
from armland.runtime.recorder import SCENARIO_NAME
from armland.scenario import Scenario
from armland.view.figures.campaign import campaign_page
from armland.view.figures.comparison import comparison_figure
from armland.view.figures.curves import clocked
from armland.view.figures.paper import FIGURES
from armland.view.flown import flown, scenario_of
from armland.view.page.again import again, study_again
from armland.view.page.flight import configuration, strip, versions
from armland.view.page.grid import Cell, Grid, holds
from armland.view.page.merits import Tile
from armland.view.page.pictures import drawing
from armland.view.page.sheet import Section, Sheet, Verdict
from armland.view.tables.campaign import alike
from armland.view.tables.flight import GROUPS, LOADS
from armland.view.tables.verdicts import bound_in_words, cell

MOST_SEEDS = 12
"""Seeds of one failure that are named."""


def campaign_sheet(summary: Summary, rows: Sequence[Row], bounds: Mapping[str, float], flight: Flight) -> Sheet:
    """What the page of a campaign says; arguments as for `campaign.summarise`, and the flight that all are like."""
    attached = flight.scenario.text.encode() or None
    metadata, low, high = {**flight.metadata, "version": __version__}, *(100.0 * p for p in summary.interval)
    mission, all_good = metadata["mission"], summary.successes == summary.flights
    verdict = Verdict(
        f"{summary.successes} of {summary.flights} succeed",
        all_good,
        f"95 % interval of the probability of success: {low:.1f} to {high:.1f} %.",
    )
    words = (
        "Each panel has one figure of merit: its value in each flight over the share of flights that stay below it. Dots: flights that "
        "succeed; crosses: flights that fail; dashed: the bound."
    )
    figure = drawing("campaign", "Spread over the seeds", words, lambda: campaign_page(rows, bounds))
    violated = ", ".join(f"{name} in {n}" for name, n in summary.violated.items()) or "none"
    return Sheet(
        f"{mission}, {summary.flights} seeds from {rows[0]['seed']}",
        flight.scenario.title,
        verdict,
        _spread_tiles(summary),
        [
            _failures(rows, metadata, attached),
            Section("Spread", drawings=[figure], grids=[_spread(summary)]),
            Section(
                "Limits",
                [f"Limits violated: {violated}.", f"Missed captures that were tried again: {summary.retries}."],
            ),
            configuration(flight.scenario, metadata, attached),
            versions(metadata),
        ],
        again({**metadata, "seed": str(rows[0]["seed"])}, attached, ("--seeds", str(len(rows)))),
    )


def _spread(summary: Summary) -> Grid:
    rows = [
        (s.name, f"{s.median:.3g}", f"{s.p95:.3g}", f"{s.worst:.3g}", f"{s.worst_seed}", *_bound(s.bound, s.holds))
        for s in summary.spreads
    ]
    columns = ("figure", "median", "95 %", "worst", "seed", "bound", "verdict")
    return Grid("Spread of the figures", columns, rows, left=(0, 6))


def _failures(rows: Sequence[Row], metadata: Mapping[str, str], attached: bytes | None) -> Section:
    found = alike(rows)
    if not found:
        return Section("Failures", ["No flight failed."])
    out = []
    for reason, seeds in found.items():
        named = ", ".join(map(str, seeds[:MOST_SEEDS])) + (", …" if len(seeds) > MOST_SEEDS else "")
        first = again({**metadata, "seed": str(seeds[0])}, attached).command
        out.append((f"{len(seeds)}", reason, named, first))
    return Section(
        "Failures",
        [f"{sum(map(len, found.values()))} flights failed, in {len(found)} {'way' if len(found) == 1 else 'ways'}."],
        grids=[
            Grid(
                "What failed, and the flight that shows it",
                ("flights", "reason", "seeds", "again"),
                out,
                left=(1, 2, 3),
            )
        ],
    )


def _spread_tiles(summary: Summary) -> list[Tile]:
    out = []
    for s in summary.spreads:
        if s.bound is not None:
            name, _, unit = s.name.rstrip("]").partition(" [")
            unit = "" if unit == "1" else f" {unit}"
            mark = "good" if s.holds else "bad"
            out.append(Tile(f"{name}, worst", f"{s.worst:.3g}{unit}", f"at most {s.bound:.4g}{unit}", mark))
    return out


def paper_sheet(logs: Sequence[Log], result: Mapping[str, Any]) -> Sheet:
    """What the page of the paper's experiments says, of their logs and their result."""
    first = logs[0]
    scenario, attached = scenario_of(first), first.attachments.get(SCENARIO_NAME)
    names = list(result["experiments"])
    runs = clocked([flown(log) for log in logs])
    drawings = [drawing(name, TITLES[name][0], TITLES[name][1], partial(make, runs)) for name, make in FIGURES.items()]
    return Sheet(
        f"The paper's experiments, seed {first.metadata['seed']}",
        scenario.title,
        claims_verdict(result["verdicts"]),
        [],
        [
            Section("Claims", grids=[_claims("What the paper reports", result["verdicts"])]),
            Section("Figures of merit", grids=[_experiments(result, names)]),
            strip(logs[-1]),
            Section(
                "Over time", ["Time counts from the start of the desired path; grey where it moves."], drawings=drawings
            ),
            configuration(scenario, first.metadata, attached),
            versions(first.metadata),
        ],
        study_again(first.metadata, attached, "paper"),
    )


TITLES = {
    "fig5_trajectory": ("Desired path", "The desired position of the pivot along x, y and z over time."),
    "fig6a_attitude": (
        "Attitude deviation",
        "Angle between the UAV's attitude and the desired one, with the largest ones that the paper reports, dashed.",
    ),
    "fig6b_tilt": ("Roll, pitch and yaw", "The UAV's true attitude over time."),
    "fig7a_x": ("Position along x", "Desired and actual position of the pivot, and below it their difference."),
    "fig7b_y": ("Position along y", "Desired and actual position of the pivot, and below it their difference."),
    "fig7c_z": ("Position along z", "Desired and actual position of the pivot, and below it their difference."),
    "fig_forces": (
        "Forces and torques",
        "Force in the hinge, torque asked of the UAV beyond its attitude controller, largest joint torque over its limit.",
    ),
}
"""Title and words of each figure."""


def comparison_sheet(result: Mapping[str, Any], scenario: Scenario, law: str | None) -> Sheet:
    """What the page of a comparison of laws says, of its result and the scenario that was flown."""
    attached = scenario.text.encode() or None
    metadata = told_of(scenario, "comparison of laws", law or "all of the scenario")
    words = (
        "For each law and condition: the largest attitude deviation, and the largest RMS position error of an axis. Both scales are "
        "logarithmic; the further left, the better."
    )
    figure = drawing("laws", "Laws under conditions", words, lambda: comparison_figure(result["rows"]))
    sections = [Section("Laws", drawings=[figure], grids=[_laws(result["rows"])])]
    if result["verdicts"]:
        sections.insert(0, Section("Claims", grids=[_claims("What the comparison shows", result["verdicts"])]))
    more = ("--compare", *(() if law is None else ("--law", law)))
    return Sheet(
        f"Laws compared, seed {scenario.run.seed}",
        scenario.title,
        claims_verdict(result["verdicts"]),
        [],
        [*sections, configuration(scenario, metadata, attached), versions(metadata)],
        study_again(metadata, attached, "compare", more),
    )


def told_of(scenario: Scenario, what: str, law: str) -> dict[str, str]:
    """What a log would say of a scenario from which something was computed that has no log of its own."""
    return {
        "mission": what,
        "law": law,
        "seed": str(scenario.run.seed),
        "scenario": scenario.model_dump_json(),
        "overrides": scenario.overrides,
        "version": __version__,
    }


def claims_verdict(verdicts: Sequence[Mapping[str, Any]]) -> Verdict:
    """How many claims hold, and which do not."""
    judged = [v for v in verdicts if v["holds"] is not None]
    kept = sum(bool(v["holds"]) for v in judged)
    missed = "; ".join(v["claim"] for v in judged if not v["holds"])
    reason = (
        f"Missed: {missed}." if missed else "Every claim that was judged holds." if judged else "No claim was judged."
    )
    return Verdict(f"{kept} of {len(judged)} claims hold", kept == len(judged), reason)


def _claims(caption: str, verdicts: Sequence[Mapping[str, Any]]) -> Grid:
    out = []
    for v in verdicts:
        out.append((v["claim"].replace("`", ""), f"{v['value']:.4g}", bound_in_words(*v["bound"]), holds(v["holds"])))
    return Grid(caption, ("claim", "found", "bound", "verdict"), out, left=(0, 3))


def _experiments(result: Mapping[str, Any], names: Sequence[str]) -> Grid:
    out: list[Sequence[str]] = []
    for row in (*GROUPS["tracking"], LOADS[0]):
        out.append((row.label, *(cell(result["experiments"][n].get(row.key), row.scale, row.form) for n in names)))
        if row.key == "attitude_max_deg":
            published = (result["published"].get(n, {}).get(row.key) for n in names)
            out.append(("attitude max, published [°]", *(cell(p, 1.0, "{:.1f}") for p in published)))
    return Grid("E1 to E3 on the simulated demonstrator", ("figure", *names), out)


def _laws(rows: Sequence[Mapping[str, Any]]) -> Grid:
    out = [
        (
            row["condition"],
            row["law"],
            f"{row['metrics']['attitude_max_deg']:.2f}",
            cell(row["metrics"]["position_rms_m"], 1e3, "{:.2f}"),
            f"{1e3 * max(row['metrics']['position_max_m']):.1f}",
            f"{row['resting_swing_deg']:.2f}",
        )
        for row in rows
    ]
    columns = ("condition", "law", "attitude max (°)", "error RMS x/y/z (mm)", "error max (mm)", "swing at rest (°)")
    return Grid("Laws compared", columns, out, left=(0, 1))


def _bound(bound: float | None, kept: bool) -> tuple[str, Cell | str]:
    return ("-", "") if bound is None else (f"at most {bound:.4g}", holds(kept))
