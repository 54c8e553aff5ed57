"""The command `takeoff-weight`: does a speed that the arm gives allow a higher take-off weight?"""

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from armland.cli.console import announce_compilation, make_writable, progress_bar, reported

TAKEOFF_WEIGHT_EPILOG = """**Examples**

`armland takeoff-weight` computes and flies the largest take-off weights, and draws them.

`armland takeoff-weight --no-flights --json` prints what theory says, alone.

Exit code: 0 when it is done, 2 for bad input.
"""


def takeoff_weight(
    scenario: Annotated[
        str, typer.Argument(help="Landing scenario (TOML), or the name of one that comes with armland.")
    ] = "landing",
    out: Annotated[Path, typer.Option(help="Folder for figure and takeoff_weight.json.")] = Path("out/takeoff-weight"),
    as_json: Annotated[
        bool, typer.Option("--json", help="Print takeoff_weight.json alone on standard output.")
    ] = False,
    flights: Annotated[bool, typer.Option("--flights/--no-flights", help="Fly in the plant, or theory alone.")] = True,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figure.")] = True,
) -> None:
    """Find the largest take-off weight against the speed that the arm gives: by momentum theory and by flights."""
    console = Console(stderr=True)
    announce_compilation(console, "mission", "landing.landing_tick")
    from armland.experiments.takeoff_weight import study
    from armland.mission.landing_scenario import landing_scenario

    loaded = landing_scenario(scenario)
    make_writable(out)
    with progress_bar(console) as bar:
        found = study(loaded, flights, reported(bar))
    text = json.dumps(found.result(), indent=2)
    (out / "takeoff_weight.json").write_text(text + "\n", encoding="utf-8")
    if figures:
        from armland.view.takeoff_weight_figure import draw_takeoff_weight

        draw_takeoff_weight(out, found, loaded)
    if as_json:
        print(text)
        return
    table = Table(title="Take-off weight over the static thrust", title_justify="left")
    for column in ("speed given", "[m/s]", "theory", "flown"):
        table.add_column(column.replace("[", r"\["), justify="right" if column != "speed given" else "left")
    for x in found.flights:
        table.add_row(x.name, f"{x.speed_mps:.2f}", f"{x.theory:.4f}", f"{x.flown:.4f} ± {x.half_width:.4f}")
    shown = Console(highlight=False)
    if found.flights:
        shown.print(table)
    shown.print(found.verdict, markup=False)
    shown.print(f"The data is in {out}/", markup=False)
