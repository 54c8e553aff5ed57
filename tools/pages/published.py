"""The page `docs/faults_published.md`: all trials of the faults again, in a plant that differs from what the controller believes.

`PYTHONPATH=tools python -m pages.published RECORDS` writes it. What is not in the file RECORDS yet is flown first, for half an hour,
and added to it line by line, so that it can be stopped and goes on.
"""

import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from pages.flights import Branches, branches, fly_trial, unsafe
from pages.keeping import completed
from pages.trials import Trial, all_trials
from pages.truth import confusion, untrue

LEVEL, SEEDS = "published", (1, 2, 3, 4, 5)

PAGE = Path(__file__).parents[2] / "docs" / "faults_published.md"

Record = dict[str, Any]
"""One trial as flown: `name`, `seed`, `ends`, `found`, `state`, `unsafe` and `reason`; or `name`, `seed` and `missing`."""

_HEAD = """\
# Faults in a plant that differs

Made by `PYTHONPATH=tools python -m pages.published`, which flies every trial of [faults.md](faults.md) again with
`--deviation published`.

A trial is **safe** if nobody falls, nothing jumps, no limit of the arm is exceeded and the arm comes to rest. Its reason is
**true** if each name that the supervisor gave says what failed or what that does, by the table in `tools/pages/truth.py`.
"""


def record(trial: Trial, seed: int, base: Branches) -> Record:
    """A trial, flown on from `base`."""
    phases = {str(f.phase) for f in trial.faults} - {"done"}
    if not phases <= set(base.starts):
        return {"name": trial.name, "seed": seed, "missing": f"it never came to {', '.join(sorted(phases))}"}
    flight = fly_trial(trial, base=base)
    return {
        "name": trial.name,
        "seed": seed,
        "ends": flight.ends,
        "found": flight.found,
        "state": flight.judgement.state,
        "unsafe": unsafe(flight, base),
        "reason": flight.judgement.reason,
    }


def flown(missing_from: set[tuple[str, int]]) -> Iterator[Record]:
    """Records of all trials and seeds but those that are there."""
    for mission in ("landing", "takeoff"):
        for seed in SEEDS:
            trials = [t for t in all_trials() if t.mission == mission and (t.name, seed) not in missing_from]
            if trials:
                base = branches.__wrapped__(mission, seed, LEVEL)
                yield from (record(t, seed, base) for t in trials)


def is_true(r: Record) -> bool:
    """Whether all names of a record are true of what failed; nothing named is true where the trial copes without."""
    trial = next(t for t in all_trials() if t.name == r["name"])
    copes = trial.found == "none" or (bool(r["ends"]) and r["ends"][-1] == "done")
    return not untrue(r["found"], trial.faults, copes)


def markdown(records: Iterable[Record]) -> str:
    """The page."""
    known = {t.name: t for t in all_trials()}
    there = [r for r in records if r["name"] in known]
    done = [r for r in there if "missing" not in r]
    bad, false = [r for r in done if r["unsafe"]], [r for r in done if not is_true(r)]
    pairs = [(f.kind, name) for r in done for f in known[r["name"]].faults[:1] for name in r["found"]]
    parts = [
        _HEAD,
        f"Seeds {SEEDS[0]} to {SEEDS[-1]}: {len(done)} trials, **{len(done) - len(bad)} safe "
        f"({100.0 * (1.0 - len(bad) / max(len(done), 1)):.1f} %), reasons true in {len(done) - len(false)} "
        f"({100.0 * (1.0 - len(false) / max(len(done), 1)):.1f} %)**; "
        f"{len(there) - len(done)} could not be provoked, because the flight never came to their phase.",
        "",
        "## Not safe",
        "",
        *_lines(bad, lambda r: "; ".join(r["unsafe"])),
        "",
        "## Not true",
        "",
        *_lines(false, lambda r: f"found {', '.join(r['found'])}, ended in {', '.join(r['ends']) or 'none'}"),
        "",
        "## What failed first, and what was found",
        "",
        confusion(pairs),
        "",
    ]
    return "\n".join(parts)


def _lines(records: list[Record], words: Any) -> list[str]:
    return [f"- {r['name']}, seed {r['seed']}: {words(r)}." for r in records] or ["None."]


def main() -> None:
    """Fly what is missing and write the page."""
    path = Path(sys.argv[1] if len(sys.argv) > 1 else "faults_published.jsonl")
    there = completed(path, lambda there: flown({(r["name"], r["seed"]) for r in there}))
    PAGE.write_text(markdown(there), encoding="utf-8")


if __name__ == "__main__":
    main()
