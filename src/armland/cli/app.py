"""All commands of `armland`."""

from typing import Annotated, Literal

import typer

from armland import __version__
from armland.cli.commands.detector import DETECTOR_EPILOG, detector
from armland.cli.commands.envelope import ENVELOPE_EPILOG, envelope
from armland.cli.commands.gains import GAINS_EPILOG, gains
from armland.cli.commands.logs import LOG_EPILOG, REPORT_EPILOG, log, report
from armland.cli.commands.paper import PAPER_EPILOG, paper
from armland.cli.commands.run import LAND_EPILOG, RUN_EPILOG, TAKEOFF_EPILOG, land, run, takeoff
from armland.cli.commands.takeoff_weight import TAKEOFF_WEIGHT_EPILOG, takeoff_weight
from armland.cli.commands.verify import VERIFY_EPILOG, verify

app = typer.Typer(
    name="armland",
    help="Simulates, proves, flies and judges the landing of a VTOL UAV that a robot arm catches and puts down.",
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


app.command(epilog=LAND_EPILOG)(land)
app.command(epilog=TAKEOFF_EPILOG)(takeoff)
app.command(epilog=RUN_EPILOG)(run)
app.command(epilog=PAPER_EPILOG)(paper)
app.command(epilog=REPORT_EPILOG)(report)
app.command(epilog=LOG_EPILOG)(log)
app.command(epilog=VERIFY_EPILOG)(verify)
app.command(epilog=GAINS_EPILOG)(gains)
app.command(epilog=ENVELOPE_EPILOG)(envelope)
app.command(epilog=TAKEOFF_WEIGHT_EPILOG)(takeoff_weight)
app.command(epilog=DETECTOR_EPILOG)(detector)


@app.command()
def schema(
    kind: Annotated[Literal["scenario", "landing", "paper"], typer.Argument(hidden=True)] = "scenario",
) -> None:
    """Print the JSON schema of a scenario file, for editors that complete and check TOML."""
    from armland.scenario import schema as scenario_schema

    print(scenario_schema())
