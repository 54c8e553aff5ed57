"""What a study found, on the terminal and as sentences."""

from pathlib import Path

import numpy as np
from rich.text import Text

from armland.experiments.campaign.answers.paired import Difference
from armland.experiments.study.answer import Findings, Gain
from armland.view.campaign.terminal import percent
from armland.view.tables.verdicts import terminal, titled

COLUMNS = ("", "success", "gives [%]", "with : without", "McNemar")
MANY = 500
"""Flights from which on per cents have a decimal."""


def print_study(found: Findings, conditions: str, out: Path) -> None:
    """Print the gains, the largest first, and what they come to.

    Args:
        found: of the study.
        conditions: under which it was flown, in words.
        out: folder of the data.
    """
    console, u = terminal(), found.usual
    console.print(Text(f"{found.study.title}: {conditions}", style="bold"))
    table = titled("Success, and seeds with which only the one or the other succeeds", *COLUMNS, left=(0,))
    missed = titled("Missed captures of a flight, by what is given", "", "more", "95 %", left=(0,))
    table.add_row(Text(found.study.usual, no_wrap=True), f"{u.successes}/{u.flights}", *[""] * 3)
    for g in found.gains:
        name = Text(g.name, no_wrap=True)
        table.add_row(name, *_cells(g, found.study.removes))
        missed.add_row(name, *_misses(g.misses))
    console.print(table)
    console.print(missed)
    for line in sentences(found):
        console.print(Text(line))
    console.print(Text(f"The data is in {out}/"))


def _cells(g: Gain, removes: bool) -> list[Text]:
    # Of a term that is taken away the scenario as it is has it.
    only = (g.only_usual, g.only_changed) if removes else (g.only_changed, g.only_usual)
    digits = int(g.rate.pairs >= MANY)
    value, low, high = (f"{100.0 * x:+.{digits}f}" for x in (g.rate.value, g.rate.low, g.rate.high))
    counts = f"{g.successes}/{g.flights}", f"{value} ({low} to {high})", f"{only[0]} : {only[1]}"
    return [Text(cell, no_wrap=True) for cell in (*counts, f"{g.chance:.2g}")]


def _misses(d: Difference) -> tuple[str, str]:
    return (f"{d.value:+.2f}", f"{d.low:+.2f} to {d.high:+.2f}") if np.isfinite(d.value) else ("-", "-")


def sentences(found: Findings) -> list[str]:
    """What the gains come to: what helps, what harms, and what could not be told apart."""
    helps, harms = ([g for g in found.gains if g.told and (g.rate.value > 0.0) is up] for up in (True, False))
    alike = [g.name for g in found.gains if not g.told]
    removes = found.study.removes
    lines = []
    if removes:
        lines.append(f"Earn their place: {_listed(helps) or 'none that these flights tell apart from chance'}.")
        lines += [f"Do harm here: {_listed(harms)}."] if harms else []
    else:
        first = _listed(helps[:1]) or "nothing: no exchange is told apart from chance as better"
        lines.append(f"To buy first: {first}{'; then ' + _listed(helps[1:]) if helps[1:] else ''}.")
        lines.append(f"Not to save on: {_listed(harms[::-1]) or 'nothing that these flights tell apart from chance'}.")
    if alike:
        lines.append(f"Not told apart by success: {', '.join(alike)}.")
    fewer = [g for g in found.gains if g.misses.clear and not g.told]
    better, worse = ([g.name for g in fewer if (g.misses.value < 0.0) is less] for less in (True, False))
    if better or worse:
        told = [f"fewer with {', '.join(better)}"] if better else []
        told += [f"more with {', '.join(worse)}"] if worse else []
        lines.append(f"Of these, captures are missed {'; '.join(told)} (95 % intervals, each by itself).")
    for g in found.gains:
        if 2 * g.same >= g.rate.pairs > 0:
            lines.append(f"{g.name}: {g.same} of {g.rate.pairs} flights are the same with and without, bit for bit.")
    if found.least is None:
        lines.append("So few flights tell no difference apart from chance; --runs makes them more.")
    else:
        lines.append(f"With so many seeds McNemar's test sees no difference below {percent(found.least)} %.")
    return lines


def _listed(gains: list[Gain]) -> str:
    return ", ".join(f"{g.name} ({100.0 * g.rate.value:+.0f} %)" for g in gains)
