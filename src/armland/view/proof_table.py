"""What a run of the proof looks like on the terminal."""

from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from armland.experiments.attribution import TERMS
from armland.experiments.ledger import NOTICEABLE_W

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
    console = Console(highlight=False)
    console.print(_subsystem(result["subsystem"]))
    if result["demonstrator"]:
        console.print(_demonstrator(result["demonstrator"]))
    console.print(_verdicts(result["verdicts"]))
    console.print(
        f"Done in {result['run']['wall_s']:.1f} s. Figures, channels (CSV), logs (MCAP) and result.json are in {out}/"
    )


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
    table = Table(
        title="V₂ on the demonstrator, and the broken assumptions that feed it: RMS power, mW (mean while V₂ rises)",
        title_justify="left",
    )
    table.add_column("")
    for name in books:
        table.add_column(name, justify="right")
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
            cells = (
                f"{1e3 * book['power_rms_w'][name]:.1f} ({1e3 * book['power_rising_w'][name]:+.1f})"
                for book in books.values()
            )
            table.add_row(label, *cells, end_section=name in ("law", list(TERMS)[-1]))
    return table


def _verdicts(verdicts: list[dict[str, Any]]) -> Table:
    table = Table(title="Verdicts", title_justify="left")
    for column, justify in (("claim", "left"), ("found", "right"), ("bound", "right"), ("", "left")):
        table.add_column(column, justify=justify)  # type: ignore[arg-type]
    for v in verdicts:
        low, high = v["bound"]
        mark = "[green]holds[/]" if v["holds"] else "[red]fails[/]"
        table.add_row(v["claim"], f"{v['value']:.4g}", f"{low:.4g} to {high:.4g}", mark)
    return table
