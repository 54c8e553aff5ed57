"""The command `reach`."""

from typing import Any

from armland.cli import options
from armland.cli.commands.arm import joints_of, tell_arm
from armland.cli.console import diagnostics, ready
from armland.cli.results import Results, Work, publish

EPILOG = """**Examples**

`armland reach --arm my_arm.urdf` draws where catch and cradle may be for an arm, and says the nearest place that works.

`armland reach --arm my_arm.urdf --set place.catch_m='[0.5, 0.0, 0.9]'` says whether it can catch there, and if not, where next to it.

`armland reach --arm my_arm.urdf --json | jq .nearest` prints that place alone.

`armland reach --arm my_arm.urdf --torque-limits 87,87,87,87,12,12,12 --no-figures` says what the file does not.

Exit code: 0 if there is a place at which the arm can land, 1 if none was found, 2 for bad input, 3 if something broke, 130 if it was
stopped.
"""


@options.taken(
    EPILOG,
    scenario=options.scenario("landing"),
    settings=options.SETTINGS,
    **options.ARM,
    out=options.out("reach"),
    **options.SHOWN,
)
def reach(**given: Any) -> None:
    """Draw where an arm can catch and put down, and find the nearest place that works."""
    loaded = options.load(given["scenario"], given)
    tell_arm(loaded, diagnostics())
    ready(joints_of(loaded))
    from armland.experiments.reach import reach as search
    from armland.view.figures.reach import draw_reach
    from armland.view.tables.reach import print_reach

    found = search(loaded)

    def work(_: Results) -> Work:
        return Work(
            found.lands,
            found.result(),
            lambda out: print_reach(found, out),
            lambda folder: draw_reach(folder, found),
        )

    publish(given, "reach.json", ("reach.p??",), work)
