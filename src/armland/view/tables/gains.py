"""Gains found by rule, and the margins they leave, on the terminal."""

from typing import Any

import numpy as np
from rich.text import Text

from armland.control.design.gains import Design
from armland.view.tables.verdicts import cell, terminal, titled

AXES = ("roll", "pitch", "yaw")


def design_data(design: Design) -> dict[str, Any]:
    """Gains and margins as plain data; a margin without end is None."""
    loops = {"position": design.position, **dict(zip(AXES, design.attitude, strict=True))}
    return {
        "gains": {name: np.asarray(value).tolist() for name, value in design.gains._asdict().items()},
        "onboard": {"kp_nm": design.kp.tolist(), "kd_nms": design.kd.tolist()},
        "margins": {
            name: {k: float(v) if np.isfinite(v) else None for k, v in m._asdict().items()} for name, m in loops.items()
        },
    }


def print_design(design: Design) -> None:
    """Print gains and margins."""
    g, console = design.gains, terminal()
    table = titled("Gains by rule", "gain", "roll/pitch/yaw", "x/y/z")
    for name, values in (("K₁ [1/s]", g.k1), ("K₂ [N·m·s/rad, N·s/m]", g.k2)):
        table.add_row(Text(name), *(cell(list(values[part]), 1.0, "{:.3g}") for part in (slice(0, 3), slice(3, 6))))
    table.add_row(Text("k₃ [N·m/rad, N/m]"), f"{g.k3_attitude:.3g}", f"{g.k3_position:.3g}")
    table.add_row(Text("spring [N·m/rad]"), cell(list(design.kp), 1.0, "{:.3g}"), "")
    table.add_row(Text("damper [N·m·s/rad]"), cell(list(design.kd), 1.0, "{:.3g}"), "")
    console.print(table)
    margins = titled("Margins", "loop", "phase [°]", "delay [ms]", "gain down", "gain up", "sensitivity")
    for axis, m in [("position", design.position), *zip(AXES, design.attitude, strict=True)]:
        shown = (float(np.rad2deg(m.phase)), 1e3 * m.delay, m.gain_down, m.gain_up, m.sensitivity)
        margins.add_row(axis, *(f"{v:.3g}" for v in shown))
    console.print(margins)
