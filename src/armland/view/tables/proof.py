"""What a run of the proof looks like on the terminal."""

from pathlib import Path
from typing import Any

from rich.table import Table

from armland.experiments.proof.attribution import NOTICEABLE_W, TERMS
from armland.view.tables.verdicts import terminal, titled, verdict_table

ROWS = (
    ("states, with η_e < 0", ("states", "negative_eta_starts"), "{:d}"),
    ("V̇₂ off (30): largest, median", ("rate_gap_largest", "rate_gap_median"), "{:.1e}"),
    ("paths on which V₂ rises", ("paths_rising",), "{:d}"),
    ("states that never arrive", ("not_arrived",), "{:d}"),
    ("V₂ at 1 %: median, largest (s)", ("settled_s.median", "settled_s.largest"), "{:.2f}"),
    ("arrived: median, largest (s)", ("arrived_s.median", "arrived_s.largest"), "{:.2f}"),
    ("η_e changes sign, and V₂ rises", ("sign_changes", "sign_changes_raising_v2"), "{:d}"),
    ("jump of Δτ at η_e = 0 (N·m)", ("jump_torque_nm.median",), "{:.1f}"),
    ("jump of V₂: largest, rises", ("jump_v2_largest", "jump_v2_rising_share"), "{:+.2%}"),
)
"""Label, keys and format of each row on the subsystem."""


def print_proof(result: dict[str, Any], out: Path) -> None:
    """Print tables of the subsystem, of the demonstrator and of the verdicts, and where the rest is."""
    console = terminal()
    for table in proof_tables(result):
        console.print(table)
    words = (
        f"Done in {result['run']['wall_s']:.1f} s. Figures, channels (CSV), logs (MCAP) and result.json are in {out}/"
    )
    console.print(words, markup=False)


def proof_tables(result: dict[str, Any]) -> list[Table]:
    """The subsystem, the demonstrator where there is one, and the verdicts."""
    books = [_demonstrator(result["demonstrator"])] if result["demonstrator"] else []
    return [_subsystem(result["subsystem"]), *books, verdict_table("Verdicts", result["verdicts"])]


def _subsystem(cases: dict[str, Any]) -> Table:
    table = Table(title="The proof on the UAV subsystem", title_justify="left")
    table.add_column("")
    for case in cases.values():
        table.add_column(case["title"], justify="right", max_width=24)
    for label, keys, form in ROWS:
        table.add_row(label, *(" / ".join(_cell(c, key, form) for key in keys) for c in cases.values()))
    return table


def _cell(figures: dict[str, Any], key: str, form: str) -> str:
    value: Any = figures
    for part in key.split("."):
        value = value[part]
    return "-" if value is None else form.format(value)


def _demonstrator(books: dict[str, Any]) -> Table:
    title = "V₂ on the demonstrator, and the broken assumptions that feed it: RMS power, mW (mean while V₂ rises)"
    table = titled(title, "", *books)
    for label, form, key, scale in (
        (f"V₂ rises by over {1e3 * NOTICEABLE_W:g} mW", "{:.0f} %", "rising_share", 100.0),
        ("largest rate of rise (W)", "{:.2f}", "largest_rise_w", 1.0),
        ("largest V₂ (mN·m)", "{:.0f}", "v2_largest_j", 1e3),
    ):
        table.add_row(label, *(form.format(scale * book[key]) for book in books.values()))
    table.add_section()
    labels = {"measured": "rate of V₂", "law": "by (30)", **TERMS, "remainder": "left unexplained"}
    for name, label in labels.items():
        if any(book["power_rms_w"][name] for book in books.values()):
            powers = ((1e3 * book["power_rms_w"][name], 1e3 * book["power_rising_w"][name]) for book in books.values())
            cells = (f"{rms:.1f} ({rising:+.1f})" for rms, rising in powers)
            table.add_row(label, *cells, end_section=name in ("law", list(TERMS)[-1]))
    return table
