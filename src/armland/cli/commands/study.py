"""The command `study`: what each term of the control at sea gives, and which hardware helps, by campaigns of one change at a time."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from armland.cli import options
from armland.cli.commands.arm import joints_of
from armland.cli.commands.campaign import crew_of, keep_rows
from armland.cli.console import campaign_told, diagnostics, ready
from armland.cli.exits import attempted
from armland.cli.results import Results, Work, publish

if TYPE_CHECKING:
    from armland.experiments.campaign.engine import Campaign
    from armland.experiments.study.table import Study

EPILOG = """**Examples**

`armland study terms` flies 40 landings with and without each term of the control, with the same seeds (some ten minutes).

`armland study sensors` exchanges one piece of hardware at a time, and says what to buy first.

`armland study terms --only 'load observer,deck-following' --wind 0 --sea tank` asks of two terms, on another deck.

`armland study sensors --runs 200 --resume` flies on to two hundred; what is flown is kept.

`armland study terms --no-fly` says what has come of it so far, meanwhile too.

The rows are a campaign's store, out/study/terms.sqlite, which `armland campaign report` and `replay` take.

Exit code: 0 when it is done, 2 for bad input, 3 if something broke, 130 if it was stopped.
"""

WIND_MPS, SEA, HULL_M, RUNS = 8.0, "3", 4.0, 40
"""What is flown in and how often, where nobody says."""


@options.taken(
    EPILOG,
    which=options.argument(
        Literal["sensors", "terms"], "sensors: which hardware helps; terms: those of the control.", ..., metavar="WHICH"
    ),
    scenario=options.scenario("landing"),
    runs=options.option(int | None, f"Flights of each change; {RUNS} if absent.", min=1, max=100_000),
    seed=options.option(int, "Seed of the first flight, the same for each change.", default=1, min=0),
    only=options.option(str | None, "Changes to fly, by commas; all if absent.", metavar="NAMES"),
    wind=options.option(
        float, "Mean wind in m/s at 20 ft, with its turbulence; see docs/air.md.", default=WIND_MPS, min=0.0
    ),
    sea=options.option(str, "Sea state 0 to 4, tank or usv; see docs/sea.md.", default=SEA, metavar="0-4|tank|usv"),
    hull=options.option(float, "Length in m of the hull that carries the arm.", default=HULL_M, metavar="M"),
    deviation=options.DEVIATION,
    settings=options.SETTINGS,
    jobs=options.option(
        int | None, "Processes that fly; one per core if absent.", "--workers", "--jobs", min=1, max=1000
    ),
    flies=options.option(bool, "Fly, or say what the store has so far.", "--fly/--no-fly", default=True),
    store=options.option(Path | None, "File of the rows; out/study/NAME.sqlite if absent.", "--out", metavar="STORE"),
    resume=options.option(bool, "Go on with a store that is there; what is flown is kept.", "--resume", default=False),
    **options.SHOWN,
)
def study(**given: Any) -> None:
    """Find what each term of the control at sea gives, or which hardware helps: one change at a time, with the same seeds."""
    from armland.errors import ConfigurationError
    from armland.experiments.study.sensors import SENSORS
    from armland.experiments.study.table import chosen
    from armland.experiments.study.terms import TERMS

    asked = chosen({s.name: s for s in (SENSORS, TERMS)}[given["which"]], given["only"])
    file = given["store"] or Path("out") / "study" / f"{asked.name}.sqlite"
    if given["flies"]:
        if file.exists() and not given["resume"]:
            raise ConfigurationError(f"{file} is there already; --resume goes on with it, or name another --out")
        _fly(asked, file, given)
    _report(asked, file, given)


def _fly(asked: "Study", file: Path, given: dict[str, Any]) -> None:
    from armland.experiments.campaign.engine import conduct
    from armland.experiments.campaign.store import Store

    campaign = _campaign(asked, file, given)
    planned = len(campaign.schedule)
    with (
        Store(file, write=True) as store,
        campaign_told(diagnostics(), asked.name, planned, sum(1 for _ in store.outcomes())) as tell,
    ):
        conduct(campaign, store, crew_of(given["jobs"], None), None, lambda row: tell(row.success))


def _campaign(asked: "Study", file: Path, given: dict[str, Any]) -> "Campaign":
    from armland.experiments.campaign.store import Store
    from armland.experiments.study.flights import campaign_of_study

    # Calm water needs no hull, and a scenario refuses what has no effect.
    afloat = given["sea"] not in ("0", "calm", *options.MEASURED)
    weather = {**given, "seed": None, "hull": given["hull"] if afloat else None}
    scenario = options.load_flown("landing", given["scenario"], weather)
    ready(joints_of(scenario))
    runs = given["runs"]
    if runs is None and file.is_file():
        with Store(file) as there:
            runs = there.about.get("runs")
    return campaign_of_study(asked, scenario, given["scenario"], runs or RUNS, given["seed"])


def _report(asked: "Study", file: Path, given: dict[str, Any]) -> None:
    from armland.errors import ConfigurationError
    from armland.experiments.campaign.answers.report import report
    from armland.experiments.campaign.store import Store
    from armland.experiments.study.answer import answer
    from armland.view.campaign.page import page
    from armland.view.study.figure import draw_study
    from armland.view.study.table import print_study

    def work(results: Results) -> Work:
        with Store(file) as store:
            if not any(True for _ in store.outcomes()):
                raise ConfigurationError(f"{file} has no rows yet")
            made, table = report(store)
            found = answer(asked, made, store)
        if not found.gains:
            raise ConfigurationError(f"{file} has no rows of `armland study {asked.name}`; name its store by --out")
        words = conditions(made.campaign.job.scenario, found.usual.flights)
        keep_rows(results, table)
        if given["figures"]:
            with attempted("report.html"):
                results.write("report.html", page(made, table, file, {}))
        return Work(
            True,
            {"conditions": words, **found.result()},
            lambda folder: print_study(found, words, folder),
            lambda folder: draw_study(folder, found, words),
        )

    publish({**given, "out": file.with_suffix("")}, "study.json", ("report.html", "rows.*", "study_*.p??"), work)


def conditions(frozen: str, flights: int) -> str:
    """Under which a study was flown, in words.

    Args:
        frozen: its scenario, as `Scenario.frozen` gives it.
        flights: of the scenario as it is.
    """
    from armland.scenario import Scenario

    s = Scenario.thawed(frozen)
    wind = f"wind {s.air.wind_mps:g} m/s" if s.air.blows else "calm air"
    sea = {"calm": "on land", **{name: f"deck {name}" for name in options.MEASURED}}.get(
        s.sea.state, f"{s.sea.state}, hull {s.sea.hull_m:g} m"
    )
    return f"{wind}, {sea}, deviations {s.deviation.level}, {flights} seeds"
