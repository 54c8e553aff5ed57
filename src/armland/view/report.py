"""What a run of the paper's experiments looks like on the terminal and in its output folder."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from rich.text import Text

from armland.errors import PictureError
from armland.experiments.assembly import Workplace
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
    verdicts = Table(title="What the paper reports", title_justify="left")
    for column, justify in (("claim", "left"), ("found", "right"), ("bound", "right"), ("", "left")):
        verdicts.add_column(column, justify=justify)  # type: ignore[arg-type]
    for v in result["verdicts"]:
        low, high = v["bound"]
        mark = "[green]holds[/]" if v["holds"] else "[red]fails[/]"
        verdicts.add_row(v["claim"], f"{v['value']:.4g}", f"{low:.4g} to {high:.4g}", mark)
    console.print(verdicts)
    run = result["run"]
    console.print(
        f"{run['simulated_s']:.0f} s simulated in {run['wall_s']:.1f} s ({run['real_time_factor']:.0f} x real time). "
        f"Figures, logs (MCAP) and result.json are in {out}/"
    )


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
