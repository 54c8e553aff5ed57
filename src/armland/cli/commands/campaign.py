"""The commands of a campaign: fly it, report on it, fly one of its rows again."""

import os
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from armland.cli import options
from armland.cli.commands.arm import joints_of
from armland.cli.console import campaign_told, diagnostics, phases_told, ready, reported
from armland.cli.exits import EXPLAINED, attempted, say
from armland.cli.results import Results, Work, publish

if TYPE_CHECKING:
    from armland.experiments.campaign.answers.table import Table
    from armland.experiments.campaign.crews.threads import Crew
    from armland.experiments.campaign.engine import Campaign

FLY_EPILOG = """**Examples**

`armland campaign study.toml --runs 1000` flies each point of the study a thousand times, on all cores.

`armland campaign study.toml --runs 1000 --resume` goes on after whatever stopped it.

`armland campaign study.toml --runs 100000 --until 0.5%` stops when the rate is known to half a per cent.

`armland campaign study.toml --runs 3000 --rare` finds the rate of a failure that plain flights would hardly meet.

`armland campaign study.toml --runs 1000000 --ray auto` flies on the Ray cluster that this machine belongs to.

`armland campaign report out/campaign/study.sqlite` makes the report again, meanwhile too.

`armland campaign replay out/campaign/study.sqlite 17` flies row 17 again, with log and pictures.

Exit code: 0 when it is done, 2 for bad input, 3 if something broke, 130 if it was stopped.
"""

REPORT_EPILOG = """**Examples**

`armland campaign report out/campaign/study.sqlite` prints it and writes report.html, report.json, rows.csv and rows.parquet.

`armland campaign report out/campaign/study.sqlite --json | jq '.points[].successes'` prints the data alone.

Exit code: 0 when it is done, 2 for bad input, 3 if something broke, 130 if it was stopped.
"""

REPLAY_EPILOG = f"""**Examples**

`armland campaign replay out/campaign/study.sqlite 17` flies row 17 again; log and pictures go to out/replay.

{EXPLAINED} A flight that is not the same bit for bit does not succeed.
"""

RARE_RUNS = 2000
"""Flights of a rare campaign where nobody says."""

_PICTURES = options.option(
    bool,
    "Fly the worst flights again for a strip of pictures of each on the page.",
    "--pictures/--no-pictures",
    default=True,
)
_STORE = options.argument(Path, "Store of a campaign, as `armland campaign FILE` makes it.", ..., metavar="STORE")


@options.taken(
    FLY_EPILOG,
    file=options.argument(Path, "What to fly: a TOML file, see docs/campaign.md.", ..., metavar="FILE"),
    runs=options.option(
        int | None,
        "Flights of each point; 100, with --rare 2000, or as many as the store is of, if absent.",
        min=1,
        max=10_000_000,
    ),
    jobs=options.option(int | None, "Processes that fly; one per core if absent.", min=1, max=1000),
    store=options.option(
        Path | None, "File of the rows; out/campaign/NAME.sqlite if absent.", "--out", metavar="STORE"
    ),
    resume=options.option(bool, "Go on with a store that is there; what is flown is kept.", "--resume", default=False),
    until=options.option(
        str | None, "Stop when each rate is known so well: half the width of its interval, as 0.5%.", metavar="SHARE"
    ),
    rare=options.option(
        bool,
        "Draw nearer to the failures, for the rate of rare ones, see [failure] of the file.",
        "--rare",
        default=False,
    ),
    ray=options.option(str | None, "Fly on a Ray cluster: its address, auto, or local.", metavar="ADDRESS"),
    pictures=_PICTURES,
    **options.SHOWN,
)
def fly(**given: Any) -> None:
    """Fly a mission many times under conditions that vary, keep each flight as it ends, and report on all."""
    from armland.errors import ConfigurationError
    from armland.experiments.campaign.engine import conduct
    from armland.experiments.campaign.rare.search import conduct_rare
    from armland.experiments.campaign.stopping import half_width
    from armland.experiments.campaign.store import Store

    file = given["store"] or Path("out") / "campaign" / f"{given['file'].stem}.sqlite"
    until = None if given["until"] is None else half_width(given["until"])
    if given["rare"] and until is not None:
        raise ConfigurationError("--until is for plain flights; with --rare, --runs says how many there are")
    if file.exists() and not given["resume"]:
        raise ConfigurationError(f"{file} is there already; --resume goes on with it, or name another --out")
    campaign = _campaign(given, file)
    crew = crew_of(given["jobs"], given["ray"])
    planned = len(campaign.schedule)
    with (
        Store(file, write=True) as store,
        campaign_told(diagnostics(), campaign.job.mission, planned, sum(1 for _ in store.outcomes())) as tell,
    ):
        if campaign.rare:
            conduct_rare(campaign, store, crew, lambda row: tell(row.success))
        else:
            watch = conduct(campaign, store, crew, until, lambda row: tell(row.success))
    if until is not None and not watch.enough:
        say(
            f"all {planned} flights are flown, and the rates are not known to {given['until']} yet; more --runs with --resume do it"
        )
    _report(given, file, file.with_suffix(""))


def _campaign(given: dict[str, Any], store: Path) -> "Campaign":
    from armland.experiments.campaign.description import check_parameters, read_description
    from armland.experiments.campaign.engine import Campaign
    from armland.experiments.campaign.flight import prepared
    from armland.experiments.campaign.rare.search import check
    from armland.experiments.campaign.rows import Job, Task
    from armland.experiments.campaign.store import Store
    from armland.experiments.judge.figures import bounds

    described = read_description(given["file"])
    scenario = options.load_flown(described.mission, described.scenario, {"overrides": described.settings()})
    check_parameters(described, scenario)
    runs = given["runs"]
    if runs is None and store.is_file():
        with Store(store) as there:
            runs = there.about.get("runs")
    ready(joints_of(scenario))
    law = described.law
    if law is not None and ":" in law:
        law = os.path.abspath(given["file"].parent / law.rpartition(":")[0]) + ":" + law.rpartition(":")[2]
    job = Job(scenario.frozen(), described.mission, law, described.experiment)
    campaign = Campaign(described, job, runs or (RARE_RUNS if given["rare"] else 100), {}, given["rare"])
    if campaign.rare:
        check(described, campaign.runs)
    # What speaks against the first flight of a point speaks against the campaign.
    first = campaign.schedule.task(0)
    limits = bounds(prepared(job, Task(0, 0, first.seed, first.values)).brief)
    return campaign._replace(bounds=limits)


def crew_of(jobs: int | None, address: str | None) -> "Crew":
    """Who flies: `jobs` processes, one per core if absent, or those of the Ray cluster at an `address`."""
    if address is not None:
        from armland.experiments.campaign.crews.cluster import cluster

        return cluster(address, jobs)
    from armland.experiments.campaign.crews.processes import processes

    return processes(jobs or os.cpu_count() or 1)


def _report(given: dict[str, Any], file: Path, out: Path) -> None:
    from armland.errors import ConfigurationError
    from armland.experiments.campaign.answers.report import report
    from armland.experiments.campaign.store import Store
    from armland.view.campaign.page import page
    from armland.view.campaign.terminal import print_report
    from armland.view.campaign.worst import strips

    def work(results: Results) -> Work:
        with Store(file) as store:
            if not any(True for _ in store.outcomes()):
                raise ConfigurationError(f"{file} has no rows yet")
            made, table = report(store)
            drawn = {}
            if given["figures"] and given["pictures"]:
                ready()
                with attempted("pictures of the worst flights"), reported(diagnostics()) as tell:
                    drawn = strips(
                        store, made, results.scratch("worst.mcap"), partial(tell, "pictures of the worst flights")
                    )
        keep_rows(results, table)
        if given["figures"]:
            with attempted("report.html"):
                results.write("report.html", page(made, table, file, drawn))
        return Work(True, made.result(), lambda folder: print_report(made, file, folder))

    publish({**given, "out": out, "figures": False}, "report.json", ("report.html", "rows.*"), work)


def keep_rows(results: Results, table: "Table") -> None:
    """Write the rows of a `table` as rows.csv, and rows.parquet where that can be done, into the folder of the results."""
    from armland.view.campaign.files import write_csv, write_parquet

    write_csv(results.folder / "rows.csv", table)
    with attempted("rows.parquet"):
        write_parquet(results.folder / "rows.parquet", table)


@options.taken(
    REPORT_EPILOG,
    store=_STORE,
    out=options.option(Path | None, "Folder of the report; beside the store, with its name, if absent."),
    pictures=_PICTURES,
    **options.SHOWN,
)
def report(**given: Any) -> None:
    """Report on the rows that a store has: rates with intervals, comparisons, what failure depends on, the worst flights."""
    _report(given, given["store"], given["out"] or given["store"].with_suffix(""))


@options.taken(
    REPLAY_EPILOG,
    store=_STORE,
    row=options.argument(int, "Number of the row.", ..., metavar="ROW"),
    out=options.out("replay"),
    **options.SHOWN,
)
def replay(**given: Any) -> None:
    """Fly a row of a store again, with log and pictures, and check that it is the same bit for bit."""
    from armland.experiments.campaign.replay import replay as fly_again
    from armland.experiments.campaign.store import Store
    from armland.experiments.judge.brief import brief_of
    from armland.experiments.judge.deck import seen_from_deck
    from armland.records import MESSAGES
    from armland.runtime.log import read_log
    from armland.view.flown import Flown
    from armland.view.report import draw
    from armland.view.tables.flight import print_flight

    with Store(given["store"]) as store:
        store.row(given["row"])
        mission = store.about["job"]["mission"]
        ready()
        name = f"{mission}.mcap"

        def work(results: Results) -> Work:
            with phases_told(diagnostics(), mission):
                again = fly_again(store, given["row"], results.folder / name)
            for line in again.changed:
                say(f"another version than the row's: {line}")
            ticks = seen_from_deck({m: again.episode.ticks[m] for m in MESSAGES})
            run = Flown(mission, ticks, brief_of(again.episode.metadata))
            data = {"row": given["row"], "same": again.same, "digest": again.row.digest, "again": again.again.digest}

            def show(folder: Path) -> None:
                print_flight(again.episode.result, run, folder)
                same = "the same, bit for bit" if again.same else "NOT the same"
                print(f"Row {given['row']}: {same} ({again.row.digest or 'no flight'}, {again.again.digest}).")

            return Work(
                again.same,
                {**data, "result": again.episode.result},
                show,
                lambda folder: draw(folder, [read_log(given["out"] / name)]),
            )

        publish(given, "result.json", (name, "*_overview.p??", "fig*.p??", "scene.png"), work)


class _Default(typer.core.TyperGroup):
    # `armland campaign FILE` is `armland campaign fly FILE`.
    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Put `fly` before what names no command; `args` as they were typed."""
        if args and args[0] not in self.commands and args[0] != "--help":
            args = ["fly", *args]
        return super().parse_args(ctx, args)


app = typer.Typer(
    cls=_Default,
    no_args_is_help=True,
    rich_markup_mode="markdown",
    epilog=FLY_EPILOG,
    help="Fly a campaign: `armland campaign FILE` answers how often a mission succeeds, how well, and what that depends on.",
)
for command in (fly, report, replay):
    app.command(epilog=vars(command)["epilog"])(command)
