"""The commands that open a page in the browser: `replay` of recorded flights, and the `console` of a live one."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from armland.cli import options
from armland.cli.console import diagnostics

REPLAY_EPILOG = """**Examples**

`armland replay out/land/landing.mcap` opens a page on which the flight is scrubbed through; space plays and pauses.

`armland replay out/paper/E1.mcap mine.mcap` shows two flights in one scene, and their difference in the plots.

`armland replay out/land/landing.mcap --port 0 --no-browser` serves on any free port and prints the address.

Exit code: 0 when it is stopped by Ctrl-C, 2 for a log that cannot be read or a port in use.
"""

if TYPE_CHECKING:
    from armland.console.live.choices import Choices

CONSOLE_EPILOG = """**Examples**

`armland console` opens a page on which a landing is started, watched and steered: space holds, escape aborts.

`armland console takeoff --seed 7` begins with a take-off of that seed.

`armland console --uav x500 --wind 4` begins with another UAV, in wind; all can be chosen anew in the page.

`armland console --host 0.0.0.0` serves other machines too, and prints an address with the token that pages have to know.

Exit code: 0 when it is stopped by Ctrl-C, 2 for bad input or a port in use.
"""

SERVED = {
    "host": options.option(
        str, "Address to serve on; any but this machine's own asks pages for a token.", default="127.0.0.1"
    ),
    "port": options.option(int, "Port; 0 takes any that is free.", default=8080, min=0, max=65535),
    "token": options.option(
        str | None, "Token that pages have to know; made anew if absent, and none on this machine itself."
    ),
    "browser": options.option(bool, "Open the page in the browser.", "--browser/--no-browser", default=True),
}
"""Options that say where a page is served."""


@options.taken(
    CONSOLE_EPILOG,
    mission=options.argument(str, "Mission that is chosen at first.", "landing"),
    scenario=options.option(str | None, f"{options.SCENARIO_HELP} The mission's own if absent.", metavar="SCENARIO"),
    law=options.LAW,
    wind=options.FLOWN["wind"],
    sea=options.FLOWN["sea"],
    **options.MADE,
    out=options.option(Path, "Folder for the logs; out/console if absent.", default=Path("out") / "console"),
    **SERVED,
)
def console(**given: Any) -> None:
    """Watch and steer a live flight in the browser: start, hold, abort, wind, sea, faults thrown in by hand."""
    from armland.cli.commands.arm import joints_of
    from armland.cli.commands.run import loaded_for
    from armland.cli.console import ready
    from armland.console.live.choices import Choices
    from armland.console.live.console import Console
    from armland.console.live.pilot import Pilot
    from armland.console.page.server import check_port
    from armland.experiments.episode import Flight, prepare
    from armland.mission.plan import Plan

    first = _first_choice(given)
    settings = tuple(given["settings"] or ())

    plans: dict[Choices, Plan] = {}

    def prepared(choices: Choices) -> Flight:
        options_of = {**given, **choices.given(settings)}
        scenario, same = loaded_for(choices.mission, options_of), choices.model_copy(update={"seed": 0})
        ready(joints_of(scenario))
        known = plans.get(same)
        flight = prepare(scenario, choices.mission, law=options_of["law"], known=known)
        plans.clear()
        if not flight.moved:
            # Another seed needs no other plan.
            plans[same] = flight.plan
        return flight

    check_port(given["host"], given["port"])
    # What is wrong with the first choice is told before there is a page.
    ready(joints_of(loaded_for(first.mission, {**given, **first.given(settings)})))
    said: list[Any] = []
    pilot = Pilot(prepared, given["out"], lambda words: said[0].say(words) if said else None)
    server = _serve(given, "armland console", lambda words: said[0].say(words) if said else None)
    try:
        # It may be stopped as soon as its address is known.
        said.append(Console(server, pilot, first, settings))
        said[0].run()
    except KeyboardInterrupt:
        pass
    finally:
        pilot.close()
        server.stop()


@options.taken(
    REPLAY_EPILOG,
    files=options.argument(list[Path], "Run log (MCAP), or two that are compared.", ..., metavar="LOG [LOG2]"),
    **SERVED,
)
def replay(**given: Any) -> None:
    """Scrub through a recorded flight in the browser, or through two in one scene."""
    from armland.console.recording import Recording
    from armland.console.replay import Replay
    from armland.errors import ConfigurationError
    from armland.runtime.log import read_log

    if len(given["files"]) > 2:
        raise ConfigurationError(f"{len(given['files'])} logs; a page shows one, or two side by side")
    runs = [Recording(read_log(file), file) for file in given["files"]]
    for note in (note for run in runs for note in run.notes):
        diagnostics().print(note, highlight=False, markup=False, soft_wrap=True)
    server = _serve(given, "armland replay")
    try:
        Replay(server, runs).run()
    except KeyboardInterrupt:
        pass
    finally:
        server.stop()


def _first_choice(given: dict[str, Any]) -> "Choices":
    # What the command line says of the first flight, as the page has it.
    from armland.console.live.choices import chosen
    from armland.errors import ConfigurationError
    from armland.mission.registry import MISSIONS, mission_named
    from armland.view.page.again import own_scenario

    mission = mission_named(given["mission"])
    if mission.name not in MISSIONS:
        raise ConfigurationError(
            f"mission {mission.name!r} flies without an arm and is not steered by hand: `armland run {mission.name}` flies it, "
            f"`armland replay` shows its log; the console flies {', '.join(MISSIONS)}"
        )
    named = {name: given[name] or "" for name in ("arm", "ee", "uav", "law", "sea")}
    own = given["scenario"] or own_scenario(mission.name, mission.start == "hinged")
    numbers = {"seed": 1 if given["seed"] is None else given["seed"], "wind": given["wind"] or 0.0}
    return chosen({"mission": given["mission"], "scenario": own, **named, **numbers})


def _serve(given: dict[str, Any], title: str, refused: Callable[[str], None] | None = None) -> Any:
    from armland.console.page.door import token_for
    from armland.console.page.server import PageServer

    server = PageServer(given["host"], given["port"], token_for(given["host"], given["token"]), title, refused)
    print(f"{title}: {server.address}  (Ctrl-C ends it)", flush=True)
    if given["browser"]:
        import webbrowser

        webbrowser.open(server.address)
    return server
