"""All commands of `armland`."""

from typing import Annotated, Literal

import typer

from armland import __version__
from armland.cli.commands.arm import arm
from armland.cli.commands.campaign import app as campaign
from armland.cli.commands.compare import compare
from armland.cli.commands.detector import detector
from armland.cli.commands.doctor import doctor
from armland.cli.commands.gains import gains
from armland.cli.commands.logs.export import export
from armland.cli.commands.logs.render import render
from armland.cli.commands.logs.show import log, report
from armland.cli.commands.margins import margins
from armland.cli.commands.paper import paper
from armland.cli.commands.reach import reach
from armland.cli.commands.run import land, run, takeoff
from armland.cli.commands.studies import envelope, takeoff_weight, verify
from armland.cli.commands.study import study
from armland.cli.commands.uav import uav
from armland.cli.commands.watch import console, replay

SCHEMA_EPILOG = """**Examples**

`armland schema` prints it; with `> scenario.schema.json` behind it, a file that an editor can be told of.
"""

EPILOG = """**Examples**

`armland land` lands a UAV; figures, log and report are in out/land.

`armland land --help` has more of them; so has each command.

`armland --install-completion` lets the shell complete commands and options.
"""

app = typer.Typer(
    name="armland",
    help="Simulates, proves, flies and judges the landing of a VTOL UAV that a robot arm catches and puts down.",
    epilog=EPILOG,
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
)


def _version(show: bool) -> None:
    if show:
        print(f"armland {__version__}")
        raise typer.Exit


@app.callback()
def root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Land a UAV with a robot arm."""


for command in (
    land,
    takeoff,
    run,
    paper,
    console,
    replay,
    report,
    render,
    log,
    export,
    arm,
    uav,
    reach,
    verify,
    gains,
    compare,
    study,
    envelope,
    margins,
    takeoff_weight,
    detector,
    doctor,
):
    app.command(epilog=vars(command)["epilog"])(command)


app.add_typer(campaign, name="campaign")


@app.command(epilog=SCHEMA_EPILOG)
def schema(kind: Annotated[Literal["scenario", "landing", "paper"], typer.Argument(hidden=True)] = "scenario") -> None:
    """Print the JSON schema of a scenario file, for editors that complete and check TOML."""
    from armland.scenario import schema as scenario_schema

    print(scenario_schema())
