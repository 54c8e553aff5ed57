"""The page `docs/faults_deviations.md`: what is named where a device differs too much, and whether the rule that named it helped.

`PYTHONPATH=tools python -m pages.deviations RECORDS` writes it. What is not in the file RECORDS yet is flown first, for half an hour,
and added to it line by line, so that it can be stopped and goes on.
"""

import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

from armland.errors import ConfigurationError
from armland.experiments.episode import fly_prepared, prepare
from armland.experiments.margins.corners import COMPANIONS, at, largest, nested
from armland.mission.supervisor.table import FAULTS
from armland.scenario import load_scenario
from armland.scenario.deviation import rows
from pages.keeping import completed
from pages.truth import NONE, TRUE_OF_FAILURE, confusion, true_of_row

MISSIONS, SEEDS, FACTORS = ("landing", "takeoff"), (9001, 9002), (1.0, 2.0, 4.0, 8.0)

GUSTS = (1.0, 2.0, 3.5, 5.0)
"""Speed, m/s, of a gust of one second."""

PUSHES = (0.15, 0.3, 0.6, 0.9)
"""Side force, N, on the UAV for one second."""

BLOWN = {
    "landing": ("guide", "approach", "align", "capture", "hand_over", "carry", "set_down", "unload"),
    "takeoff": ("spin_up", "lift", "carry_up", "hand_back", "release", "clear"),
}
"""Phases at whose begin a healthy UAV is blown and pushed."""

PAGE = Path(__file__).parents[2] / "docs" / "faults_deviations.md"

Record = dict[str, Any]
"""One flight: the fields of `Case` but for `changes`, `success`, `state`, `reason`, `names`; `blind` where a rule ended it."""

_HEAD = """\
# Deviations that are too large

Made by `PYTHONPATH=tools python -m pages.deviations`.

Each deviation of [margins.md](margins.md) alone, at its ends, at 1, 2, 4 and 8 times its published range, at most up to its bound;
and a healthy UAV that a gust of one second blows at or that is pushed for one second, at the begin of each phase. A name is **true**
if it says what differs or what that does, by the table in `tools/pages/truth.py`. A flight that a rule ended is flown again
**without that rule**: a rule is **in the way** where the flight then reaches its goal within all limits.
"""


class Case(NamedTuple):
    """What differs in one flight."""

    mission: str
    what: str
    """`device.key`, or `gust.phase`, or `push.phase`."""
    size: float
    """Factor of the published range; m/s; N."""
    seed: int
    changes: dict[str, Any]


def cases() -> Iterator[Case]:
    """All flights of the page."""
    known = {r.path: r for r in rows()}
    for mission in MISSIONS:
        for seed in SEEDS:
            for row in known.values():
                for factor in sorted({min(k, largest(row)) for k in FACTORS}):
                    company = COMPANIONS.get(row.path)
                    besides = [at(known[company], 1.0, seed)] if company else []
                    yield Case(mission, row.path, factor, seed, nested([*besides, at(row, factor, seed)]))
            for phase in BLOWN[mission]:
                for kind, sizes in (("gust", GUSTS), ("push", PUSHES)):
                    yield from (
                        Case(mission, f"{kind}.{phase}", x, seed, {"faults": [_blow(kind, phase, x)]}) for x in sizes
                    )


def _blow(kind: str, phase: str, size: float) -> dict[str, Any]:
    fault = {"kind": kind, "phase": phase, "size": size, "lasts_s": 1.0, "direction": [1.0, 0.0, 0.0]}
    return fault | ({"body": "uav", "direction": [0.0, 1.0, 0.0]} if kind == "push" else {})


def true_of(what: str) -> set[str]:
    """Names that are true of what differs, `NONE` besides."""
    kind = what.partition(".")[0]
    return {NONE} | TRUE_OF_FAILURE[kind] if kind in ("gust", "push") else true_of_row(what)


def record(case: Case) -> Record:
    """A case, flown; a second time without the rules that ended it."""
    out = {"mission": case.mission, "what": case.what, "size": round(case.size, 6), "seed": case.seed, **_fly(case)}
    if not out["success"] and out["names"]:
        out["blind"] = _fly(case, out["names"])
    return out


def _fly(case: Case, without: Iterable[str] = ()) -> Record:
    try:
        scenario = load_scenario("landing", {**case.changes, "run": {"seed": case.seed}})
        flight = prepare(scenario, case.mission)
    except ConfigurationError as e:
        return {"success": False, "state": "not flown", "reason": str(e), "names": []}
    for name in without:
        flight.controller.board["table"]["faults"][:, FAULTS.index(name)] = -1
    episode = fly_prepared(flight)
    found = dict.fromkeys(episode.ticks["mission"]["fault"].tolist())
    keep = {k: episode.result[k] for k in ("success", "state", "reason")}
    return keep | {"names": [FAULTS[int(k)] for k in found if k]}


def key(r: Record) -> tuple[str, str, float, int]:
    """What tells records apart."""
    return r["mission"], r["what"], r["size"], r["seed"]


def flown(there: set[tuple[str, str, float, int]], jobs: int = 2) -> Iterator[Record]:
    """Records of all cases but those that are there."""
    todo = [c for c in cases() if (c.mission, c.what, round(c.size, 6), c.seed) not in there]
    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(record, todo)


def named(r: Record) -> list[str]:
    """Names that a flight found; `NONE` where it found none."""
    return r["names"] or [NONE]


def markdown(records: Iterable[Record]) -> str:
    """The page."""
    there = list(records)
    ended = [r for r in there if not r["success"]]
    # What the first rule found is what is told; what comes after the end may follow from the end.
    false = [r for r in ended if named(r)[0] not in true_of(r["what"])]
    worse = [r for r in ended if "blind" in r and r["blind"]["success"]]
    lost = [r for r in ended if r["state"] == "lost"]
    saved = [r for r in ended if r["state"] != "lost" and "blind" in r and r["blind"]["state"] == "lost"]
    return "\n".join(
        [
            _HEAD,
            f"Seeds {SEEDS[0]} and {SEEDS[-1]}: {len(there)} flights, {len(there) - len(ended)} reach their goal. Of the {len(ended)} "
            f"that do not, **{len(ended) - len(false)} say truly why**, {len(lost)} lose the UAV. Without the rule that ended it, "
            f"{len(saved)} more would lose it, and {len(worse)} would reach the goal.",
            "",
            "## What ended a flight, by what differed",
            "",
            "The first name that was found; none: the procedure itself gave up, or a figure was out of its bound.",
            "",
            confusion((_words(r["what"]), named(r)[0]) for r in ended),
            "",
            "## Not true",
            "",
            *_lines(false, lambda r: f"{named(r)[0]}"),
            "",
            "## Lost",
            "",
            *_lines(lost, lambda r: f"{named(r)[0]}; {r['reason'].partition(';')[0]}"),
            "",
            "## A rule in the way",
            "",
            *_lines(worse, lambda r: f"{named(r)[0]}"),
            "",
        ]
    )


def _words(what: str) -> str:
    kind, _, phase = what.partition(".")
    return f"{kind} in {phase}" if kind in ("gust", "push") else f"deviation.{what}"


def _lines(records: list[Record], words: Any) -> list[str]:
    return [f"- {r['mission']} {r['what']} at {r['size']:g}, seed {r['seed']}: {words(r)}." for r in records] or [
        "None."
    ]


def main() -> None:
    """Fly what is missing and write the page."""
    path = Path(sys.argv[1] if len(sys.argv) > 1 else "faults_deviations.jsonl")
    there = completed(path, lambda there: flown({key(r) for r in there}))
    PAGE.write_text(markdown(there), encoding="utf-8")


if __name__ == "__main__":
    main()
