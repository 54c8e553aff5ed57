"""What a run of the paper's experiments looks like on the terminal and in its output folder."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from rich.text import Text

from armland.control.gains import Design
from armland.errors import PictureError
from armland.experiments.assembly import Workplace
from armland.experiments.comparison import Comparison
from armland.scenario import Scenario

ROWS = (
    ("attitude max [°]", "attitude_max_deg", 1.0, "{:.1f}"),
    ("attitude rms [°]", "attitude_rms_deg", 1.0, "{:.1f}"),
    ("error rms x/y/z [mm]", "position_rms_m", 1e3, "{:.1f}"),
    ("error max x/y/z [mm]", "position_max_m", 1e3, "{:.1f}"),
    ("overshoot x/y/z [mm]", "overshoot_m", 1e3, "{:.1f}"),
    ("Δτ asked max [N·m]", "delta_tau_max_nm", 1.0, "{:.2f}"),
    ("hinge force max [N]", "hinge_force_max_n", 1.0, "{:.1f}"),
)


def print_paper(result: dict[str, Any], out: Path) -> None:
    """Print tables of the figures and of the verdicts, and where the rest is."""
    console = Console(highlight=False)
    names = list(result["experiments"])
    table = Table(title="E1 to E3 on the simulated demonstrator", title_justify="left")
    table.add_column("")
    for name in names:
        table.add_column(name, justify="right")
    for label, key, scale, form in ROWS:
        table.add_row(Text(label), *(_cell(result["experiments"][n][key], scale, form) for n in names))
        if key == "attitude_max_deg":
            published = (result["published"].get(n, {}).get(key) for n in names)
            table.add_row("  published", *("-" if p is None else form.format(p) for p in published), style="dim")
    console.print(table)
    print_verdicts(result["verdicts"], "What the paper reports", console)
    run = result["run"]
    console.print(
        f"{run['simulated_s']:.0f} s simulated in {run['wall_s']:.1f} s ({run['real_time_factor']:.0f} x real time). "
        f"Figures, logs (MCAP) and result.json are in {out}/"
    )


def print_verdicts(verdicts: list[dict[str, Any]], title: str, console: Console) -> None:
    """Print claims, what was found, the bound, and whether it holds."""
    table = Table(title=title, title_justify="left")
    for column, justify in (("claim", "left"), ("found", "right"), ("bound", "right"), ("", "left")):
        table.add_column(column, justify=justify)  # type: ignore[arg-type]
    for v in verdicts:
        low, high = v["bound"]
        bound = (
            f"at least {low:.4g}"
            if high >= 1e9
            else f"at most {high:.4g}"
            if low == 0.0
            else f"{low:.4g} to {high:.4g}"
        )
        table.add_row(
            Text(v["claim"]), f"{v['value']:.4g}", bound, "[green]holds[/]" if v["holds"] else "[red]fails[/]"
        )
    console.print(table)


def _cell(value: float | list[float], scale: float, form: str) -> str:
    values = value if isinstance(value, list) else [value]
    return "/".join(form.format(scale * v) for v in values)


def illustrate(
    out: Path, scenario: Scenario, workplace: Workplace, records: dict[str, NDArray[np.void]], console: Console
) -> None:
    """Draw the figures and the picture of the scene into `out`; a picture that cannot be made is one line, not an error."""
    from armland.plant.demonstrator import level_hinge
    from armland.plant.scene import build_scene
    from armland.view.figures import draw_paper_figures
    from armland.view.picture import render

    draw_paper_figures(out, records, scenario.run.rate_hz, scenario.run.settle_s)
    scene = build_scene(scenario)
    qpos = np.zeros(scene.model.nq)
    qpos[scene.joint_qpos] = workplace.home
    qpos[scene.hinge_qpos] = level_hinge(workplace.R_d)
    try:
        render(scene.model, qpos, out / "scene.png")
    except PictureError as e:
        console.print(f"No picture of the scene: {e}", highlight=False)


def print_comparison(comparison: Comparison, out: Path) -> None:
    """Print the rows of a comparison of laws by condition, its verdicts, and where the data is."""
    console = Console(highlight=False)
    table = Table(title="Laws compared", title_justify="left")
    for column in (
        "condition",
        "law",
        "attitude max [°]",
        "error rms x/y/z [mm]",
        "error max [mm]",
        "swing at rest [°]",
    ):
        table.add_column(Text(column), justify="left" if column in ("condition", "law") else "right")
    condition = ""
    for row in comparison.rows:
        if row.condition != condition and condition:
            table.add_section()
        m = row.metrics
        table.add_row(
            "" if row.condition == condition else row.condition,
            row.law,
            f"{m.attitude_max_deg:.2f}",
            _cell(m.position_rms_m, 1e3, "{:.2f}"),
            f"{1e3 * max(m.position_max_m):.1f}",
            f"{row.resting_swing_deg:.2f}",
        )
        condition = row.condition
    console.print(table)
    print_verdicts([asdict(v) for v in comparison.verdicts], "What the comparison shows", console)
    console.print(f"The data is in {out / 'comparison.json'}")


def print_design(design: Design, as_json: bool) -> None:
    """Print gains found by rule and the margins they leave."""
    g = design.gains
    if as_json:
        data = {
            "gains": {name: np.asarray(value).tolist() for name, value in g._asdict().items()},
            "onboard": {"kp_nm": design.kp.tolist(), "kd_nms": design.kd.tolist()},
            "margins": {
                "position": {k: _finite(v) for k, v in design.position._asdict().items()},
                **{
                    axis: {k: _finite(v) for k, v in m._asdict().items()}
                    for axis, m in zip(("roll", "pitch", "yaw"), design.attitude, strict=True)
                },
            },
        }
        print(json.dumps(data, indent=2))
        return
    console = Console(highlight=False)
    table = Table(title="Gains by rule", title_justify="left")
    for column in ("gain", "roll/pitch/yaw", "x/y/z"):
        table.add_column(column, justify="left" if column == "gain" else "right")
    for name, values in (("K₁ [1/s]", g.k1), ("K₂ [N·m·s/rad, N·s/m]", g.k2)):
        table.add_row(Text(name), _cell(list(values[:3]), 1.0, "{:.3g}"), _cell(list(values[3:]), 1.0, "{:.3g}"))
    table.add_row(Text("k₃ [N·m/rad, N/m]"), f"{g.k3_attitude:.3g}", f"{g.k3_position:.3g}")
    table.add_row(Text("spring [N·m/rad]"), _cell(list(design.kp), 1.0, "{:.3g}"), "")
    table.add_row(Text("damper [N·m·s/rad]"), _cell(list(design.kd), 1.0, "{:.3g}"), "")
    console.print(table)
    margins = Table(title="Margins", title_justify="left")
    for column in ("loop", "phase [°]", "delay [ms]", "gain down", "gain up", "sensitivity"):
        margins.add_column(Text(column), justify="left" if column == "loop" else "right")
    named = [("position", design.position), *zip(("roll", "pitch", "yaw"), design.attitude, strict=True)]
    for axis, m in named:
        shown = (float(np.rad2deg(m.phase)), 1e3 * m.delay, m.gain_down, m.gain_up, m.sensitivity)
        margins.add_row(axis, *(f"{v:.3g}" for v in shown))
    console.print(margins)


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
