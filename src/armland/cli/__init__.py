"""The command `armland`."""

import sys
from typing import Annotated

import typer

from armland import __version__
from armland.cli.landing import LAND_EPILOG, detector, land, takeoff
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
def schema() -> None:
    """Print the JSON schema of a scenario file, for editors that complete and check TOML."""
    from armland.config import schema as text

    print(text())


app.command(epilog=PAPER_EPILOG)(paper)
app.command(epilog=VERIFY_EPILOG)(verify)
app.command(epilog=GAINS_EPILOG)(gains)
app.command(epilog=LAND_EPILOG)(land)
app.command(epilog=LAND_EPILOG.replace("land", "takeoff"))(takeoff)
app.command()(detector)
app.command(epilog=TAKEOFF_WEIGHT_EPILOG)(takeoff_weight)


def main() -> None:
    """Run the command; what armland refuses becomes one message and exit code 2."""
    try:
        app()
    except ArmlandError as e:
        print(f"armland: {e}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("armland: interrupted; what was recorded so far is on disk", file=sys.stderr)
        sys.exit(130)
