"""The command `armland`."""

import json
import os
import sys
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

from armland import __version__
from armland.errors import ArmlandError

app = typer.Typer(
    name="armland",
    help="Simulates, proves, flies and judges the landing of a VTOL UAV that a robot arm catches and puts down.",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
)

PAPER_EPILOG = """**Examples**

`armland paper` runs E1, E2 and E3 and writes figures, logs and result.json to out/paper.

`armland paper --json | jq .verdicts` prints the result alone.

`armland paper --seed 7 --out /tmp/seven` draws other sensor noise.

`armland paper --arm my_arm.urdf --ee tool0` puts your own arm in the LWR's place.

Exit code: 0 if all verdicts hold, 1 if one fails, 2 for bad input.
"""


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


@app.command(epilog=PAPER_EPILOG)
def paper(
    scenario: Annotated[
        str, typer.Option(help="Scenario file (TOML), or the name of one that comes with armland.")
    ] = "paper",
    arm: Annotated[Path | None, typer.Option(help="Another serial arm: URDF or MJCF file.")] = None,
    ee: Annotated[
        str | None, typer.Option(help="Its frame that carries the tool, z outwards: link, body or site.")
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of every random stream.")] = None,
    out: Annotated[Path, typer.Option(help="Folder for figures, logs and result.json.")] = Path("out/paper"),
    as_json: Annotated[bool, typer.Option("--json", help="Print result.json alone on standard output.")] = False,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures and the picture.")] = True,
) -> None:
    """Reproduce the paper's experiments E1 to E3 and judge them against the published figures."""
    from armland.config import find, load_scenario

    console = Console(stderr=True)
    overrides: dict[str, Any] = {}
    if seed is not None:
        overrides["run"] = {"seed": seed}
    if arm is not None:
        overrides["arm"] = {"file": str(arm.resolve()), "ee": ee or "flange", "elbow_joint": None, "home_rad": None}
        overrides["trajectory"] = {"start_m": None}
    elif ee is not None:
        overrides["arm"] = {"ee": ee}
    loaded = load_scenario(scenario, overrides)
    if _compiles():
        console.print("Compiling the control laws: this happens once and takes less than a minute.", highlight=False)
    with console.status("Loading the laws and looking for a pose from which the arm reaches the whole path"):
        from armland.experiments.assembly import survey
        from armland.experiments.paper import run_experiments, warm_up

        workplace = survey(loaded)
        warm_up(loaded, workplace)
    _writable(out)
    text = find(scenario).read_text(encoding="utf-8")
    with _progress(console) as bar:
        tasks: dict[str, Any] = {}

        def report(name: str, done: int, total: int) -> None:
            if name not in tasks:
                tasks[name] = bar.add_task(name, total=total)
            bar.update(tasks[name], completed=done)

        outcome = run_experiments(loaded, workplace, out, text, report)
    result = outcome.result()
    (out / "result.json").write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
    if figures:
        from armland.view.report import illustrate

        illustrate(out, loaded, workplace, outcome.records, console)
    if as_json:
        print(json.dumps(result, indent=2))
    else:
        from armland.view.report import print_paper

        print_paper(result, out)
    raise typer.Exit(0 if outcome.reproduced else 1)


@app.command()
def schema() -> None:
    """Print the JSON schema of a scenario file, for editors that complete and check TOML."""
    from armland.config import schema as text

    print(text())


def _progress(console: Console) -> Progress:
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
        console=console,
        transient=True,
    )


def _compiles() -> bool:
    # Numba keeps compiled laws beside their source; none there means this start compiles them.
    folder = Path(__file__).parent / "control" / "__pycache__"
    return os.environ.get("NUMBA_DISABLE_JIT") != "1" and not any(folder.glob("coordinated.coordinated_tick-*.nbc"))


def _writable(out: Path) -> None:
    from armland.errors import ConfigurationError

    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as e:
        raise ConfigurationError(f"--out {str(out)!r} cannot be made a folder: {e.strerror}") from e
    if not os.access(out, os.W_OK):
        raise ConfigurationError(f"--out {str(out)!r} is not writable")


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
