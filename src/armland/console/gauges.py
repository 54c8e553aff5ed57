"""What a tick says, as a few lines of HTML: phase strip, who carries the weight, a bar for each limit, what the supervisor said."""

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.records import LIMIT_NAMES, Records

GOOD, NEAR, OVER = "#009E73", "#E69F00", "#D55E00"
"""Colours of a bar below 70 %, below all, and beyond its limit."""

NEAR_END_RAD = 0.02
"""Distance to a joint's end at which the supervisor brakes, unless a scenario says otherwise."""

BLOCK = "font-size:12px;line-height:1.45;padding:2px 10px 5px"


class Bar(NamedTuple):
    """One limit: how much of it is used."""

    name: str
    used: float  # share; 1 at the limit
    words: str  # the value and its bound


def bars_of(tick: Records, limits: Mapping[str, Any], link_s: float) -> list[Bar]:
    """The limits of one tick.

    Args:
        tick: a record of `records.tick_layout`; where no arm flies, joints have no bars.
        limits: of `judge.brief.Brief`; one that is not there has no bar.
        link_s: age of the UAV's sample at which it counts as silent, s.
    """
    health, arm = tick["health"], len(tick["truth"]["q"]) > 0
    bars = (
        []
        if not arm
        else [
            Bar("joint torque", float(health["torque_ratio"]), f"{100 * health['torque_ratio']:.0f} % of its limit"),
            Bar("joint speed", float(health["speed_ratio"]), f"{100 * health['speed_ratio']:.0f} % of its limit"),
        ]
    )
    if "sigma_min" in limits:
        bound = float(np.max(limits["sigma_min"]))
        used = bound / max(float(health["sigma_min"]), 1e-9)
        bars.append(Bar("singularity", used, f"{health['sigma_min']:.3f}, at least {bound:.3f}"))
    if "hinge_max" in limits:
        force, bound = float(np.linalg.norm(tick["truth"]["hinge_force"])), float(np.max(limits["hinge_max"]))
        bars.append(Bar("hinge force", force / bound, f"{force:.1f} N, at most {bound:.0f} N"))
    if arm:
        margin = float(health["joint_margin"])
        bars.append(Bar("joint range", NEAR_END_RAD / max(margin, 1e-9), f"{margin:.2f} rad to an end"))
    age = float(health["uav_age"])
    bars.append(Bar("link", age / link_s, f"{1e3 * age:.0f} ms, at most {1e3 * link_s:.0f} ms"))
    return bars


def bars_html(bars: Sequence[Bar]) -> str:
    """The bars, one below the other, each with its name and value in words."""
    rows = []
    for bar in bars:
        used = min(max(bar.used, 0.0), 1.0) if np.isfinite(bar.used) else 0.0
        color = GOOD if bar.used < 0.7 else NEAR if bar.used < 1.0 else OVER
        rows.append(
            f'<div style="display:flex;gap:6px;align-items:center"><span style="width:84px">{escape(bar.name)}</span>'
            f'<span style="flex:1;height:8px;background:#8884;border-radius:4px;overflow:hidden">'
            f'<span style="display:block;height:8px;width:{100 * used:.0f}%;background:{color}"></span></span>'
            f'<span style="width:128px;font-size:11px;white-space:nowrap">{escape(bar.words)}</span></div>'
        )
    return f'<div style="{BLOCK}">{"".join(rows)}</div>'


def shares_html(rotors: float, arm: float, cradle: float, armless: bool = False) -> str:
    """Who carries the weight: vertical forces, N, as one stacked bar; `armless` where rotors and a pad do."""
    parts = [
        ("rotors", max(rotors, 0.0), "#0072B2"),
        *([] if armless else [("arm", max(arm, 0.0), "#D55E00")]),
        ("pad" if armless else "cradle", max(cradle, 0.0), GOOD),
    ]
    total = sum(force for _, force, _ in parts) or 1.0
    blocks = "".join(
        f'<span style="width:{100 * force / total:.1f}%;background:{color};height:12px"></span>'
        for _, force, color in parts
    )
    words = ", ".join(f'<span style="color:{c}">■</span> {name} {force:.1f} N' for name, force, c in parts)
    return f'<div style="{BLOCK}">weight on {words}<div style="display:flex;border-radius:4px;overflow:hidden">{blocks}</div></div>'


def strip_html(names: Sequence[str], flown: Sequence[int], now: int) -> str:
    """The phases that were flown, in their order, and the one in progress."""
    cells = []
    for i, phase in enumerate(flown):
        last = i == len(flown) - 1 and phase == now
        look = "background:#0072B2;color:#fff;font-weight:600" if last else "background:#8883"
        words = escape(name_of(names, phase).replace("_", " "))
        cells.append(f'<span style="padding:1px 6px;border-radius:8px;{look}">{words}</span>')
    style = f"{BLOCK};display:flex;flex-wrap:wrap;gap:3px"
    return f'<div style="{style}" data-phase="{escape(name_of(names, now))}">{"".join(cells)}</div>'


def lines_html(lines: Sequence[str], warning: bool = False) -> str:
    """Lines of text; `warning` where something is wrong."""
    color = f"color:{OVER};font-weight:600" if warning else ""
    return f'<div style="{BLOCK};{color}">{"<br>".join(map(escape, lines))}</div>' if lines else ""


def flags_of(tick: Records) -> list[str]:
    """Names of the limits that were enforced, or left, in a tick."""
    flags = int(tick["health"]["flags"])
    return [name.replace("_", " ") for bit, name in LIMIT_NAMES.items() if flags & bit]


def runs_of(phases: NDArray[np.int64]) -> list[int]:
    """The phases of ticks (k,) in the order flown, each once in a row."""
    if not len(phases):
        return []
    return [int(phases[0]), *(int(p) for p in phases[1:][np.diff(phases) != 0])]


def name_of(names: Sequence[str], number: int) -> str:
    """The name of that number, or the number where it has none."""
    return names[number] if 0 <= number < len(names) else f"number {number}"
