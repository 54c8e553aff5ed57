"""The command `takeoff-weight`: does a speed that the arm gives allow a higher take-off weight?"""

from pathlib import Path
from typing import Annotated, Any

import typer

from armland.cli import options
from armland.cli.console import compile_first, diagnostics, progress_bar, reported
from armland.cli.exits import Judged
from armland.cli.results import Results, Work, publish

TAKEOFF_WEIGHT_EPILOG = """**Examples**

`armland takeoff-weight` computes and flies the largest take-off weights, and draws them.

`armland takeoff-weight --no-flights --json` prints what theory says, alone.

Exit code: 0 when it is done, 2 for bad input, 3 if something broke, 130 if it was stopped.
"""


@options.taken(
    scenario=options.scenario("landing"),
    settings=(options.Settings, None),
    out=(options.out("takeoff-weight"), Path("out/takeoff-weight")),
    flights=(Annotated[bool, typer.Option("--flights/--no-flights", help="Fly in the plant, or theory alone.")], True),
    **options.SHOWN,
)
def takeoff_weight(**given: Any) -> None:
    """Find the largest take-off weight against the speed that the arm gives: by momentum theory and by flights."""
    loaded = options.load(given["scenario"], given)
    console = diagnostics()
    compile_first(console)
    from armland.experiments.takeoff_weight.study import study
    from armland.view.figures.takeoff_weight import draw_takeoff_weight
    from armland.view.tables.takeoff_weight import print_takeoff_weight

    def work(_: Results) -> Work:
        with progress_bar(console) as bar:
            found = study(loaded, given["flights"], reported(bar))
        draw = (lambda folder: draw_takeoff_weight(folder, found, loaded)) if given["figures"] else None
        return Work(True, found.result(), lambda out: print_takeoff_weight(found, out), draw)

    raise Judged(publish(given["out"], "takeoff_weight.json", ("takeoff_weight.*",), given["as_json"], work))
