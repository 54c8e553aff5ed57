"""The command `armland`."""

import sys
from typing import Annotated, Literal

import typer

from armland import __version__
from armland.cli.detector import DETECTOR_EPILOG, detector
from armland.cli.envelope import ENVELOPE_EPILOG, envelope
from armland.cli.landing import LAND_EPILOG, TAKEOFF_EPILOG, land, takeoff
from armland.cli.paper import GAINS_EPILOG, PAPER_EPILOG, VERIFY_EPILOG, gains, paper, verify
from armland.cli.takeoff_study import TAKEOFF_WEIGHT_EPILOG, takeoff_weight
from armland.errors import ArmlandError

app = typer.Typer(
    name="armland",
    help="Simulates, proves, flies and judges the landing of a VTOL UAV that a robot arm catches and puts down.",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
)


INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells have it."""


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


@app.command()
def schema(
    kind: Annotated[Literal["paper", "landing"], typer.Argument(help="Which kind of scenario.")] = "paper",
) -> None:
    """Print the JSON schema of a scenario file, for editors that complete and check TOML."""
    if kind == "landing":
        from armland.mission.landing_schema import landing_schema

        print(landing_schema())
    else:
        from armland.config import schema as paper_schema

        print(paper_schema())


app.command(epilog=PAPER_EPILOG)(paper)
app.command(epilog=VERIFY_EPILOG)(verify)
app.command(epilog=GAINS_EPILOG)(gains)
app.command(epilog=LAND_EPILOG)(land)
app.command(epilog=TAKEOFF_EPILOG)(takeoff)
app.command(epilog=ENVELOPE_EPILOG)(envelope)
app.command(epilog=DETECTOR_EPILOG)(detector)
app.command(epilog=TAKEOFF_WEIGHT_EPILOG)(takeoff_weight)


def main() -> None:
    """Run the command; what armland refuses becomes one message and exit code 2."""
    try:
        app()
    except ArmlandError as e:
        print(f"armland: {e}", file=sys.stderr)
        sys.exit(2)
    except SystemExit as end:
        # That is what typer has made of Ctrl-C.
        if end.code == INTERRUPTED:
            print("armland: interrupted; a run log that was begun holds what was recorded so far", file=sys.stderr)
        raise
