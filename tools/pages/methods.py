"""The table and the figure of `docs/methods.md`: methods to land over growing wind and sea.

`PYTHONPATH=tools python -m pages.methods FOLDER...` reads each folder's `compare.json`, as `armland compare` leaves it, draws them in
that order into docs/images and prints the table.
"""

import json
import sys
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armland.view.figures.canvas import PAGE_IN, drawn, sheet
from armland.view.methods.figure import COLOURS

IMAGES = Path(__file__).parents[2] / "docs" / "images"

SHOWN = {"success": "all criteria kept (%)", "stands": "stands in the end (%)"}

Comparison = dict[str, Any]
"""A `compare.json`: `conditions`, and of each of `methods` its `name` and the rates of `SHOWN` with `number`, `of`, `low`, `high`."""


def short(conditions: str) -> str:
    """Wind and sea without the number of flights: "8 m/s, sea state 2"."""
    words = [w for w in conditions.split(", ") if "flights" not in w and "hull" not in w]
    return ", ".join(words).replace("wind ", "").replace(" at 20 ft", "").replace("calm air, on land", "calm, land")


def markdown(found: list[Comparison]) -> str:
    """Per cent that kept all criteria, in brackets its interval of 95 %, then how many stand."""
    names = [m["name"] for m in found[0]["methods"]]
    lines = ["| wind at 20 ft, sea, flights | " + " | ".join(names) + " |", "|---" * (len(names) + 1) + "|"]
    for c in found:
        row = []
        for m in c["methods"]:
            r, s = m["success"], m["stands"]
            row.append(
                f"{100 * r['number'] / r['of']:.0f} [{100 * r['low']:.0f}, {100 * r['high']:.0f}]; {s['number']} stand"
            )
        lines.append(f"| {short(c['conditions'])}, {c['runs']} | " + " | ".join(row) + " |")
    return "\n".join(lines)


def page(found: list[Comparison]) -> Figure:
    """Both rates over the conditions, a line a method."""
    figure = sheet(PAGE_IN, 2.9)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, (key, words) in zip(panels, SHOWN.items(), strict=True):
        _rates(axes, found, key)
        axes.set_title(words)
    panels[0].set_ylabel("flights (%)")
    panels[1].legend(loc="lower left", fontsize=7)
    return figure


def _rates(axes: Axes, found: list[Comparison], key: str) -> None:
    names = [m["name"] for m in found[0]["methods"]]
    for i, name in enumerate(names):
        rates = [next(m for m in c["methods"] if m["name"] == name)[key] for c in found]
        at = [k + 0.06 * (i - 0.5 * (len(names) - 1)) for k in range(len(found))]
        middle = [100.0 * r["number"] / r["of"] for r in rates]
        below = [m - 100.0 * r["low"] for m, r in zip(middle, rates, strict=True)]
        above = [100.0 * r["high"] - m for m, r in zip(middle, rates, strict=True)]
        axes.errorbar(at, middle, [below, above], color=COLOURS[i], marker="o", markersize=4, linewidth=1.2, label=name)
    axes.set_xticks(range(len(found)), [short(c["conditions"]).replace(", ", "\n") for c in found])
    axes.set_ylim(-3.0, 103.0)


def main(folders: list[Path]) -> None:
    """Draw the figure of the folders and print their table."""
    found = [json.loads((folder / "compare.json").read_text("utf-8")) for folder in folders]
    print(markdown(found))
    for path in drawn(IMAGES, {"methods": lambda: page(found)}):
        if path.suffix == ".pdf":
            path.unlink()


if __name__ == "__main__":
    main([Path(a) for a in sys.argv[1:]])
