"""The command `envelope`."""

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from armland.cli.console import announce_compilation, make_writable, progress_bar, reported

ENVELOPE_EPILOG = """**Examples**

`armland envelope` makes some hundred captures (about a minute) and draws the map.

`armland envelope my_landing.toml --json | jq .thresholds` prints how far inside each threshold lies.

Exit code: 0 if every threshold of the mission lies inside, 1 if one does not (says which), 2 for bad input.
"""


def envelope(
    scenario: Annotated[
        str, typer.Argument(help="Landing scenario (TOML), or the name of one that comes with armland.")
    ] = "landing",
    flights: Annotated[int, typer.Option(min=0, help="Landings to fly and mark on the map.")] = 6,
    out: Annotated[Path, typer.Option(help="Folder for the figure and envelope.json.")] = Path("out/envelope"),
    as_json: Annotated[bool, typer.Option("--json", help="Print envelope.json alone on standard output.")] = False,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figure.")] = True,
) -> None:
    """Compute the capture envelope: offset, speed and tilt from which the magnet grips, beside the mission's thresholds."""
    console = Console(stderr=True)
    announce_compilation(console, "mission", "landing.landing_tick")
    from armland.experiments.envelope_study import study
    from armland.mission.landing_scenario import landing_scenario
    from armland.mission.landing_setup import set_up

    loaded = landing_scenario(scenario)
    set_up(loaded)
    make_writable(out)
    with progress_bar(console) as bar:
        found = study(loaded, flights=flights, progress=reported(bar))
    text = json.dumps(found.result(), indent=2)
    (out / "envelope.json").write_text(text + "\n", encoding="utf-8")
    if figures:
        from armland.view.envelope_figures import draw_envelope

        draw_envelope(out, found)
    if as_json:
        print(text)
    else:
        from armland.view.envelope_report import print_envelope

        print_envelope(found, out)
    raise typer.Exit(0 if found.holds else 1)
