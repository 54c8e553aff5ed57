"""The page `docs/differences.md`: one thing at a time that differs from what the controller believes, a hundred seeds each.

`PYTHONPATH=tools python -m pages.differences RECORDS [COUNT [PATTERN]]` writes it. What is not in the file RECORDS yet is flown
first, half an hour of two cores, and added to it line by line, so that it can be stopped and goes on.
"""

import multiprocessing
import os
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from armland.experiments.episode import attempt
from armland.models.parameters import uav_parameters
from armland.scenario import load_scenario
from pages.keeping import completed

FIRST, COUNT = 97001, 100

Changes = dict[str, Any]
"""What replaces values of the scenario."""

Record = dict[str, Any]
"""One flight: `row`, `seed`, `success`, `state`, `reason`."""

PAGE = Path(__file__).parents[2] / "docs" / "differences.md"

_HEAD = """\
# One thing differs

Made by `PYTHONPATH=tools python -m pages.differences`.

The plant differs in one thing from what the controller believes, all else is as believed (`deviation.level = "nominal"`); the last
rows let everything differ. Seeds %d on, %d each; nothing was tuned on them. The interval is Wilson's at 95 %%.

A heavy or weak UAV is refused in the first half second of the self-test where its rotors, which give up to 5 %% less on top
(`imperfections.thrust_error`), would hover with more than 86 %% of their thrust: what is left could neither lean nor stop a fall.

"""


def _deviation(**devices: Changes) -> Changes:
    return {"deviation": {"level": "nominal", **devices}}


def _weighed(share: float) -> Changes:
    # The UAV is as heavy as ever; whoever weighed it read this share of it.
    mass = uav_parameters(load_scenario("landing")).mass
    return {"belief": {"uav": {"mass_kg": round(share * mass, 4)}}}


def _link(up_ms: float, down_ms: float) -> Changes:
    return {"link": {"uplink_delay_ms": up_ms, "downlink_delay_ms": down_ms}}


_PUSH = {"kind": "push", "phase": "approach", "body": "uav", "size": 0.15, "lasts_s": 1.0, "direction": [0.0, 1.0, 0.0]}


def differences() -> dict[str, Changes]:
    """What is changed in the scenario `landing`, by what differs. Two equal numbers are that deviation in each seed."""
    link = load_scenario("landing").link
    camera = load_scenario("landing").camera
    noisy = [[3.0 * x for x in pair] for pair in (camera.lateral_m, camera.depth_m)]
    late = (100.0 - link.uplink_delay_ms, 50.0 - link.downlink_delay_ms)
    return {
        "nothing": _deviation(),
        "wind of 2 m/s with gusts of 0.5 m/s": _deviation(air={"wind_mps": [2.0, 2.0], "gust_mps": [0.5, 0.5]}),
        "gusts of 0.5 m/s": _deviation(air={"gust_mps": [0.5, 0.5]}),
        "side push of 0.15 N for 1 s in `approach`": {**_deviation(), "faults": [_PUSH]},
        "joint torques by up to ± 0.5 % of their limits": _deviation(arm={"torque": 0.005}),
        "joint torques by + 0.5 % of their limits": _deviation(arm={"torque": [0.005, 0.005]}),
        "thrust - 10 %": _deviation(uav={"thrust": [-0.1, -0.1]}),
        "thrust - 15 %": _deviation(uav={"thrust": [-0.15, -0.15]}),
        "mass + 10 %": _deviation(uav={"mass": [0.1, 0.1]}),
        "mass + 20 %": _deviation(uav={"mass": [0.2, 0.2]}),
        "mass - 20 %": _deviation(uav={"mass": [-0.2, -0.2]}),
        "believed mass - 20 %": {**_deviation(), **_weighed(0.8)},
        "believed mass + 20 %": {**_deviation(), **_weighed(1.2)},
        "camera's noise x 3, told": {**_deviation(), "camera": {"lateral_m": noisy[0], "depth_m": noisy[1]}},
        "camera's noise x 3, not told": _deviation(camera={"noise": [2.0, 2.0]}),
        "link of 100 ms up, 50 ms down, told": {**_deviation(), **_link(100.0, 50.0)},
        "link of 100 ms up, 50 ms down, not told": _deviation(
            link={"up_ms": [late[0], late[0]], "down_ms": [late[1], late[1]]}
        ),
        "battery that sags by 1 % a second": _deviation(uav={"sag_per_s": [0.01, 0.01]}),
        "force sensor that drifts by 0.1 N/s": _deviation(wrench={"drift_nps": [0.1, 0.1]}),
        "cradle 5 mm lower, and 5 mm off in x and y": _deviation(cradle={"place_m": [-0.005, -0.005]}),
        "1 mN·m/rad of a cable across the hinge": _deviation(hinge={"stiffness_nm": [0.001, 0.001]}),
        "1 mN·m of dry friction in the hinge": _deviation(hinge={"friction_nm": [0.001, 0.001]}),
        "attitude wrong by 4°": _deviation(uav={"tilt_deg": [4.0, 4.0]}),
        "everything, `mild`": {"deviation": {"level": "mild"}},
        "everything, `published`": {"deviation": {"level": "published"}},
        "everything, `harsh`": {"deviation": {"level": "harsh"}},
    }


def _task(todo: tuple[str, int]) -> Record:
    row, seed = todo
    result = attempt(load_scenario("landing", differences()[row]), "landing", seed)
    return {"row": row, "seed": seed, **{k: result.get(k) for k in ("success", "state", "reason")}}


def missing(there: Iterable[Record], count: int, pattern: str) -> list[tuple[str, int]]:
    """Rows that `pattern` names, and seeds, of which there is no record yet."""
    known = {(r["row"], r["seed"]) for r in there}
    rows = [row for row in differences() if fnmatch(row, pattern)]
    return [(row, seed) for row in rows for seed in range(FIRST, FIRST + count) if (row, seed) not in known]


def flown(todo: list[tuple[str, int]]) -> Iterator[Record]:
    """Records of rows and seeds, one process a core: threads would share its lock."""
    with multiprocessing.get_context("spawn").Pool(os.cpu_count()) as pool:
        yield from pool.imap_unordered(_task, todo)


def markdown(records: Iterable[Record]) -> str:
    """The page."""
    from scipy.stats import binomtest

    there = list(records)
    lines = ["| what differs | landed | 95 % | lost | why not |", "|---|---|---|---|---|"]
    for row in differences():
        flights = [r for r in there if r["row"] == row]
        if not flights:
            continue
        good = sum(r["success"] for r in flights)
        low, high = binomtest(good, len(flights)).proportion_ci(0.95, method="wilson")
        lost = sum(r["state"] == "lost" for r in flights)
        why = Counter(_short(r["reason"]) for r in flights if not r["success"]).most_common()
        lines.append(
            f"| {row} | {good} of {len(flights)} | {100.0 * low:.1f} to {100.0 * high:.1f} % | {lost} | "
            f"{', '.join(f'{n} x {w}' if n > 1 else w for w, n in why)} |"
        )
    return _HEAD % (FIRST, COUNT) + "\n".join(lines) + "\n"


def _short(reason: str) -> str:
    return reason.partition(";")[0].partition("(")[0].partition(",")[0].strip()


def main() -> None:
    """Fly what is missing and write the page."""
    path = Path(sys.argv[1] if len(sys.argv) > 1 else "differences.jsonl")
    count = int(sys.argv[2]) if len(sys.argv) > 2 else COUNT
    pattern = sys.argv[3] if len(sys.argv) > 3 else "*"
    there = completed(path, lambda there: flown(missing(there, count, pattern)))
    if pattern == "*" and count == COUNT:
        PAGE.write_text(markdown(there), encoding="utf-8")
    else:
        print(markdown(there))


if __name__ == "__main__":
    main()
