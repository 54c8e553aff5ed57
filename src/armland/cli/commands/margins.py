"""The command `margins`."""

from typing import Any, Literal

from armland.cli import options
from armland.cli.commands.arm import joints_of
from armland.cli.console import ready, reported
from armland.cli.results import Results, Work, publish
from armland.scenario.deviation import Level

EPILOG = """**Examples**

`armland margins` varies every deviation of the scenario that comes with armland, then all at once (about ten minutes on two cores).

`armland margins --rows 'uav.mass,link.*' --no-pairs` varies the UAV's mass and all of the link.

`armland margins my_landing.toml --around mild --seeds 5 --seed 100` puts half the published range on all others meanwhile.

`armland margins --mission takeoff --json | jq '.margins[:5]'` prints the five narrowest margins of the take-off.

Exit code: 0 if each deviation alone may have its published range, 1 if one may not (says which), 2 for bad input, 3 if something
broke, 130 if it was stopped.
"""

_SEED = "First of the seeds; the scenario's if absent."


@options.taken(
    EPILOG,
    scenario=options.scenario("landing"),
    rows=options.option(str | None, "Deviations to vary, e.g. uav.mass,link.*; all if absent.", metavar="ROWS"),
    mission=options.option(Literal["landing", "takeoff"], "What is flown.", default="landing"),
    around=options.option(
        Level,
        "Level of the others while one is varied: nominal, mild, published, harsh.",
        metavar="LEVEL",
        default="nominal",
    ),
    seeds=options.option(int, "Seeds of each factor that is tried.", default=3, min=1, max=1000),
    seed=options.option(int | None, _SEED, "--seed", "--first-seed", min=0),
    share=options.option(float, "Share of the seeds that must succeed.", default=1.0, min=0.01, max=1.0),
    pairs=options.option(bool, "Look for the worst pairs, too.", "--pairs/--no-pairs", default=True),
    level=options.option(
        Level,
        "Level of all deviations in the search for pairs: mild, published, harsh.",
        metavar="LEVEL",
        default="published",
    ),
    jobs=options.FLOWN["jobs"],
    settings=options.SETTINGS,
    out=options.out("margins"),
    **options.SHOWN,
)
def margins(**given: Any) -> None:
    """Find how far each deviation of the plant may grow until flights fail, and which pairs are worst together."""
    from armland.errors import ConfigurationError
    from armland.experiments.episode import prepare
    from armland.experiments.margins.corners import chosen

    loaded, rows = options.load(given["scenario"], given), chosen(given["rows"])
    if given["pairs"] and given["level"] == "nominal":
        raise ConfigurationError(
            "--level nominal deviates nothing, so no pair can be found; mild, published or harsh do"
        )
    console = ready(joints_of(loaded))
    prepare(loaded, given["mission"])
    from armland.experiments.margins.study import Terms, study
    from armland.view.figures.margins import draw_margins
    from armland.view.page.analyses import margins_sheet
    from armland.view.page.sheet import write_page
    from armland.view.tables.margins import print_margins

    terms = Terms(**{name: given[name] for name in Terms._fields})

    def work(_: Results) -> Work:
        with reported(console) as tell:
            found = study(loaded, rows, terms, given["pairs"], tell)
        return Work(
            found.holds,
            found.result(),
            lambda out: print_margins(found, out),
            lambda folder: draw_margins(folder, found),
            lambda folder: write_page(folder, margins_sheet(found, loaded, _chosen(given))),
        )

    publish(given, "margins.json", ("margins.p??", "report.html"), work)


def _chosen(given: dict[str, Any]) -> list[str]:
    # The options that say what is varied and how, for the command that does it again.
    rows = ["--rows", given["rows"]] if given["rows"] else []
    seed = ["--seed", str(given["seed"])] if given["seed"] is not None else []
    named = ("mission", "around", "seeds", "share", "level")
    return [
        *rows,
        *(w for name in named for w in (f"--{name}", f"{given[name]}")),
        *seed,
        *([] if given["pairs"] else ["--no-pairs"]),
    ]
