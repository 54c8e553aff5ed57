"""The command `envelope`."""

from pathlib import Path
from typing import Annotated, Any

import typer

from armland.cli import options
from armland.cli.console import compile_first, diagnostics, progress_bar, reported
from armland.cli.exits import Judged
from armland.cli.results import Results, Work, publish

ENVELOPE_EPILOG = """**Examples**

`armland envelope` makes some hundred captures (about a minute) and draws the map.

`armland envelope my_landing.toml --json | jq .thresholds` prints how far inside each threshold lies.

Exit code: 0 if every threshold of the mission lies inside, 1 if one does not (says which), 2 for bad input, 3 if something broke,
130 if it was stopped.
"""


@options.taken(
    scenario=options.scenario("landing"),
    flights=(Annotated[int, typer.Option(min=0, max=10_000, help="Landings to fly and mark on the map.")], 6),
    settings=(options.Settings, None),
    out=(options.out("envelope"), Path("out/envelope")),
    **options.SHOWN,
)
def envelope(**given: Any) -> None:
    """Compute the capture envelope: offset, speed and tilt from which the magnet grips, beside the mission's thresholds."""
    loaded = options.load(given["scenario"], given)
    console = diagnostics()
    compile_first(console)
    from armland.experiments.envelope import study
    from armland.mission.plan import plan
    from armland.view.figures.envelope import draw_envelope
    from armland.view.tables.envelope import print_envelope

    plan(loaded, "landing")

    def work(_: Results) -> Work:
        with progress_bar(console) as bar:
            found = study.study(loaded, flights=given["flights"], progress=reported(bar))
        draw = (lambda folder: draw_envelope(folder, found)) if given["figures"] else None
        return Work(found.holds, found.result(), lambda out: print_envelope(found, out), draw)

    raise Judged(publish(given["out"], "envelope.json", ("envelope.*",), given["as_json"], work))
