"""The command `verify`: the paper's proof, run."""

from pathlib import Path
from typing import Annotated, Any

import typer

from armland.cli import options
from armland.cli.console import compile_first, diagnostics, progress_bar, reported
from armland.cli.exits import EXPLAINED, Judged
from armland.cli.results import Results, Work, publish

VERIFY_EPILOG = f"""**Examples**

`armland verify` integrates 10 000 random states and checks E1 to E3 on the demonstrator (about half a minute).

`armland verify --samples 500 --no-figures` takes a few seconds.

{EXPLAINED}
"""


@options.taken(
    samples=(
        Annotated[int, typer.Option(min=1, max=10_000_000, help="Random initial states of the UAV subsystem.")],
        10_000,
    ),
    scenario=(
        Annotated[str, typer.Option(help="Scenario whose experiments are checked on the whole demonstrator.")],
        "paper",
    ),
    seed=(options.Seed, None),
    out=(options.out("verify"), Path("out/verify")),
    **options.SHOWN,
)
def verify(**given: Any) -> None:
    """Run the paper's proof: where V₂ falls as (30) says, and which assumption breaks it on the whole demonstrator."""
    loaded = options.load(given["scenario"], given)
    console = diagnostics()
    compile_first(console)
    from armland.experiments.proof.ledger import save_channels
    from armland.experiments.proof.verification import prove
    from armland.view.figures.proof import draw_proof_figures
    from armland.view.tables.proof import print_proof

    def work(results: Results) -> Work:
        with progress_bar(console) as bar:
            proof = prove(loaded, given["samples"], results.folder, reported(bar))
        for name, channels in proof.channels.items():
            save_channels(channels, results.folder / f"proof_{name}.csv")
        result = proof.result()
        draw = (lambda folder: draw_proof_figures(folder, proof)) if given["figures"] else None
        return Work(proof.holds, result, lambda out: print_proof(result, out), draw)

    raise Judged(publish(given["out"], "result.json", ("*.mcap", "proof_*"), given["as_json"], work))
