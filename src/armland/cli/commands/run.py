"""The commands that fly a mission: `run`, and `land` and `takeoff`, which are names for it."""

import os
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from rich.console import Console

from armland.cli import options
from armland.cli.commands.arm import joints_of, tell_arm
from armland.cli.commands.uav import tell_uav
from armland.cli.console import diagnostics, flights_told, patiently, phases_told, progress_bar, ready
from armland.cli.exits import EXPLAINED
from armland.cli.results import Results, Work, publish
from armland.errors import ConfigurationError

if TYPE_CHECKING:
    from armland.experiments.episode import Flight
    from armland.experiments.operator.hand import Hand
    from armland.experiments.operator.message import Message
    from armland.records import Records
    from armland.runtime.log import Log
    from armland.scenario import Scenario

STORE = "campaign.sqlite"

_EPILOG = """**Examples**

`armland COMMAND` flies one MISSION of the scenario that comes with armland; report.html, figures, log and result.json go to
out/FOLDER.

`armland COMMAND --film` makes a film of some seconds as well; `armland render` makes others of the log.

`armland COMMAND --seed 7 --json | jq .reason` prints the result alone.

`armland COMMAND calm.toml --out /tmp/calm` flies a scenario of your own; `armland schema` says what it may hold.

`armland COMMAND --set imperfections.camera=false --set place.catch_m='[0.6, 0.0, 0.86]'` changes single values.

`armland COMMAND --set 'faults=[{kind="link_loss", phase="PHASE", after_s=0.5}]'` lets a device fail, as `[[faults]]` with the
same keys does in a scenario's file.

`armland COMMAND --deviation published` flies a plant that differs from the controller's belief as far as sources say a real one may;
`--set deviation.uav.mass=0.1` gives one deviation a range of its own.

`armland COMMAND --arm my_arm.urdf --ee tool0` puts your own arm in the LWR's place.

`armland COMMAND --uav x500` lands another UAV, one that comes with armland or your own as a file; `armland uav x500` says what of it.

`armland COMMAND --wind 4` flies in wind of 4 m/s at 20 ft with turbulence; `armland COMMAND --wind-trace wind.csv` in a recorded one.

`armland COMMAND --sea 2 --hull 4` flies over a deck on a hull of 4 m in sea state 2; `armland COMMAND --sea-trace deck.csv` over a
recorded one.

`armland COMMAND --operator out/console/landing_1.mcap` flies again what somebody steered by hand in `armland console`.

`armland COMMAND --law my_file.py:my_law` controls the held UAV by your own law.

`armland COMMAND --seeds 200` flies 200 seeds over all cores: spread of each figure beside its bound, campaign.json, one page.

"""


def _epilog(**words: str) -> str:
    text = _EPILOG
    for word, replacement in words.items():
        text = text.replace(word, replacement)
    return text + EXPLAINED


LAND_EPILOG = _epilog(COMMAND="land", MISSION="landing", FOLDER="land", PHASE="carry")
TAKEOFF_EPILOG = _epilog(COMMAND="takeoff", MISSION="take-off", FOLDER="takeoff", PHASE="carry_up")
RUN_EPILOG = f"""**Examples**

`armland run landing` is `armland land`; `armland run E3` flies the third of the paper's experiments.

`armland run E3 --law examples/own_law.py:my_law` flies the experiment's path by your own law.

`armland run track compare --experiment observer` flies a row of a scenario's `[experiments]`.

`armland run landing calm.toml --seeds 50 --jobs 2` flies a campaign.

{EXPLAINED}
"""


@options.taken(
    RUN_EPILOG,
    mission=options.argument(str, "Name of a mission: landing, takeoff, E1, E2, E3, track, or one of your own.", ...),
    scenario=options.argument(str | None, f"{options.SCENARIO_HELP} The mission's own if absent."),
    experiment=options.option(str | None, "Row of the scenario's experiments, for the mission `track`."),
    **options.FLOWN,
    out=options.out("MISSION"),
)
def run(**given: Any) -> None:
    """Fly any mission: the landing, the take-off, the paper's experiments, or a row of your own."""
    mission = given.pop("mission")
    _fly(mission, {**given, "out": given["out"] or Path("out") / mission})


@options.taken(LAND_EPILOG, scenario=options.scenario("landing"), **options.FLOWN, out=options.out("land"))
def land(**given: Any) -> None:
    """Land a UAV: approach, capture, hand-over, set-down and release, with live progress by phase."""
    _fly("landing", given)


@options.taken(TAKEOFF_EPILOG, scenario=options.scenario("landing"), **options.FLOWN, out=options.out("takeoff"))
def takeoff(**given: Any) -> None:
    """Take off from the cradle: lift, spin up, carry upwards, release, fly off; with live progress by phase."""
    _fly("takeoff", given)


def loaded_for(mission: str, given: dict[str, Any]) -> "Scenario":
    """The scenario that a mission is flown with, as the options `given` say; errors as for `options.load`."""
    from armland.mission.registry import mission_named
    from armland.view.page.again import own_scenario

    name = given["scenario"] or own_scenario(mission, mission_named(mission).start == "hinged")
    return options.load_flown(mission, name, given)


def _fly(mission: str, given: dict[str, Any]) -> NoReturn:
    script = script_of_option(given)
    loaded = loaded_for(mission, given)
    tell_arm(loaded, diagnostics())
    tell_uav(loaded, diagnostics())
    console = ready(joints_of(loaded))
    from armland.experiments.episode import prepare
    from armland.plant.wind.limits import told_gusts

    with patiently(diagnostics()):
        flight = prepare(loaded, mission, law=given["law"], experiment=given.get("experiment"))
    if moved := flight.moved or _roomier(loaded, flight.scenario):
        console.print(f"place: {moved}", highlight=False, markup=False, soft_wrap=True)
    if gusts := told_gusts(flight.scenario, flight.simulator.scene.uav_mass):
        console.print(f"wind: {gusts}", highlight=False, markup=False, soft_wrap=True)
    if given["seeds"] > 1:
        _campaign(flight, mission, given, console)
    _single(flight, mission, given, console, script)


def _roomier(wanted: "Scenario", flown: "Scenario") -> str:
    # Where rough weather puts catch and cradle; empty where they are as they were.
    if wanted.place.put_down_m == flown.place.put_down_m:
        return ""
    from armland.mission.feasibility.placing import told_places

    return f"{told_places(flown, wanted)} chosen, because air that sinks and a deck that rises need more room below the catch"


def script_of_option(given: dict[str, Any]) -> "tuple[Message, ...] | None":
    """The messages that `--operator` names; None where it is not given.

    Raises:
        LogError: they cannot be read.
        ConfigurationError: a campaign, which nobody steers.
    """
    if given.get("operator") is None:
        return None
    if given["seeds"] > 1:
        raise ConfigurationError("--operator steers one flight; leave out --seeds")
    from armland.experiments.operator.script import read_script

    return read_script(given["operator"])


def _steered(flight: "Flight", script: "tuple[Message, ...] | None") -> "Hand | None":
    if script is None:
        return None
    from armland.experiments.operator.hand import Hand

    return Hand(flight, script)


def _tell_same(given: dict[str, Any], ticks: "Records", console: Console) -> None:
    # Where the script stands in a log, whether the flight is that of the log.
    if given["operator"] is None or given["operator"].suffix != ".mcap":
        return
    from armland.experiments.operator.script import first_difference
    from armland.runtime.log import read_log

    k = first_difference(ticks, read_log(given["operator"]).ticks)
    words = "the same ticks as in" if k is None else f"not the same from tick {k} on as in"
    console.print(f"{words} {given['operator']}", highlight=False, markup=False, soft_wrap=True)


def _single(
    flight: "Flight", mission: str, given: dict[str, Any], console: Console, script: "tuple[Message, ...] | None"
) -> NoReturn:
    from armland.experiments.episode import fly_prepared
    from armland.experiments.judge.brief import brief_of
    from armland.experiments.judge.deck import seen_from_deck
    from armland.records import MESSAGES
    from armland.runtime.log import read_log
    from armland.view.flown import Flown
    from armland.view.report import draw, write_report
    from armland.view.tables.flight import print_flight

    name, out = f"{mission}.mcap", given["out"]

    def work(results: Results) -> Work:
        # Figures, report and film are made from the log, also where nobody keeps it.
        shown = given["figures"] or given["film"]
        file = results.folder / name if given["log"] else results.scratch(name) if shown else None
        log = cache(lambda: read_log(out / name if given["log"] else results.scratch(name)))
        hand = _steered(flight, script)
        with phases_told(console, mission) as tell:
            episode = fly_prepared(flight if hand is None else hand.flight, file, tell, hand)
        _tell_same(given, episode.ticks, console)
        run = Flown(
            mission, seen_from_deck({name: episode.ticks[name] for name in MESSAGES}), brief_of(episode.metadata)
        )
        return Work(
            episode.result["success"],
            episode.result,
            lambda folder: print_flight(episode.result, run, folder),
            lambda folder: draw(folder, [log()]),
            lambda folder: write_report(folder, [log()], episode.result),
            (lambda folder: _film(log(), folder, console)) if given["film"] else None,
        )

    owned = (name, "*_overview.p??", "fig*.p??", "scene.png", "report.html", "film.mp4")
    publish(given, "result.json", owned, work)


def _film(log: "Log", folder: Path, console: Console) -> None:
    from armland.view.film.film import SHORT, film, take_of

    with progress_bar(console) as bar:
        task = bar.add_task("film")
        film(take_of(log), folder / "film.mp4", SHORT, lambda done, n: bar.update(task, completed=done, total=n))


def _campaign(flight: "Flight", mission: str, given: dict[str, Any], console: Console) -> NoReturn:
    from armland.experiments.campaign.crews.threads import threads
    from armland.experiments.campaign.description import Description
    from armland.experiments.campaign.engine import Campaign, conduct
    from armland.experiments.campaign.rows import Job
    from armland.experiments.campaign.store import Store
    from armland.experiments.campaign.summary import summarise
    from armland.experiments.judge.figures import bounds
    from armland.view.figures.campaign import draw_campaign
    from armland.view.page.sheet import write_page
    from armland.view.page.study import campaign_sheet
    from armland.view.tables.campaign import print_campaign

    first, seeds, limits = flight.scenario.run.seed, given["seeds"], bounds(flight.brief)
    job = Job(flight.scenario.frozen(), mission, given["law"], given.get("experiment"))
    campaign = Campaign(Description(mission=mission, first_seed=first), job, seeds, limits)

    def work(results: Results) -> Work:
        with (
            Store(results.folder / STORE, write=True) as store,
            flights_told(console, mission, seeds) as tell,
        ):
            conduct(campaign, store, threads(given["jobs"] or os.cpu_count() or 1), told=lambda row: tell(row.success))
            rows = [row.judged() for row in store.rows()]
        summary = summarise(rows, limits)
        return Work(
            summary.successes == seeds,
            {"summary": summary.result(), "flights": rows},
            lambda out: print_campaign(summary, rows, mission, out),
            lambda folder: draw_campaign(folder, rows, limits, mission),
            lambda folder: write_page(folder, campaign_sheet(summary, rows, limits, flight)),
        )

    publish(given, "campaign.json", (f"{mission}_campaign.p??", "report.html", STORE), work)
