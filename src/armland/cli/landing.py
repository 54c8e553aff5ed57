"""The commands of a landing: `land`, `takeoff`."""

import json
from pathlib import Path
from typing import Annotated, Any, Literal

import typer
from rich.console import Console

from armland.cli.console import announce_compilation, flights_told, make_writable, phases_told
from armland.errors import ConfigurationError

_EPILOG = """**Examples**

`armland COMMAND` flies one MISSION of the scenario that comes with armland; figures, log and result.json go to out/COMMAND.

`armland COMMAND --seed 7 --json | jq .reason` prints the result alone.

`armland COMMAND calm.toml --out /tmp/calm` flies a scenario of your own; `armland schema landing` says what it may hold.

`armland COMMAND --set imperfections.camera=false --set place.catch_m='[0.6, 0.0, 0.86]'` changes single values.

`armland COMMAND --set 'faults=[{kind="link_loss", phase="PHASE", after_s=0.5}]'` lets a device fail, as `[[faults]]` with the
same keys does in a scenario's file.

`armland COMMAND --arm my_arm.urdf --ee tool0` puts your own arm in the LWR's place.

`armland COMMAND --seeds 200` flies 200 seeds over all cores: spread of each figure beside its bound, campaign.json, one page.

Exit code: 0 if it succeeds (of a campaign: every seed), 1 if not (says why), 2 for bad input.
"""

LAND_EPILOG = _EPILOG.replace("COMMAND", "land").replace("MISSION", "landing").replace("PHASE", "carry")
TAKEOFF_EPILOG = _EPILOG.replace("COMMAND", "takeoff").replace("MISSION", "take-off").replace("PHASE", "carry_up")

ScenarioArgument = Annotated[
    str, typer.Argument(help="Landing scenario (TOML), or the name of one that comes with armland.")
]
Seed = Annotated[
    int | None,
    typer.Option(min=0, help="Seed of every random stream, the scenario's if absent; the first of a campaign."),
]
Seeds = Annotated[int, typer.Option(min=1, help="Fly this many seeds and print how many succeed.")]
Jobs = Annotated[int | None, typer.Option(min=1, help="Processes of a campaign; all cores if absent.")]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Replace a value of the scenario: dotted key, value as in TOML. Repeatable."
    ),
]
Arm = Annotated[
    Path | None, typer.Option(help="Another serial arm: URDF or MJCF file. Its pose at the start is searched for.")
]
EndEffector = Annotated[
    str | None, typer.Option("--ee", help="Link, body or site of the arm that carries the tool, z outwards.")
]
Out = Annotated[Path, typer.Option(help="Folder for figures, log and result.json.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print result.json alone on standard output.")]
Log = Annotated[bool, typer.Option("--log/--no-log", help="Write the run log (MCAP) of a single flight.")]
Figures = Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures.")]


def land(
    scenario: ScenarioArgument = "landing",
    seed: Seed = None,
    seeds: Seeds = 1,
    jobs: Jobs = None,
    settings: Settings = None,
    arm: Arm = None,
    ee: EndEffector = None,
    out: Out = Path("out/land"),
    as_json: AsJson = False,
    log: Log = True,
    figures: Figures = True,
) -> None:
    """Land a UAV: approach, capture, hand-over, set-down and release, with live progress by phase."""
    _command("landing", scenario, seed, seeds, jobs, _with_arm(settings, arm, ee), out, as_json, log, figures)


def takeoff(
    scenario: ScenarioArgument = "landing",
    seed: Seed = None,
    seeds: Seeds = 1,
    jobs: Jobs = None,
    settings: Settings = None,
    arm: Arm = None,
    ee: EndEffector = None,
    out: Out = Path("out/takeoff"),
    as_json: AsJson = False,
    log: Log = True,
    figures: Figures = True,
) -> None:
    """Take off from the cradle: lift, spin up, carry upwards, release, fly off; with live progress by phase."""
    _command("takeoff", scenario, seed, seeds, jobs, _with_arm(settings, arm, ee), out, as_json, log, figures)


def _command(
    mission: Literal["landing", "takeoff"],
    scenario: str,
    seed: int | None,
    seeds: int,
    jobs: int | None,
    settings: dict[str, Any],
    out: Path,
    as_json: bool,
    log: bool,
    figures: bool,
) -> None:
    from armland.mission.landing_scenario import landing_scenario

    loaded = landing_scenario(scenario, settings)
    console = Console(stderr=True)
    announce_compilation(console, "mission", "landing.landing_tick")
    from armland.experiments.landing import prepare

    flight = prepare(loaded, mission, seed)
    make_writable(out)
    success = (
        _campaign(flight.setup, seeds, jobs, out, as_json, figures, console)
        if seeds > 1
        else _fly(flight, out, as_json, log, figures, console)
    )
    raise typer.Exit(0 if success else 1)


def _with_arm(settings: list[str] | None, arm: Path | None, ee: str | None) -> dict[str, Any]:
    from armland.cli.settings import parse_settings
    from armland.config import update

    overrides: dict[str, Any] = {}
    if arm is not None:
        part = {"file": str(arm.resolve()), "ee": ee or "flange", "elbow_joint": None, "home_rad": None}
        overrides = {"demonstrator": {"arm": part}, "place": {"home_deg": None}}
    elif ee is not None:
        overrides = {"demonstrator": {"arm": {"ee": ee}}}
    update(overrides, parse_settings(settings or []))
    return overrides


def _fly(flight: Any, out: Path, as_json: bool, log: bool, figures: bool, console: Console) -> bool:
    from armland.experiments.landing import fly

    setup = flight.setup
    mission, file = setup.mission, out / f"{setup.mission}.mcap"
    # What an earlier flight left is not to be taken for this one's, should this one not get to its end.
    _remove(out / "result.json", file, *(out / f"{mission}_overview.{kind}" for kind in ("pdf", "png")))
    with phases_told(console, mission) as tell:
        outcome = fly(flight, tell, file if log else None)
    text = json.dumps(outcome.result(), indent=2)
    (out / "result.json").write_text(text + "\n", encoding="utf-8")
    if figures:
        from armland.view.landing_figures import draw_landing_figures

        draw_landing_figures(out, outcome, setup.scenario.demonstrator.run.rate_hz, mission)
    if as_json:
        print(text)
    else:
        from armland.view.landing_report import print_landing

        print_landing(outcome, out)
    return outcome.success


def _campaign(
    setup: Any, seeds: int, jobs: int | None, out: Path, as_json: bool, figures: bool, console: Console
) -> bool:
    from armland.experiments.campaign_summary import summarise
    from armland.experiments.landing import campaign
    from armland.view.campaign_report import draw_campaign, print_campaign

    file, first, mission = out / "campaign.json", setup.scenario.landing.seed, setup.mission
    _remove(file)
    with flights_told(console, mission, seeds) as tell:
        outcomes = campaign(setup.scenario, range(first, first + seeds), mission, jobs, done=lambda o: tell(o.success))
    hinge_bound = float(setup.parameters["hinge_max"][0])
    summary = summarise(outcomes, hinge_bound)
    text = json.dumps({"summary": summary.result(), "flights": [o.result() for o in outcomes]}, indent=2)
    file.write_text(text + "\n", encoding="utf-8")
    if figures:
        draw_campaign(out, outcomes, hinge_bound, mission)
    if as_json:
        print(text)
    else:
        print_campaign(summary, mission, out)
        for o in outcomes:
            if not o.success:
                print(f"seed {o.seed}: {o.reason}")
    return summary.successes == seeds


def _remove(*files: Path) -> None:
    for file in files:
        try:
            file.unlink(missing_ok=True)
        except OSError as e:
            raise ConfigurationError(f"--out: {str(file)!r} of an earlier run cannot be replaced: {e.strerror}") from e
