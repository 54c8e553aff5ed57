"""The command `paper`: experiments E1 to E3 with their verdicts, and the comparison of laws."""

from typing import TYPE_CHECKING, Any, NoReturn

from rich.console import Console

from armland.cli import options
from armland.cli.console import progress_bar, ready, reported
from armland.cli.exits import EXPLAINED
from armland.cli.results import Results, Work, publish
from armland.errors import ConfigurationError

if TYPE_CHECKING:
    from armland.scenario import Scenario

PAPER_EPILOG = f"""**Examples**

`armland paper` runs E1, E2 and E3 and writes figures, logs and result.json to out/paper.

`armland paper --json | jq .verdicts` prints the result alone.

`armland paper --seed 7 --out /tmp/seven` draws other sensor noise.

`armland paper --arm my_arm.urdf --ee tool0` puts your own arm in the LWR's place.

`armland paper --compare --law examples/own_law.py:my_law` puts your own law beside the built-in ones, in one table.

{EXPLAINED}
"""


@options.taken(
    PAPER_EPILOG,
    scenario=options.option(str, options.SCENARIO_HELP, default="paper"),
    compared=options.option(
        bool, "Compare the paper's laws with others instead (scenario compare).", "--compare", default=False
    ),
    law=options.LAW,
    **options.MADE,
    out=options.out("paper"),
    **options.SHOWN,
)
def paper(**given: Any) -> None:
    """Reproduce the paper's experiments E1 to E3 and judge them against the published figures."""
    law, compared = given["law"], given["compared"]
    if law is not None and not compared:
        raise ConfigurationError(f"--law needs --compare here; `armland run E3 --law {law}` flies one experiment by it")
    chosen = "compare" if compared and given["scenario"] == "paper" else given["scenario"]
    loaded = options.load(chosen, given, hinged=True)
    (_compare if compared else _paper)(loaded, given, ready())


def _paper(scenario: "Scenario", given: dict[str, Any], console: Console) -> NoReturn:
    from armland.experiments.paper import prepare, run_experiments
    from armland.runtime.log import read_log
    from armland.view.report import draw
    from armland.view.tables.paper import print_paper

    with console.status("Looking for a pose from which the arm reaches the whole path", spinner="line"):
        flights = prepare(scenario)

    def work(results: Results) -> Work:
        with reported(console) as tell:
            outcome = run_experiments(flights, results.folder, tell)
        result = outcome.result()
        return Work(
            outcome.reproduced,
            result,
            lambda out: print_paper(result, out),
            lambda folder: draw(folder, [read_log(given["out"] / f"{name}.mcap") for name in flights]),
        )

    publish(given, "result.json", ("*.mcap", "fig*.p??", "scene.png"), work)


def _compare(scenario: "Scenario", given: dict[str, Any], console: Console) -> NoReturn:
    from armland.experiments.comparison import compare
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
        return Work(all(v.holds for v in comparison.verdicts), result, lambda out: print_comparison(result, out))

    publish(given, "comparison.json", (), work)
