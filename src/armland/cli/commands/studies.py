"""The commands that study: `verify`, `envelope` and `takeoff-weight`."""

from typing import Any

from armland.cli import options
from armland.cli.commands.arm import joints_of
from armland.cli.console import ready, reported
from armland.cli.exits import EXPLAINED
from armland.cli.results import Results, Work, publish

VERIFY_EPILOG = f"""**Examples**

`armland verify` integrates 10 000 random states and checks E1 to E3 on the demonstrator (about half a minute).

`armland verify --samples 500 --no-figures` takes a few seconds.

{EXPLAINED}
"""

ENVELOPE_EPILOG = """**Examples**

`armland envelope` makes some hundred captures (about a minute) and draws the map.

`armland envelope my_landing.toml --json | jq .thresholds` prints how far inside each threshold lies.

Exit code: 0 if every threshold of the mission lies inside, 1 if one does not (says which), 2 for bad input, 3 if something broke,
130 if it was stopped.
"""

TAKEOFF_WEIGHT_EPILOG = """**Examples**

`armland takeoff-weight` computes and flies the largest take-off weights, and draws them.

`armland takeoff-weight --no-flights --json` prints what theory says, alone.

Exit code: 0 when it is done, 2 for bad input, 3 if something broke, 130 if it was stopped.
"""


@options.taken(
    VERIFY_EPILOG,
    samples=options.option(int, "Random initial states of the UAV subsystem.", default=10_000, min=1, max=10_000_000),
    scenario=options.option(str, "Scenario whose experiments are checked on the whole demonstrator.", default="paper"),
    seed=options.SEED,
    out=options.out("verify"),
    **options.SHOWN,
)
def verify(**given: Any) -> None:
    """Run the paper's proof: where V₂ falls as (30) says, and which assumption breaks it on the whole demonstrator."""
    loaded = options.load(given["scenario"], given)
    console = ready(joints_of(loaded))
    from armland.experiments.proof.attribution import save_channels
    from armland.experiments.proof.verification import prove
    from armland.view.figures.proof import draw_proof_figures
    from armland.view.page.analyses import proof_sheet
    from armland.view.page.sheet import write_page
    from armland.view.tables.proof import print_proof

    def work(results: Results) -> Work:
        with reported(console) as tell:
            proof = prove(loaded, given["samples"], results.folder, tell)
        for name, channels in proof.channels.items():
            save_channels(channels, results.folder / f"proof_{name}.csv")
        result = proof.result()
        return Work(
            proof.holds,
            result,
            lambda out: print_proof(result, out),
            lambda folder: draw_proof_figures(folder, proof),
            lambda folder: write_page(folder, proof_sheet(proof, loaded, given["samples"])),
        )

    publish(given, "result.json", ("*.mcap", "proof_*", "report.html"), work)


@options.taken(
    ENVELOPE_EPILOG,
    scenario=options.scenario("landing"),
    flights=options.option(int, "Landings to fly and mark on the map.", default=6, min=0, max=10_000),
    deviation=options.DEVIATION,
    settings=options.SETTINGS,
    out=options.out("envelope"),
    **options.SHOWN,
)
def envelope(**given: Any) -> None:
    """Compute the capture envelope: offset, speed and tilt from which the magnet grips, beside the mission's thresholds."""
    loaded = options.load(given["scenario"], given)
    console = ready(joints_of(loaded))
    from armland.experiments.envelope import study
    from armland.mission.plan import plan
    from armland.view.figures.envelope import draw_envelope
    from armland.view.page.analyses import envelope_sheet
    from armland.view.page.sheet import write_page
    from armland.view.tables.studies import print_envelope

    plan(loaded, "landing")

    def work(_: Results) -> Work:
        with reported(console) as tell:
            found = study.study(loaded, flights=given["flights"], progress=tell)
        return Work(
            found.holds,
            found.result(),
            lambda out: print_envelope(found, out),
            lambda folder: draw_envelope(folder, found),
            lambda folder: write_page(folder, envelope_sheet(found, loaded)),
        )

    publish(given, "envelope.json", ("envelope.*", "report.html"), work)


@options.taken(
    TAKEOFF_WEIGHT_EPILOG,
    scenario=options.scenario("landing"),
    settings=options.SETTINGS,
    out=options.out("takeoff-weight"),
    flights=options.option(bool, "Fly in the plant, or theory alone.", "--flights/--no-flights", default=True),
    **options.SHOWN,
)
def takeoff_weight(**given: Any) -> None:
    """Find the largest take-off weight against the speed that the arm gives: by momentum theory and by flights."""
    loaded = options.load(given["scenario"], given)
    console = ready(joints_of(loaded))
    from armland.experiments.takeoff_weight.study import study
    from armland.view.figures.takeoff_weight import draw_takeoff_weight
    from armland.view.tables.studies import print_takeoff_weight

    def work(_: Results) -> Work:
        with reported(console) as tell:
            found = study(loaded, given["flights"], tell)
        return Work(
            True,
            found.result(),
            lambda out: print_takeoff_weight(found, out),
            lambda folder: draw_takeoff_weight(folder, found, loaded),
        )

    publish(given, "takeoff_weight.json", ("takeoff_weight.*",), work)
