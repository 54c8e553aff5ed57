"""An arm's file on the terminal: each value with its source, what the arm can do, and what is suspicious."""

from typing import Any

import numpy as np
from rich.text import Text

from armland.models.arm_file.reading import ArmFile
from armland.models.arm_file.survey import Survey
from armland.models.arm_file.table import FIELDS, Row, unit
from armland.models.arm_file.tree import Value
from armland.view.tables.verdicts import print_lines, terminal, titled

LEGEND = (
    "f: file, a: actuator, c: default class of the file, n: the file names none, r: rule, o: option; slides in m and N; "
    "weight: worst torque of links and tool, N·m"
)


def arm_data(file: ArmFile, found: Survey, notes: list[str], odd: list[str]) -> dict[str, Any]:
    """The same as plain data; a number that does not exist is None."""
    rows = [
        {"joint": r.name, "kind": r.kind}
        | {f: {**getattr(r, f)._asdict(), "unit": unit(f, r.kind)} for f in FIELDS}
        | {"held_nm": float(h)}
        for r, h in zip(file.rows, found.held, strict=True)
    ]
    worst, best = (None if np.isnan(x) else x for x in found.catching)
    return {
        "ee": file.chain.tip.label,
        "joints": rows,
        "links": [_link(link) for link in file.chain.links],
        "moving_mass_kg": found.mass,
        "reach_m": found.reach,
        "payload_kg": {"anywhere": found.anywhere, "catching_worst": worst, "catching_best": best},
        "pose_rad": found.pose.tolist(),
        "notes": notes,
        "suspicious": odd,
    }


def _link(link: Any) -> dict[str, Any]:
    i = link.inertial
    return {"link": link.name, "mass_kg": 0.0 if i is None else i.mass, "shapes": len(link.shapes)}


def print_arm(file: ArmFile, found: Survey, notes: list[str], odd: list[str]) -> None:
    """Print it."""
    console = terminal()
    limits = titled("Joints: limits", "joint", "range [rad]", "speed [rad/s]", "torque [N·m]", "rate [N·m/s]", "weight")
    inner = titled("Joints: what slows them", "joint", "friction [N·m]", "damping [N·m·s/rad]", "armature [kg·m²]")
    for r, h in zip(file.rows, found.held, strict=True):
        limits.add_row(
            Text(r.name), _range(r), *(_cell(r, f) for f in ("speed", "torque", "torque_rate")), f"{round(h, 6):.3g}"
        )
        inner.add_row(Text(r.name), *(_cell(r, f) for f in ("friction", "damping", "armature")))
    console.print(limits, inner)
    console.print(Text(LEGEND))
    worst, best = found.catching
    heaviest, kg = max(
        ((k.name, k.inertial.mass if k.inertial else 0.0) for k in file.chain.links[1:]), key=lambda k: k[1]
    )
    lines = [
        f"end effector {file.chain.tip.label}, {len(file.rows)} joints, reach {found.reach:.2f} m from the second joint",
        f"moving mass {found.mass:.1f} kg with the tool; heaviest link {heaviest}, {kg:.1f} kg",
        f"payload at the tool's tip by 0.9 of the torque limits: {found.anywhere:.2f} kg in any pose, "
        + (
            "no pose points upwards"
            if np.isnan(worst)
            else f"{worst:.2f} to {best:.2f} kg where it points upwards, as in a catch"
        ),
    ]
    print_lines(console, lines, notes, odd)


LETTERS = {"default class": "c", "default": "n"}


def _cell(row: Row, field: str) -> str:
    value = getattr(row, field)
    return f"{value.number:.4g} {_letter(value)}"


def _range(row: Row) -> str:
    low, high = row.low.number, row.high.number
    return f"±{high:.4g} {_letter(row.high)}" if low == -high else f"{low:.4g} to {high:.4g} {_letter(row.high)}"


def _letter(value: Value) -> str:
    return LETTERS.get(value.source, value.source[0])
