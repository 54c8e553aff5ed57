"""What the spread of the paper's experiments, and the laws crossed with boards, look like on the terminal."""

from pathlib import Path

import numpy as np
from rich.table import Table
from rich.text import Text

from armland.experiments.factorial import ARMS, BOARDS, Factorial
from armland.experiments.spread import E1_LARGEST, E2_LARGEST, PAPER, RATIO, Demonstrator, Spread
from armland.view.tables.verdicts import cell, terminal, titled


def print_spread(found: Spread, out: Path) -> None:
    """Print what the paper says beside both demonstrators, how often its claims hold, what each calibrated value does alone."""
    console = terminal()
    for table in spread_tables(found):
        console.print(table)
    console.print(f"The data is in {out / 'spread.json'}", markup=False)


def spread_tables(found: Spread) -> list[Table]:
    """The figures and claims of both demonstrators, and each calibrated value at an end of its range."""
    demonstrators = found.demonstrators
    heads = [head for d in demonstrators for head in (d.name, "median [5 % … 95 %]")]
    table = titled("E1 to E3 over the ranges of what is not published", "", "paper", *heads)
    for figure, said in PAPER.items():
        cells = [c for d in demonstrators for c in (f"{d.central[figure]:.2f}", interval(d, figure))]
        table.add_row(Text(figure), said, *cells)
    table.add_section()
    upright = [c for d in demonstrators for c in ("", f"{len(d.standing)} of {len(d.samples)}")]
    table.add_row("points whose UAV keeps upright", "", *upright)
    for claim in demonstrators[0].holds:
        shares = [c for d in demonstrators for c in ("", f"{100.0 * d.holds[claim]:.0f} %")]
        table.add_row(Text(f"holds: {claim}"), "", *shares)
    biases = list(found.sensitivity[0].biased) if found.sensitivity else []
    alone = titled("One calibrated value at an end of its range", "value", "at", "E1 [°]", "E2 [°]", RATIO, *biases)
    for s in found.sensitivity:
        figures = (f"{s.figures[name]:.2f}" for name in (E1_LARGEST, E2_LARGEST, RATIO))
        at = "" if s.value is None else f"{s.value:g}"
        alone.add_row(Text(s.knob), at, *figures, *(f"{s.biased[bias]:.2f}" for bias in biases))
    return [table, alone]


def interval(d: Demonstrator, figure: str) -> str:
    """Median and the middle 90 % of a figure over the points whose UAV keeps upright; a dash where there is none."""
    values = [sample[figure] for sample in d.standing]
    return "{1:.2f} [{0:.2f} … {2:.2f}]".format(*np.quantile(values, [0.05, 0.5, 0.95])) if values else "-"


def print_factorial(found: Factorial, out: Path) -> None:
    """Print law by board, for each arm."""
    console = terminal()
    for table in factorial_tables(found):
        console.print(table)
    console.print(f"The data is in {out / 'factorial.json'}", markup=False)


def factorial_tables(found: Factorial) -> list[Table]:
    """Attitude and position error of law by board, for each arm."""
    tables = []
    for title, of, scale in (
        ("Largest attitude error [°]", lambda m: m.attitude_max_deg, 1.0),
        ("Position error, RMS x/y/z [mm]", lambda m: m.position_rms_m, 1e3),
    ):
        table, law = titled(title, "law", "on board", *ARMS, left=(0, 1)), ""
        cells = {(c.law, c.board, c.arm): c.metrics for c in found.cells}
        for name in dict.fromkeys(c.law for c in found.cells):
            for board in BOARDS:
                shown = (cell(of(cells[name, board, arm]), scale, "{:.2f}") for arm in ARMS)
                table.add_row(Text("" if name == law else name), board, *shown)
                law = name
            table.add_section()
        tables.append(table)
    return tables
