"""The command `paper`: experiments E1 to E3 with their verdicts, their spread, and the comparison of laws."""

from functools import cache
from typing import TYPE_CHECKING, Any, NoReturn

from rich.console import Console

from armland.cli import options
from armland.cli.commands.arm import joints_of
from armland.cli.console import progress_bar, ready, reported
from armland.cli.exits import EXPLAINED
from armland.cli.results import Results, Work, publish
from armland.errors import ConfigurationError

if TYPE_CHECKING:
    from armland.scenario import Scenario

PAPER_EPILOG = f"""**Examples**

`armland paper` runs E1, E2 and E3 and writes report.html, figures, logs and result.json to out/paper.

`armland paper --json | jq .verdicts` prints the result alone.

`armland paper --seed 7 --out /tmp/seven` draws other sensor noise.

`armland paper --arm my_arm.urdf --ee tool0` puts your own arm in the LWR's place.

`armland paper --compare --law examples/own_law.py:my_law` puts your own law beside the built-in ones, in one table.

`armland paper --scenario paper_bench` flies them with an AR.Drone from published data alone: nothing is fitted, and two figures miss.

`armland paper --spread 64` flies both demonstrators over the ranges of what is not published (about ten minutes).

`armland paper --compare --factorial` crosses the laws with the controllers on board, the arm 20 % wrong either way (two minutes).

{EXPLAINED}
"""


@options.taken(
    PAPER_EPILOG,
    scenario=options.option(str, options.SCENARIO_HELP, default="paper"),
    compared=options.option(
        bool, "Compare the paper's laws with others instead (scenario compare).", "--compare", default=False
    ),
    factorial=options.option(
        bool, "With --compare: every law with every controller on board instead.", "--factorial", default=False
    ),
    samples=options.option(
        int | None,
        "Fly this many points of the fitted demonstrator's ranges, and of one from published data, instead.",
        "--spread",
        min=2,
        max=100_000,
        metavar="N",
    ),
    law=options.LAW,
    **options.MADE,
    out=options.out("paper"),
    **options.SHOWN,
)
def paper(**given: Any) -> None:
    """Reproduce the paper's experiments E1 to E3 and judge them against the published figures."""
    law, compared, crossed, samples = (given[name] for name in ("law", "compared", "factorial", "samples"))
    if crossed and (law is not None or not compared):
        raise ConfigurationError("--factorial needs --compare, and crosses the built-in laws alone: leave --law out")
    if samples is not None and (compared or given["scenario"] != "paper"):
        raise ConfigurationError(
            "--spread flies the scenarios paper and paper_bench: leave --compare and --scenario out"
        )
    if law is not None and not compared:
        raise ConfigurationError(f"--law needs --compare here; `armland run E3 --law {law}` flies one experiment by it")
    chosen = "compare" if compared and given["scenario"] == "paper" else given["scenario"]
    loaded = options.load(chosen, given)
    if samples is not None:
        _spread(loaded, options.load("paper_bench", given), given, ready(joints_of(loaded)))
    (_factorial if crossed else _compare if compared else _paper)(loaded, given, ready(joints_of(loaded)))


def _paper(scenario: "Scenario", given: dict[str, Any], console: Console) -> NoReturn:
    from armland.experiments.paper import prepare, run_experiments
    from armland.runtime.log import read_log
    from armland.view.report import draw, write_report
    from armland.view.tables.paper import print_paper

    with console.status("Looking for a pose from which the arm reaches the whole path", spinner="line"):
        flights = prepare(scenario)

    logs = cache(lambda: [read_log(given["out"] / f"{name}.mcap") for name in flights])

    def work(results: Results) -> Work:
        with reported(console) as tell:
            outcome = run_experiments(flights, results.folder, tell)
        result = outcome.result()
        return Work(
            outcome.reproduced,
            result,
            lambda out: print_paper(result, out),
            lambda folder: draw(folder, logs()),
            lambda folder: write_report(folder, logs(), result),
        )

    publish(given, "result.json", ("*.mcap", "fig*.p??", "scene.png", "report.html"), work)


def _compare(scenario: "Scenario", given: dict[str, Any], console: Console) -> NoReturn:
    from armland.experiments.comparison import compare
    from armland.view.page.sheet import write_page
    from armland.view.page.study import comparison_sheet
    from armland.view.tables.paper import print_comparison

    def work(_: Results) -> Work:
        with progress_bar(console) as bar:
            task = bar.add_task("laws compared", total=None)
            comparison = compare(
                scenario,
                given["law"],
                lambda name, done, total: bar.update(task, completed=done, total=total, description=name),
            )
        result = comparison.result()
        return Work(
            all(v.holds for v in comparison.verdicts),
            result,
            lambda out: print_comparison(result, out),
            None,
            lambda folder: write_page(folder, comparison_sheet(result, scenario, given["law"])),
        )

    publish(given, "comparison.json", ("report.html",), work)


def _spread(fitted: "Scenario", bench: "Scenario", given: dict[str, Any], console: Console) -> NoReturn:
    from armland.experiments.spread import spread
    from armland.scenario import load_scenario
    from armland.view.figures.spread import draw_spread
    from armland.view.page.analyses import spread_sheet
    from armland.view.page.sheet import write_page
    from armland.view.tables.spread import print_spread

    def work(_: Results) -> Work:
        with reported(console) as tell:
            bias_n = load_scenario("landing").imperfections.force_bias_n
            found = spread(fitted, bench, given["samples"], bias_n, tell)
        return Work(
            True,
            found.result(),
            lambda out: print_spread(found, out),
            lambda folder: draw_spread(folder, found),
            lambda folder: write_page(folder, spread_sheet(found, fitted)),
        )

    publish(given, "spread.json", ("spread.p??", "report.html"), work)


def _factorial(scenario: "Scenario", given: dict[str, Any], console: Console) -> NoReturn:
    from armland.experiments.factorial import cross
    from armland.view.page.analyses import factorial_sheet
    from armland.view.page.sheet import write_page
    from armland.view.tables.spread import print_factorial

    def work(_: Results) -> Work:
        with progress_bar(console) as bar:
            task = bar.add_task("laws and boards", total=None)
            found = cross(scenario, lambda arm, done, n: bar.update(task, completed=done, total=n, description=arm))
        return Work(
            True,
            found.result(),
            lambda out: print_factorial(found, out),
            None,
            lambda folder: write_page(folder, factorial_sheet(found, scenario)),
        )

    publish(given, "factorial.json", ("report.html",), work)
