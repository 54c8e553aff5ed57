"""The pages of what is computed from many flights and none alone: spread, factorial, proof, envelope, margins."""

from collections.abc import Sequence
from dataclasses import asdict
from functools import partial

from rich.table import Table

from armland.experiments.envelope.study import EnvelopeStudy
from armland.experiments.factorial import ARMS, BOARDS, Factorial
from armland.experiments.margins.study import Margins
from armland.experiments.proof.verification import Proof
from armland.experiments.spread import Spread
from armland.scenario import Scenario
from armland.view.figures.comparison import comparison_figure
from armland.view.figures.envelope import envelope_figure
from armland.view.figures.margins import margins_figure
from armland.view.figures.proof import FIGURES, OF_DEMONSTRATOR
from armland.view.figures.spread import spread_figure
from armland.view.page.again import Again, command_again
from armland.view.page.flight import configuration, versions
from armland.view.page.grid import Grid, grid_of
from armland.view.page.pictures import drawing
from armland.view.page.sheet import Section, Sheet, Verdict
from armland.view.page.study import claims_verdict, told_of
from armland.view.tables.margins import first_failures, inside, margin_tables, screened, terms_in_words
from armland.view.tables.proof import proof_tables
from armland.view.tables.spread import factorial_tables, spread_tables
from armland.view.tables.studies import corners_in_words, envelope_tables


def spread_sheet(found: Spread, scenario: Scenario) -> Sheet:
    """What the page of the experiments over the ranges of what is not published says."""
    points = len(found.demonstrators[0].samples)
    shares = [
        f"{d.name}: the paper's claims hold at {100.0 * min(d.holds.values(), default=0.0):.0f} to "
        f"{100.0 * max(d.holds.values(), default=0.0):.0f} % of them"
        for d in found.demonstrators
    ]
    words = (
        "Each pale dot is a point of a demonstrator's ranges, ringed dots their own values, the star the paper. Left: the largest "
        "attitude error of E2 over that of E1; on the line both are the same. Right: the ratio of the errors along z over it; "
        "below the line E2 is better."
    )
    figure = drawing("spread", "Spread of E1 and E2", words, lambda: spread_figure(found))
    section = Section("Spread", drawings=[figure], grids=[grid_of(t) for t in spread_tables(found)])
    return _sheet(
        "The paper's experiments over the ranges of what is not published",
        Verdict(f"{points} points of each demonstrator", True, f"{'; '.join(shares)}."),
        [section],
        scenario,
        command_again(["paper", "--spread", str(points)], scenario, "paper", "--scenario"),
    )


def factorial_sheet(found: Factorial, scenario: Scenario) -> Sheet:
    """What the page of laws crossed with controllers on board says."""
    best = min(found.cells, key=lambda c: c.metrics.attitude_max_deg)
    rows = [
        {"condition": f"{c.board}; arm {c.arm}", "law": c.law, "metrics": asdict(c.metrics)}
        for c in sorted(found.cells, key=lambda c: list(BOARDS).index(c.board))
    ]
    words = (
        "For each controller on board and each arm: the largest attitude deviation, and the largest RMS position error of an axis, of "
        "each law. Both scales are logarithmic; the further left, the better."
    )
    figure = drawing("factorial", "Laws and boards", words, lambda: comparison_figure(rows))
    laws = len({c.law for c in found.cells})
    return _sheet(
        "Laws crossed with the controllers on board",
        Verdict(
            f"{laws} laws × {len(BOARDS)} boards × {len(ARMS)} arms",
            True,
            f"The smallest attitude error, {best.metrics.attitude_max_deg:.2f}°, has {best.law} with the board {best.board}, "
            f"arm {best.arm}.",
        ),
        [Section("Laws and boards", drawings=[figure], grids=[grid_of(t) for t in factorial_tables(found)])],
        scenario,
        command_again(["paper", "--compare", "--factorial"], scenario, "compare", "--scenario"),
    )


PROOF_WORDS = {
    "proof_decay": (
        "V₂ from random states",
        "V₂ over its start against time on the UAV subsystem, a panel for each case, a line for each path; dashed: 1 %.",
    ),
    "proof_times": (
        "Times of settling",
        "Share of the states that have settled (dashed) and arrived (full) by a time.",
    ),
    "proof_jump": (
        "Where η_e changes sign",
        "The torque of (29) and V₂ about half a turn, and how much V₂ jumps there from random states.",
    ),
    "proof_demonstrator": (
        "V₂ on the whole demonstrator",
        "For each experiment from top to bottom: V₂; its measured rate beside that by (30); the power that each broken assumption "
        "feeds it.",
    ),
    "proof_attribution": (
        "Who feeds V₂",
        "RMS power of each broken assumption into V₂, and its mean while V₂ rises, a bar for each experiment.",
    ),
}
"""Title and words of each figure."""


def proof_sheet(proof: Proof, scenario: Scenario, samples: int) -> Sheet:
    """What the page of the paper's proof says, run with so many `samples` of the subsystem's states."""
    result = proof.result()
    *tables, verdicts = (grid_of(t) for t in proof_tables(result))
    whole = [n for n in FIGURES if n in OF_DEMONSTRATOR and proof.channels]
    alone = [n for n in FIGURES if n not in OF_DEMONSTRATOR]
    parts = [
        Section(
            title,
            drawings=[drawing(name, *PROOF_WORDS[name], partial(FIGURES[name], proof)) for name in names],
            grids=[table],
        )
        for (title, names), table in zip((("Subsystem", alone), ("Demonstrator", whole)), tables, strict=False)
    ]
    return _sheet(
        "The paper's proof, run",
        claims_verdict(result["verdicts"]),
        [Section("Claims", grids=[verdicts._replace(caption="What the proof claims")]), *parts],
        scenario,
        command_again(["verify", "--samples", str(samples)], scenario, "paper", "--scenario"),
    )


def envelope_sheet(found: EnvelopeStudy, scenario: Scenario) -> Sheet:
    """What the page of the capture envelope says."""
    thresholds, bounds, moving = (grid_of(t) for t in envelope_tables(found))
    words = (
        "a, b, c: the boundary of two quantities at the gate, the others at the mission's thresholds, with what these allow and "
        "landings as flown. d: the bound of the offset in all directions. e: the amplitude of a swinging plate that the arm can "
        "match. f: each threshold over its bound."
    )
    figure = drawing("envelope", "Capture envelope", words, lambda: envelope_figure(found))
    reason = f"{'; '.join(found.outside)}." if found.outside else "Every threshold of the mission lies inside."
    return _sheet(
        "The capture envelope",
        Verdict("holds" if found.holds else f"{len(found.outside)} outside", found.holds, reason),
        [
            Section("Thresholds", [corners_in_words(found)], grids=[thresholds]),
            Section("Envelope", drawings=[figure], grids=[bounds]),
            Section("A plate that moves", grids=[moving]),
        ],
        scenario,
        command_again(["envelope", "--flights", str(len(found.flown))], scenario, "landing", seeded=False),
    )


def margins_sheet(found: Margins, scenario: Scenario, options: Sequence[str]) -> Sheet:
    """What the page of the margins says; `options` are those of the command that chose what was varied and how."""
    narrow, first, effects = inside(found), *_first_and_rest(margin_tables(found))
    words = (
        "A bar for each deviation up to the factor on its published range at which flights still succeed; the pale end is the bracket "
        "in which they begin to fail, and behind it stands what ended the first one. An arrow: nothing failed up to there."
    )
    figure = drawing("margins", "Margins", words, lambda: margins_figure(found))
    reason = (
        f"Inside its published range fails alone: {', '.join(narrow)}."
        if narrow
        else "Each deviation alone may have its published range."
    )
    all_at_once = [Section("All at once", screened(found), grids=effects)] if effects else []
    return _sheet(
        f"How far the plant may differ: margins of the {found.terms.mission}",
        Verdict("holds" if found.holds else f"{len(narrow)} inside the published range", found.holds, reason),
        [
            Section("Margins", [terms_in_words(found)], drawings=[figure], grids=[first]),
            Section("First failures", first_failures(found) or ["Nothing failed."]),
            *all_at_once,
        ],
        scenario,
        command_again(["margins", *options], scenario, "landing", seeded=False),
    )


def _first_and_rest(tables: Sequence[Table]) -> tuple[Grid, list[Grid]]:
    first, *rest = (grid_of(t) for t in tables)
    return first, rest


def _sheet(title: str, verdict: Verdict, sections: Sequence[Section], scenario: Scenario, again: Again) -> Sheet:
    attached, told = scenario.text.encode() or None, told_of(scenario, title, "as the study has it")
    return Sheet(
        title,
        scenario.title,
        verdict,
        [],
        [*sections, configuration(scenario, told, attached), versions(told)],
        again,
    )
