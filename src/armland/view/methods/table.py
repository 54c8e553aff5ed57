"""Methods side by side on the terminal."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from rich.text import Text

from armland.experiments.methods.comparison import FIGURES, Flights, Rate, paired, quantiles, rate
from armland.view.tables.verdicts import terminal, titled

MOST_REASONS = 3


def print_methods(methods: Sequence[Flights], conditions: str, out: Path) -> None:
    """Print rates and figures of each method, each against the first by seed, and why flights failed.

    Args:
        methods: the first is what the others are held against.
        conditions: under which they flew, in words.
        out: folder of the data.
    """
    console = terminal()
    table = titled(conditions, "", "all criteria kept (%)", "stands (%)", "lost", left=(0,))
    spread = titled("Touchdown: median / 95 %", "", *FIGURES.values(), left=(0,))
    for m in methods:
        rates = [percent(rate(flags)) for flags in (m.success, m.stands)]
        table.add_row(*(Text(cell, no_wrap=True) for cell in (m.name, *rates, str(rate(m.lost).number))))
        spread.add_row(*(Text(cell, no_wrap=True) for cell in (m.name, *(_quantiles(m, key) for key in FIGURES))))
    console.print(table)
    console.print(spread)
    for m in methods:
        told = ", ".join(f"{FIGURES[key]} ≤ {bound:g}" for key, bound in m.bounds.items() if key in FIGURES)
        console.print(f"Criteria of {m.name}: {told}.", markup=False, highlight=False)
    for other in methods[1:]:
        for what, words in (("success", "keeps all criteria"), ("stands", "stands")):
            console.print(against(methods[0], other, what, words), markup=False, highlight=False)
    for m in methods:
        some = list(m.reasons.items())[:MOST_REASONS]
        if some:
            console.print(f"{m.name} failed: " + "; ".join(f"{n} x {why}" for why, n in some), markup=False)
    console.print(f"The data is in {out}/", markup=False)


def percent(r: Rate) -> str:
    """A rate as its share and interval, in per cent."""
    digits = 0 if r.of < 500 else 1
    middle, low, high = (f"{100.0 * x:.{digits}f}" for x in (r.number / r.of, r.low, r.high))
    return f"{middle} [{low}, {high}]"


def against(first: Flights, other: Flights, what: str, words: str) -> str:
    """A method against the first in one sentence; `what` is the flag, `words` say what it means."""
    p = paired(first, other, what)
    d, chance = p.difference, "p < 0.001" if p.chance < 1e-3 else f"p = {p.chance:.2g}"
    rates = f"{100.0 * d.value:+.1f} % ({100.0 * d.low:.1f} to {100.0 * d.high:.1f})"
    counts = f"{p.only_second} only it, {p.only_first} only {first.name}"
    return f"{other.name} {words} {rates} against {first.name} over {d.pairs} seeds: {counts}, McNemar {chance}"


def _quantiles(m: Flights, key: str) -> str:
    middle, high = quantiles(m.figures[key])
    return f"{middle:.2g} / {high:.2g}" if np.isfinite(middle) else "-"
