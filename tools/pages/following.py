"""The figure of `docs/envelope.md` on following: which share of a plate's motion the arm misses, against the frequency.

`PYTHONPATH=tools python -m pages.following [FOLDER]` flies it, draws it into FOLDER or docs/images, and prints the shares.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from armland.cli.options import load
from armland.experiments.envelope.interception import FREQUENCIES_HZ, intercept
from armland.rotations import Array
from armland.view.figures.canvas import PAGE_IN, drawn, sheet

IMAGES = Path(__file__).parents[2] / "docs" / "images"

WIND = {"forecast": {"wind_mps": 8.0}}

QUICK = {"control": {"approach": {"track_rad_s": 36.0}}}

CASES: dict[str, tuple[dict[str, Any], str]] = {
    "calm air foretold": ({}, "#999999"),
    "8 m/s foretold": (WIND, "#D55E00"),
    "8 m/s, filter at 36 rad/s": ({**WIND, **QUICK}, "#0072B2"),
}

LEVELS = ("none", "published")

ASKED = 1.0 / 3.0
"""Share that may be missed at 2 Hz."""


def missed(case: str, level: str) -> Array:
    """ε (frequencies,), 1, at `FREQUENCIES_HZ`."""
    said = {"deviation": level} if level != "none" else {}
    scenario = load("landing", said).replaced(CASES[case][0])
    return np.array([t.missed for t in intercept(scenario)])


def page(found: dict[tuple[str, str], Array]) -> Figure:
    """Without deviations on the left, with the published ones on the right."""
    figure = sheet(PAGE_IN, 2.8)
    grid = figure.subplots(1, len(LEVELS), sharey=True)
    for axes, level, title in zip(grid, LEVELS, ("as believed", "published deviations"), strict=True):
        for case, (_, colour) in CASES.items():
            axes.plot(FREQUENCIES_HZ, found[case, level], "o-", color=colour, markersize=3.0, label=case)
        axes.axhline(ASKED, color="k", linewidth=0.8, linestyle=(0, (4.0, 2.0)))
        axes.set(xlabel="frequency (Hz)", title=title, xlim=(0.2, 2.1), ylim=(0.0, 1.0))
    grid[0].set_ylabel("share missed")
    grid[0].legend(loc="upper left", fontsize="x-small")
    return figure


def main(out: Path) -> None:
    """Draw the figure into `out` and print the shares."""
    found = {(case, level): missed(case, level) for level in LEVELS for case in CASES}
    for (case, level), share in found.items():
        print(f"{level:10} {case:26}", *(f"{x:6.3f}" for x in share))
    for path in drawn(out, {"following": lambda: page(found)}):
        if path.suffix == ".pdf":
            path.unlink()


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else IMAGES)
