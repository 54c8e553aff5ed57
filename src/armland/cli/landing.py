"""The commands of a landing: `land`, `takeoff`."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from armland.cli.console import announce_compilation, make_writable, progress_bar

LAND_EPILOG = """**Examples**

`armland land` flies one landing of the scenario `landing`.

`armland land --seed 7 --json` prints its result alone.

`armland land --seeds 200` flies 200 seeds over all cores.

Exit code: 0 if it succeeds, 1 if not (says why), 2 for bad input.
"""


def land(
    scenario: Annotated[
        str, typer.Argument(help="Landing scenario (TOML), or the name of one that comes with armland.")
    ] = "landing",
    seed: Annotated[
        int | None, typer.Option(min=0, help="Seed of every random stream; the first of a campaign.")
    ] = None,
    seeds: Annotated[int, typer.Option(min=1, help="Fly this many seeds and print how many succeed.")] = 1,
    out: Annotated[Path, typer.Option(help="Folder for figures and result.json.")] = Path("out/land"),
    as_json: Annotated[bool, typer.Option("--json", help="Print result.json alone on standard output.")] = False,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures.")] = True,
) -> None:
    """Land a UAV: approach, capture, hand-over, set-down and release, with live progress by phase."""
    _fly("landing", scenario, seed, seeds, out, as_json, figures)


def takeoff(
    scenario: Annotated[
        str, typer.Argument(help="Landing scenario (TOML), or the name of one that comes with armland.")
    ] = "landing",
    seed: Annotated[
        int | None, typer.Option(min=0, help="Seed of every random stream; the first of a campaign.")
    ] = None,
    seeds: Annotated[int, typer.Option(min=1, help="Fly this many seeds and print how many succeed.")] = 1,
    out: Annotated[Path, typer.Option(help="Folder for figures and result.json.")] = Path("out/takeoff"),
    as_json: Annotated[bool, typer.Option("--json", help="Print result.json alone on standard output.")] = False,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures.")] = True,
) -> None:
    """Take off from the cradle: lift, spin up, carry upwards, release, fly off."""
    _fly("takeoff", scenario, seed, seeds, out, as_json, figures)


def _fly(mission: Any, scenario: str, seed: int | None, seeds: int, out: Path, as_json: bool, figures: bool) -> None:
    console = Console(stderr=True)
    announce_compilation(console, "mission", "landing.landing_tick")
    from armland.experiments.landing import campaign, fly_landing, fly_takeoff
    from armland.mission.landing_scenario import landing_scenario
    from armland.mission.landing_setup import set_up

    loaded = landing_scenario(scenario)
    if seed is not None:
        loaded = loaded._replace(landing=loaded.landing.model_copy(update={"seed": seed}))
    set_up(loaded, mission)
    make_writable(out)
    if seeds > 1:
        first = loaded.landing.seed
        with progress_bar(console) as bar:
            task = bar.add_task(mission, total=seeds)
            outcomes = campaign(loaded, range(first, first + seeds), mission, done=lambda _: bar.advance(task))
        text = json.dumps([o.result() for o in outcomes], indent=2)
        (out / "campaign.json").write_text(text + "\n", encoding="utf-8")
        good = sum(o.success for o in outcomes)
        print(text if as_json else f"{good} of {seeds} succeed; each outcome is in {out / 'campaign.json'}")
        for o in outcomes:
            if not o.success:
                console.print(f"seed {o.seed}: {o.reason}", highlight=False)
        raise typer.Exit(0 if good == seeds else 1)
    with console.status(mission) as status:
        fly = fly_landing if mission == "landing" else fly_takeoff
        outcome = fly(loaded, progress=lambda phase, t: status.update(f"{t:5.1f} s  {phase}"))
    text = json.dumps(outcome.result(), indent=2)
    (out / "result.json").write_text(text + "\n", encoding="utf-8")
    if figures:
        from armland.view.landing_figures import draw_landing_figures

        draw_landing_figures(out, outcome, loaded.demonstrator.run.rate_hz, mission)
    if as_json:
        print(text)
    else:
        from armland.view.landing_report import print_landing

        print_landing(outcome, out)
    raise typer.Exit(0 if outcome.success else 1)
