"""What of an arm's file is suspicious: no reason to refuse it, and mostly a slip of whoever wrote it."""

import numpy as np

from armland.models.arm_file.chain import Chain, Link
from armland.models.arm_file.reading import ArmFile
from armland.models.arm_file.shapes import length
from armland.models.arm_file.table import moving_mass, unit
from armland.models.arm_file.tree import CLASS, FILE, RULE
from armland.rotations import Array, matrix

HEAVY_KG, HEAVY_PER_M = 100.0, 150.0
"""Mass of a link, and of all links for each metre of arm, above which it is that of a block of steel."""

WIDE_M = 0.25
"""Radius of gyration of a link that has no such size."""

STRONG = 25.0
"""Times the torque that holds the arm's own weight; drives have 2 to 10 times that."""

LITTLE_NM = 3.0
"""Below which the weight says nothing of a joint's drive: wrists turn about their own axis."""

FAST_RAD_S = 7.0
"""Faster than arms' joints turn."""

SMALL_KGM2 = 0.01
"""Reflected inertia below which the gains of a wrist are at their limit at 1 kHz."""


def suspicious(file: ArmFile, held: Array) -> list[str]:
    """Lines on what is suspicious.

    Args:
        file: as it was read.
        held: worst torque (n,), N·m, of the weight of links and tool, `strength.held`.
    """
    chain, rows = file.chain, file.rows
    lines = [line for link in chain.links[1:] for line in _link(link)]
    mass, far = moving_mass(chain), length(chain)
    if mass > HEAVY_PER_M * max(far, 0.1):
        lines.append(
            f"the links weigh {mass:.0f} kg on {far:.2f} m: like solid steel; are their masses in grams, or not scaled?"
        )
    weak = [(r, h) for r, h in zip(rows, held, strict=True) if r.torque.number < h]
    lines += [
        f"joint {r.name!r} gives {r.torque.number:.3g} {unit('torque', r.kind)}, less than the {h:.3g} that the arm's own weight and "
        "the tool ask for stretched out"
        for r, h in weak
    ]
    strong = [
        r.name
        for r, h in zip(rows, held, strict=True)
        if r.torque.source != RULE and h > LITTLE_NM and r.torque.number > STRONG * h
    ]
    if strong:
        lines.append(
            f"torque limits more than {STRONG:g} times what the weight asks for, like a placeholder's: {', '.join(strong)}"
        )
    lines += _placeholders(file)
    turned = upright(chain)
    if turned < 0.99:
        lines.append(f"the base stands {np.rad2deg(np.arccos(np.clip(turned, -1.0, 1.0))):.0f}° from upright")
    return lines


def _placeholders(file: ArmFile) -> list[str]:
    rows, lines = file.rows, []
    same = {r.torque.number for r in rows if r.torque.source == FILE}
    if len(same) == 1 and len(rows) > 3 and all(r.torque.source == FILE for r in rows):
        lines.append(f"all torque limits are {same.pop():g}: joints of a real arm differ, so it may be a placeholder")
    fast = [f"{r.name} {r.speed.number:g}" for r in rows if r.kind == "hinge" and r.speed.number > FAST_RAD_S]
    if fast:
        lines.append(f"speeds above {FAST_RAD_S:g} rad/s: {', '.join(fast)}")
    small = [
        r.name
        for r in rows
        if r.armature.source in (FILE, CLASS) and r.kind == "hinge" and r.armature.number < SMALL_KGM2
    ]
    if small:
        lines.append(f"armature below {SMALL_KGM2:g} kg·m²: {', '.join(small)}; motors behind gears reflect more")
    return lines


def _link(link: Link) -> list[str]:
    i = link.inertial
    if i is None:
        return []
    lines, radius = [], float(np.sqrt(0.5 * i.moments.sum() / i.mass))
    if i.mass > HEAVY_KG:
        lines.append(f"link {link.name!r} weighs {i.mass:.0f} kg")
    if radius > WIDE_M:
        lines.append(
            f"link {link.name!r} turns like a body of {radius:.2f} m radius of gyration: its inertia is that of something larger than "
            f"{i.mass:.3g} kg of arm, or about another point than its centre of mass"
        )
    return lines


def upright(chain: Chain) -> float:
    """How upright the first joint's axis stands with the joints at rest: 1 along the vertical, either way; 0 across."""
    base, first = chain.links[0], chain.links[1]
    axis = matrix(base.pose.quat) @ matrix(first.pose.quat) @ first.joints[0].axis
    return float(abs(axis[2]))
