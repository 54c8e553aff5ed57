"""What was made of an arm's file, in lines for its user: what was chosen, locked, left behind, and set by rule."""

from armland.models.arm_file.reading import ArmFile
from armland.models.arm_file.table import Row, unit
from armland.models.arm_file.tree import RULE

REMEDY = {
    "speed": "arm.joint_speed_rad_s sets it",
    "torque": "--torque-limits or arm.torque_limits_nm sets them",
    "armature": "arm.default_armature_kgm2 sets it",
}
"""Values that a rule gives, and what says them better. A torque rate no file gives, so nothing is said of it."""

MANY = 0.5
"""N·m, N·m·s/rad: joint friction and damping from which on they are said."""


def lines(file: ArmFile) -> list[str]:
    """All of it, a line each."""
    out = list(file.chain.notes)
    endless = [r.name for r in file.rows if r.low.source == RULE]
    if endless:
        out.append(f"no range in the file, so ± 2π rad (± 1 m) by rule: {', '.join(endless)}")
    for field, remedy in REMEDY.items():
        ruled = [r for r in file.rows if getattr(r, field).source == RULE]
        if ruled:
            out.append(f"no {field} in the file, so by rule: {_values(ruled, field)}; {remedy}")
    for field in ("friction", "damping"):
        felt = [r for r in file.rows if getattr(r, field).number >= MANY]
        if felt:
            out.append(
                f"joint {field} of the file: in the plant, and made up for by the controller to 0.8: {_values(felt, field)}"
            )
    return out


def _values(rows: list[Row], field: str) -> str:
    numbers = {getattr(r, field).number for r in rows}
    if len(numbers) == 1 and len(rows) > 1:
        return f"{numbers.pop():g} {unit(field, rows[0].kind)} each of {', '.join(r.name for r in rows)}"
    return ", ".join(f"{r.name} {getattr(r, field).number:g}" for r in rows) + f" {unit(field, rows[0].kind)}"
