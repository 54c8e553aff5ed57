"""The commands around the paper: `paper`, its comparison of laws, `verify`, `gains`."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from armland.cli.console import announce_compilation, make_writable, progress_bar, reported

PAPER_EPILOG = """**Examples**

`armland paper` runs E1, E2 and E3 and writes figures, logs and result.json to out/paper.

`armland paper --json | jq .verdicts` prints the result alone.

`armland paper --seed 7 --out /tmp/seven` draws other sensor noise.

`armland paper --arm my_arm.urdf --ee tool0` puts your own arm in the LWR's place.

Exit code: 0 if all verdicts hold, 1 if one fails, 2 for bad input.
"""

VERIFY_EPILOG = """**Examples**

`armland verify` integrates 10 000 random states and checks E1 to E3 on the demonstrator (about half a minute).

`armland verify --samples 500 --no-figures` takes a few seconds.

Exit code: 0 if all verdicts hold, 1 if one fails, 2 for bad input.
"""

GAINS_EPILOG = """**Examples**

`armland gains` shows the gains of the law that splits attitude control between board and ground.

`armland gains --attitude 12 --delay-ms 60` asks for less, behind a longer link.

`armland gains --attitude 39 --over-link --delay-ms 30` is about what the published gains ask for, and is refused.
"""


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
    compared: Annotated[
        bool, typer.Option("--compare", help="Compare the paper's laws with others instead (scenario compare).")
    ] = False,
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
    if compared and scenario == "paper":
        scenario = "compare"
    loaded = load_scenario(scenario, overrides)
    if compared:
        _compare(loaded, out, as_json, console)
    announce_compilation(console)
    with console.status("Loading the laws and looking for a pose from which the arm reaches the whole path"):
        from armland.experiments.assembly import survey
        from armland.experiments.paper import run_experiments, warm_up

        workplace = survey(loaded)
        warm_up(loaded, workplace)
    make_writable(out)
    text = find(scenario).read_text(encoding="utf-8")
    with progress_bar(console) as bar:
        outcome = run_experiments(loaded, workplace, out, text, reported(bar))
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


def _compare(scenario: Any, out: Path, as_json: bool, console: Console) -> None:
    announce_compilation(console)
    from armland.experiments.comparison import compare
    from armland.view.report import print_comparison

    make_writable(out)
    with progress_bar(console) as bar:
        task = bar.add_task("laws compared", total=None)
        comparison = compare(
            scenario, lambda name, done, total: bar.update(task, completed=done, total=total, description=name)
        )
    text = json.dumps(comparison.result(), indent=2)
    (out / "comparison.json").write_text(text + "\n", encoding="utf-8")
    if as_json:
        print(text)
    else:
        print_comparison(comparison, out)
    raise typer.Exit(0 if all(v.holds for v in comparison.verdicts) else 1)


def verify(
    samples: Annotated[int, typer.Option(min=1, help="Random initial states of the UAV subsystem.")] = 10_000,
    scenario: Annotated[
        str, typer.Option(help="Scenario whose experiments are checked on the whole demonstrator.")
    ] = "paper",
    seed: Annotated[int | None, typer.Option(help="Seed of the initial states and of every random stream.")] = None,
    out: Annotated[Path, typer.Option(help="Folder for figures, logs, channels and result.json.")] = Path("out/verify"),
    as_json: Annotated[bool, typer.Option("--json", help="Print result.json alone on standard output.")] = False,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures.")] = True,
) -> None:
    """Run the paper's proof: where V₂ falls as (30) says, and which assumption breaks it on the whole demonstrator."""
    from armland.config import find, load_scenario

    console = Console(stderr=True)
    loaded = load_scenario(scenario, {} if seed is None else {"run": {"seed": seed}})
    announce_compilation(console, "experiments", "paths.survey_paths")
    from armland.experiments.assembly import survey
    from armland.experiments.ledger import save_channels
    from armland.experiments.verification import prove
    from armland.view.proof_table import print_proof

    workplace = survey(loaded)
    make_writable(out)
    with progress_bar(console) as bar:
        report = reported(bar)
        proof = prove(loaded, workplace, samples, out, find(scenario).read_text(encoding="utf-8"), report)
    result = proof.result()
    (out / "result.json").write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
    for name, channels in proof.channels.items():
        save_channels(channels, out / f"proof_{name}.csv")
    if figures:
        from armland.view.proof import draw_proof_figures

        draw_proof_figures(out, proof)
    if as_json:
        print(json.dumps(result, indent=2))
    else:
        print_proof(result, out)
    raise typer.Exit(0 if proof.holds else 1)


def gains(
    position: Annotated[float, typer.Option(help="Bandwidth of the position, rad/s.")] = 40.0,
    position_damping: Annotated[float, typer.Option(help="Its damping ratio.")] = 1.0,
    attitude: Annotated[float, typer.Option(help="Bandwidth of the attitude, rad/s.")] = 20.0,
    attitude_damping: Annotated[float, typer.Option(help="Its damping ratio.")] = 0.7,
    on_board: Annotated[
        bool, typer.Option("--on-board/--over-link", help="Where the attitude feedback is closed.")
    ] = True,
    delay_ms: Annotated[float | None, typer.Option(help="Uplink delay, ms; the scenario's if absent.")] = None,
    scenario: Annotated[str, typer.Option(help="Scenario that says UAV, rotors and link.")] = "compare",
    as_json: Annotated[bool, typer.Option("--json", help="Print plain data.")] = False,
) -> None:
    """Gains by rule: from wanted bandwidth and damping, with the margins that the delay leaves; refuses what it does not allow."""
    from armland.config import load_scenario
    from armland.experiments.assembly import designed
    from armland.scenario import Poles
    from armland.view.report import print_design

    overrides = {} if delay_ms is None else {"link": {"uplink_delay_ms": delay_ms}}
    loaded = load_scenario(scenario, overrides)
    # The rule itself refuses what is out of range, and says what would work.
    poles = Poles.model_construct(
        position_rad_s=position,
        position_damping=position_damping,
        attitude_rad_s=attitude,
        attitude_damping=attitude_damping,
    )
    print_design(designed(loaded, poles, on_board), as_json)
