"""The command `compare`: methods to land, flown with the same seeds in the same wind and sea."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from armland.cli import options
from armland.cli.commands.arm import joints_of
from armland.cli.console import campaign_told, diagnostics, ready
from armland.cli.results import Results, Work, publish

if TYPE_CHECKING:
    from armland.experiments.campaign.engine import Campaign
    from armland.experiments.methods.comparison import Flights

EPILOG = """**Examples**

`armland compare arm unassisted --wind 6 --sea 1 --runs 100` flies both with the same hundred seeds: one table, one figure.

`armland compare arm unassisted unassisted-untimed --runs 20 --json | jq .paired` prints the differences alone.

`armland compare arm unassisted --wind 6 --sea 1 --runs 1000 --resume` flies on to a thousand; what is flown is kept.

The rows of each method are a campaign's store, which `armland campaign report` and `replay` take.

Exit code: 0 when it is done, 2 for bad input, 3 if something broke, 130 if it was stopped.
"""

METHOD_HELP = (
    "Two or more of arm, arm-paper, unassisted, unassisted-untimed, tether, hexapod; the first is what the others are held "
    "against."
)


@options.taken(
    EPILOG,
    methods=options.argument(list[str], METHOD_HELP, ..., metavar="METHOD"),
    runs=options.option(int, "Flights of each method.", default=100, min=1, max=10_000_000),
    jobs=options.option(int | None, "Processes that fly; one per core if absent.", min=1, max=1000),
    resume=options.option(bool, "Go on with what is there; what is flown is kept.", "--resume", default=False),
    deviation=options.DEVIATION,
    **{
        name: options.FLOWN[name]
        for name in ("wind", "wind_trace", "sea", "hull", "sea_trace", "seed", "settings", "uav")
    },
    out=options.out("compare"),
    **options.SHOWN,
)
def compare(**given: Any) -> None:
    """Fly methods to land with the same seeds, in the same wind and sea, and show them side by side."""
    from armland.errors import ConfigurationError
    from armland.view.methods.figure import draw_methods
    from armland.view.methods.table import print_methods

    names = given["methods"]
    if len(set(names)) < 2 or len(set(names)) < len(names):
        raise ConfigurationError("compare takes two or more different methods, as in: armland compare arm unassisted")
    planned = {name: _campaign(name, given) for name in names}
    conditions = _conditions(given)

    def work(results: Results) -> Work:
        from armland.experiments.methods.comparison import as_data

        flown = [_flown(name, campaign, given) for name, campaign in planned.items()]
        data = {"conditions": conditions, "runs": given["runs"], **as_data(flown)}
        return Work(
            True,
            data,
            lambda folder: print_methods(flown, conditions, folder),
            lambda folder: draw_methods(folder, flown, conditions),
        )

    publish(given, "compare.json", ("methods.p??",), work)


def _campaign(name: str, given: dict[str, Any]) -> "Campaign":
    from armland.errors import ConfigurationError
    from armland.experiments.methods.comparison import campaign_of_method
    from armland.experiments.methods.table import method_named

    method = method_named(name)
    file = _store(name, given)
    if file.exists() and not given["resume"]:
        raise ConfigurationError(f"{file} is there already; --resume goes on with it, or name another --out")
    first = 1 if given["seed"] is None else given["seed"]
    loaded = options.load_flown(
        method.mission, method.scenario, {**given, "seed": None, "overrides": dict(method.overrides)}
    )
    ready(joints_of(loaded))
    return campaign_of_method(method, name, loaded, given["runs"], first)


def _store(name: str, given: dict[str, Any]) -> Path:
    return Path(given["out"]) / f"{name}.sqlite"


def _flown(name: str, campaign: "Campaign", given: dict[str, Any]) -> "Flights":
    from armland.experiments.campaign.crews.processes import processes
    from armland.experiments.campaign.engine import conduct
    from armland.experiments.campaign.store import Store
    from armland.experiments.methods.comparison import flights_of

    crew = processes(given["jobs"] or os.cpu_count() or 1)
    with (
        Store(_store(name, given), write=True) as store,
        campaign_told(diagnostics(), name, campaign.runs, sum(1 for _ in store.outcomes())) as tell,
    ):
        conduct(campaign, store, crew, None, lambda row: tell(row.success))
        return flights_of(store, name, campaign.bounds)


def _conditions(given: dict[str, Any]) -> str:
    wind = f"wind {given['wind']:g} m/s at 20 ft" if given.get("wind") else "calm air"
    if given.get("wind_trace") is not None:
        wind = f"wind of {given['wind_trace'].name}"
    sea = (
        "on land"
        if given.get("sea") in (None, "0", "calm")
        else f"sea state {given['sea']}, hull {given.get('hull') or 4:g} m"
    )
    if given.get("sea_trace") is not None:
        sea = f"deck of {given['sea_trace'].name}"
    return f"{wind}, {sea}, {given['runs']} flights of each"
