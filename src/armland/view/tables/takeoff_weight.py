"""What the study of the take-off weight looks like on the terminal."""

from pathlib import Path

from armland.experiments.takeoff_weight.study import TakeoffWeight
from armland.view.tables.verdicts import terminal, titled


def print_takeoff_weight(found: TakeoffWeight, out: Path) -> None:
    """Print theory beside flights, the verdict, and where the rest is."""
    console = terminal()
    table = titled("Take-off weight over the static thrust", "speed given", "[m/s]", "theory", "flown")
    for x in found.flights:
        table.add_row(x.name, f"{x.speed_mps:.2f}", f"{x.theory:.4f}", f"{x.flown:.4f} ± {x.half_width:.4f}")
    if found.flights:
        console.print(table)
    console.print(found.verdict, markup=False)
    console.print(f"The data is in {out}/", markup=False)
