"""Writes the pages of docs/ that are made from tables; `make pages` runs it. The trials of the faults fly for minutes."""

from pathlib import Path

from pages.commands import commands_markdown
from pages.drawings import DRAWINGS
from pages.faults import faults_markdown
from pages.flights import fly_trial
from pages.margins import with_deviations
from pages.messages import records_markdown
from pages.missions import pages
from pages.trials import all_trials

DOCS = Path(__file__).parents[2] / "docs"

made = {
    "records.md": records_markdown(),
    "cli.md": commands_markdown(),
    **{f"missions/{name}": text for name, text in pages()},
}
made |= {f"images/{name}": drawn().svg() for name, drawn in DRAWINGS.items()}
made["margins.md"] = with_deviations((DOCS / "margins.md").read_text("utf-8"))
made["faults.md"] = faults_markdown([fly_trial(t) for t in all_trials()])
for name, text in made.items():
    (DOCS / name).write_text(text, encoding="utf-8")
