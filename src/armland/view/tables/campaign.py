"""What a campaign looks like on the terminal."""

import re
from collections.abc import Sequence
from pathlib import Path

from rich.text import Text

from armland.experiments.campaign.summary import Row, Spread, Summary
from armland.view.tables.verdicts import mark, terminal, titled

_NUMBER = re.compile(r"\d+(\.\d+)?")


def print_campaign(summary: Summary, rows: Sequence[Row], mission: str, out: Path) -> None:
    """Print how many flights succeed, each figure's spread beside its bound, and why flights failed."""
    console = terminal()
    all_good = summary.successes == summary.flights
    low, high = (100.0 * p for p in summary.interval)
    verdict = Text(f"{summary.successes} of {summary.flights}", style="bold green" if all_good else "bold red")
    console.print(verdict.append(f" {mission}s succeed (95 % interval {low:.1f} to {high:.1f} %)", style="default"))
    table = titled("Spread", "", "median", "95 %", "worst", "seed", "bound", "", left=(0, 6))
    for s in summary.spreads:
        table.add_row(*_cells(s))
    console.print(table)
    console.print(f"Missed captures that were tried again: {summary.retries}.")
    violated = ", ".join(f"{name} in {n}" for name, n in summary.violated.items())
    console.print(f"Limits violated: {violated or 'none'}.")
    for reason, seeds in alike(rows).items():
        console.print(f"{len(seeds)} failed (seed {', '.join(map(str, seeds))}): {reason}", markup=False)
    console.print(f"The data is in {out}/", markup=False)


def alike(rows: Sequence[Row]) -> dict[str, list[int]]:
    """Seeds by the reason of their failure; reasons that differ in a number only are one, with the first seed's number."""
    seeds: dict[str, list[int]] = {}
    words: dict[str, str] = {}
    for row in rows:
        if not row["success"]:
            reason = words.setdefault(_NUMBER.sub("", row["reason"]), row["reason"])
            seeds.setdefault(reason, []).append(row["seed"])
    return seeds


def _cells(s: Spread) -> tuple[str | Text, ...]:
    numbers = tuple(f"{x:.3g}" for x in (s.median, s.p95, s.worst))
    bound = ("-", "") if s.bound is None else (f"≤ {s.bound:.4g}", mark(s.holds))
    return (Text(s.name, no_wrap=True), *numbers, str(s.worst_seed), *bound)
