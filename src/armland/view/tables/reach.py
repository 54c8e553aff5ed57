"""What the reach of an arm looks like on the terminal: a map of the catch, and one of the cradle."""

from pathlib import Path

import numpy as np

from armland.experiments.reach import Reach, Spot
from armland.mission.feasibility.placing import told_places
from armland.view.tables.verdicts import terminal

CELL_M = 0.1
"""Width and height of a cell of the maps."""

GOOD, BEST, NOTHING = "o", "O", "."


def print_reach(found: Reach, out: Path) -> None:
    """Print whether the place that is asked for works, the nearest that does, and where catch and cradle may be."""
    console, asked = terminal(), found.asked.place
    where = f"place.catch_m = {list(asked.catch_m)} with place.put_down_m = {list(asked.put_down_m)}"
    if not found.refusal:
        console.print(f"{where} works", markup=False, soft_wrap=True)
    else:
        console.print(f"{where} does not work: {found.refusal}", markup=False, soft_wrap=True)
    if found.nearest is not None:
        home = f"place.home_deg = {list(found.nearest.place.home_deg or ())}"
        near = told_places(found.nearest, found.asked)
        console.print(f"nearest that works: {near} and {home}", markup=False, soft_wrap=True)
    if found.spots:
        console.print("Catch: height (m) over distance from the first axis (m)", markup=False)
        console.print("\n".join(catch_map(found.spots)), markup=False, highlight=False)
        console.print("Cradle: heading (°) over distance from the first axis (m)", markup=False)
        console.print("\n".join(cradle_map(found.spots)), markup=False, highlight=False)
        console.print(f"{GOOD}: can, {BEST}: best, {NOTHING}: none found", markup=False)
    console.print(f"The data is in {out}/", markup=False)


def catch_map(spots: list[Spot]) -> list[str]:
    """Lines of a map, the highest first: radius to the right."""
    heights = _cells([s.height_m for s in spots])
    rows = {f"{CELL_M * h:5.1f}": [s for s in spots if _cell(s.height_m) == h] for h in reversed(heights)}
    return _map(rows, [s.radius_m for s in spots], "radius_m", _best(spots))


def cradle_map(spots: list[Spot]) -> list[str]:
    """Lines of a map, one for each heading: distance to the right."""
    headings = sorted({s.heading_deg for s in spots})
    rows = {f"{h:5.0f}": [s for s in spots if s.heading_deg == h] for h in headings}
    return _map(rows, [s.distance_m for s in spots], "distance_m", _best(spots))


def _map(rows: dict[str, list[Spot]], along: list[float], name: str, best: Spot) -> list[str]:
    columns, lines = _cells(along), []
    for label, some in rows.items():
        there = {_cell(getattr(s, name)) for s in some}
        at = _cell(getattr(best, name)) if best in some else None
        marks = [BEST if c == at else GOOD if c in there else NOTHING for c in columns]
        lines.append(f"{label} |" + "".join(f"  {m} " for m in marks))
    return [*lines, " " * 7 + "".join(f"{CELL_M * c:4.1f}" for c in columns)]


def _best(spots: list[Spot]) -> Spot:
    return max(spots, key=lambda s: s.merit)


def _cell(value: float) -> int:
    return int(np.floor(value / CELL_M + 0.5))


def _cells(values: list[float]) -> range:
    return range(min(map(_cell, values)), max(map(_cell, values)) + 1)
