"""The table of `docs/uav.md`: UAVs from 0.04 to 25 kg, landed and let take off with nothing set but their file.

`PYTHONPATH=tools python -m pages.uavs RECORDS [SEEDS]` writes it. RECORDS is a file to which each flight is added as a line, so that it
can be stopped and goes on; SEEDS is a number, 50 if absent. What RECORDS has is not flown again.
"""

import multiprocessing
import os
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from armland.cli.options import load
from armland.errors import ConfigurationError, ModelError
from armland.experiments.campaign.engine import campaign
from armland.experiments.campaign.summary import value
from armland.experiments.episode import prepare
from armland.models.parameters import uav_parameters
from armland.scenario import Scenario
from pages.keeping import completed

ROOT = Path(__file__).parents[2]

PAGE = ROOT / "docs" / "uav.md"

HEADING = "## UAVs that were flown"
"""The table follows it and ends the page."""

FIRST, SEEDS, LEVEL = 130001, 50, "published"

Record = dict[str, Any]
"""A flight: `case`, `mission`, `seed`, `success`, `state`, `reason`; `speed`, m/s, `tilt`, °, and `offset`, mm, where it has them."""

_KEPT = {"speed": "touchdown.speed_mps", "tilt": "touchdown.tilt_deg", "offset": "touchdown.offset_m"}


class Case(NamedTuple):
    """What is flown."""

    uav: str
    """Name or file."""
    mission: str = "landing"
    arm: str | None = None
    """File; the scenario's own if absent."""
    wrong: str = ""
    """What is believed wrongly of the UAV: mass, thrust or inertia."""
    share: float = 1.0
    """Believed over true."""

    @property
    def name(self) -> str:
        """As it stands in the table."""
        told = f", {self.wrong} believed {100.0 * (self.share - 1.0):+.0f} %" if self.wrong else ""
        return f"`{self.uav}`{told}"


_DATA = "tests/data/"

_UAVS = (
    "crazyflie",
    "ardrone2",
    "ardrone2_bench",
    "pelican",
    "x500",
    f"{_DATA}uavs/tilted20.toml",
    "neo11",
    "m690",
    f"{_DATA}uavs/octo5_tilted30.toml",
    "hexa10",
)

CASES = (
    *(Case(uav, mission) for uav in _UAVS for mission in ("landing", "takeoff")),
    *(Case("octo25", mission, f"{_DATA}arms/heavy.xml") for mission in ("landing", "takeoff")),
    *(
        Case(uav, "landing", None, wrong, share)
        for uav in ("ardrone2", "x500")
        for wrong in ("mass", "thrust", "inertia")
        for share in (0.8, 1.2)
    ),
)


def scenario_of(case: Case) -> Scenario:
    """The scenario of a case.

    Raises:
        ConfigurationError: it is refused.
    """
    uav = str(ROOT / case.uav) if "/" in case.uav else case.uav
    arm = {"arm": str(ROOT / case.arm)} if case.arm else {}
    scenario = load("landing", {"uav": uav, "deviation": LEVEL, **arm})
    if not case.wrong:
        return scenario
    body = uav_parameters(scenario)
    believed: dict[str, dict[str, dict[str, Any]]] = {
        "mass": {"uav": {"mass_kg": case.share * body.mass}},
        "inertia": {"uav": {"inertia_kgm2": (case.share * body.inertia).tolist()}},
        "thrust": {"rotors": {"max_thrust_n": case.share * scenario.rotors.max_thrust_n}},
    }
    return scenario.replaced({"belief": believed[case.wrong]})


def flights(case: Case, seeds: list[int]) -> list[Record]:
    """Flights of a case; what is refused with one seed is refused with all."""
    told = {"case": case.name, "mission": case.mission}
    try:
        scenario = scenario_of(case)
        prepare(scenario, case.mission, seeds[0])
    except (ConfigurationError, ModelError) as e:
        return [told | {"seed": seeds[0], "success": False, "state": "refused", "reason": str(e)}]
    out = []
    for row in campaign(scenario, case.mission, seeds, jobs=1):
        figures = {short: value(row, long) for short, long in _KEPT.items()}
        out.append(told | {k: row[k] for k in ("seed", "success", "state", "reason")} | figures)
    return out


def _task(todo: tuple[Case, list[int]]) -> list[Record]:
    return flights(*todo)


def missing(there: Iterable[Record], seeds: range) -> list[tuple[Case, list[int]]]:
    """Cases, and the seeds of each, of which there is no record yet, ten seeds at a time."""
    records = list(there)
    known = {(r["case"], r["mission"], r["seed"]) for r in records}
    refused = {(r["case"], r["mission"]) for r in records if r["state"] == "refused"}
    out = []
    for case in CASES:
        left = [s for s in seeds if (case.name, case.mission, s) not in known]
        if (case.name, case.mission) not in refused:
            out += [(case, left[i : i + 10]) for i in range(0, len(left), 10)]
    return out


def flown(there: list[Record], seeds: range) -> Iterator[Record]:
    """Records of what is missing, one process a core."""
    with multiprocessing.get_context("spawn").Pool(os.cpu_count()) as pool:
        for records in pool.imap_unordered(_task, missing(there, seeds)):
            yield from records


def markdown(records: Iterable[Record]) -> str:
    """The table, with what is said above it."""
    there = list(records)
    head = (
        f"Made by `PYTHONPATH=tools python -m pages.uavs`: seeds {FIRST} on at published deviations, nothing was tuned on them, and\n"
        "nothing is set but the UAV, for 25 kg the arm (`tests/data/arms/heavy.xml`), and what is believed of the UAV.\n"
    )
    lines = [
        "| UAV | lands | touchdown at most | tilt | beside the middle | takes off | not |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in dict.fromkeys(c.name for c in CASES):
        down, up = (_of(there, name, mission) for mission in ("landing", "takeoff"))
        if down or up:
            worst = [max((r[k] for r in down if r["success"] and r.get(k) is not None), default=None) for k in _KEPT]
            units = ("{:.3f} m/s", "{:.1f}°", "{:.1f} mm")
            figures = " | ".join("" if w is None else unit.format(w) for w, unit in zip(worst, units, strict=True))
            lines.append(f"| {name} | {_count(down)} | {figures} | {_count(up)} | {_why(down + up)} |")
    return "\n".join([head, *lines, ""])


def _of(records: list[Record], name: str, mission: str) -> list[Record]:
    return [r for r in records if r["case"] == name and r["mission"] == mission]


def _count(rows: list[Record]) -> str:
    if any(r["state"] == "refused" for r in rows):
        return "refused"
    return f"{sum(r['success'] for r in rows)} of {len(rows)}" if rows else ""


def _why(rows: list[Record]) -> str:
    why: Counter[str] = Counter()
    for r in rows:
        if not r["success"]:
            short = " ".join(r["reason"].split(";")[0].split("(")[0].split()).replace("|", "\\|")
            why[f"{r['mission']} {'' if r['state'] == 'refused' else r['seed']} {r['state']}: {short}"] += 1
    return "; ".join(why)


def main() -> None:
    """Fly what is missing and write the table."""
    path = Path(sys.argv[1])
    seeds = range(FIRST, FIRST + int(sys.argv[2] if len(sys.argv) > 2 else SEEDS))
    there = completed(path, lambda there: flown(there, seeds))
    page = PAGE.read_text("utf-8").partition(HEADING)[0]
    PAGE.write_text(f"{page}{HEADING}\n\n{markdown(there)}", encoding="utf-8")


if __name__ == "__main__":
    main()
