"""What a run of the paper's experiments, and the comparison of laws, look like on the terminal."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.text import Text

from armland.view.tables.flight import GROUPS, LOADS
from armland.view.tables.verdicts import cell, terminal, titled, verdict_table


def print_paper(result: Mapping[str, Any], out: Path) -> None:
    """Print tables of the figures and of the verdicts, and where the rest is."""
    console, names = terminal(), list(result["experiments"])
    table = titled("E1 to E3 on the simulated demonstrator", "", *names)
    for row in (*GROUPS["tracking"], LOADS[0]):
        table.add_row(Text(row.label), *(cell(result["experiments"][n][row.key], row.scale, row.form) for n in names))
        if row.key == "attitude_max_deg":
            published = (result["published"].get(n, {}).get(row.key) for n in names)
            table.add_row("  published", *(cell(p, 1.0, "{:.1f}") for p in published), style="dim")
    console.print(table)
    console.print(verdict_table("What the paper reports", result["verdicts"]))
    run = result.get("run")
    if run:
        console.print(
            f"{run['simulated_s']:.0f} s simulated in {run['wall_s']:.1f} s ({run['real_time_factor']:.0f} x real time)."
        )
    console.print(f"Figures, logs (MCAP) and result.json are in {out}/", markup=False)


def print_comparison(result: Mapping[str, Any], out: Path) -> None:
    """Print the rows of a comparison of laws by condition, its verdicts, and where the data is."""
    console, condition = terminal(), ""
    table = titled(
        "Laws compared",
        "condition",
        "law",
        "attitude max [°]",
        "error rms x/y/z [mm]",
        "error max [mm]",
        "swing at rest [°]",
        left=(0, 1),
    )
    for row in result["rows"]:
        new = row["condition"] != condition
        if new and condition:
            table.add_section()
        condition, m = row["condition"], row["metrics"]
        table.add_row(
            Text(condition if new else ""),
            Text(row["law"]),
            f"{m['attitude_max_deg']:.2f}",
            cell(m["position_rms_m"], 1e3, "{:.2f}"),
            f"{1e3 * max(m['position_max_m']):.1f}",
            f"{row['resting_swing_deg']:.2f}",
        )
    console.print(table)
    if result["verdicts"]:
        console.print(verdict_table("What the comparison shows", result["verdicts"]))
    console.print(f"The data is in {out / 'comparison.json'}", markup=False)
