"""The command `detector`: the marker's detector on rendered pictures, its fit, and a landing that sees by it."""

import json
import math
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from armland.cli.console import announce_compilation, make_writable, progress_bar

DETECTOR_EPILOG = """**Examples**

`armland detector` prints pose error against distance beside the measurement model's and the published one.

`armland detector --fit` prints the coefficients of the measurement model anew.

`armland detector --fly --seed 3` flies a landing with rendered pictures and the real detector in the loop.

Exit code: 0, or with --fly 1 if the landing fails; 2 for bad input.
"""


def detector(
    per_distance: Annotated[int, typer.Option(min=1, help="Pictures at each distance.")] = 8,
    seed: Annotated[int, typer.Option(min=0, help="Seed of poses and picture noise, or of the landing.")] = 1,
    out: Annotated[Path, typer.Option(help="Folder for figures and table.")] = Path("out/detector"),
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as plain data.")] = False,
    fit: Annotated[
        bool, typer.Option("--fit", help="Fit the measurement model's coefficients (some minutes).")
    ] = False,
    fly: Annotated[bool, typer.Option("--fly", help="Fly a landing that sees by rendered pictures (minutes).")] = False,
) -> None:
    """Detect a fiducial marker on rendered pictures: pose error against distance, beside the camera's measurement model."""
    make_writable(out)
    if fit:
        _fit(seed)
    elif fly:
        _fly(seed, out, as_json)
    else:
        _study(per_distance, seed, out, as_json)


def _study(per_distance: int, seed: int, out: Path, as_json: bool) -> None:
    from armland.experiments.landing_sight import by_distance, landing_sight
    from armland.mission.landing_scenario import landing_scenario
    from armland.view.marker_figures import draw_marker_demo, draw_marker_figure, sight_table, table
    from armland.view.marker_rows import rows
    from armland.view.marker_scene import build_marker_scene
    from armland.view.marker_study import DISTANCES_M, marker_study

    console = Console(stderr=True)
    announce_compilation(console, "mission", "landing.landing_tick")
    with console.status("Rendering and detecting"):
        bands = by_distance(landing_sight(landing_scenario()))
        scene = build_marker_scene()
        study = marker_study(DISTANCES_M, per_distance, seed, scene=scene)
        found = rows(study)
        draw_marker_figure(out, found, study.camera)
        draw_marker_demo(out, scene)
    text = json.dumps({"errors": [_plain(r) for r in found], "sight": [_plain(b) for b in bands]}, indent=2)
    (out / "detector.json").write_text(text + "\n", encoding="utf-8")
    print(text if as_json else f"{sight_table(bands)}\n\n{table(found)}")


def _fit(seed: int) -> None:
    from armland.plant.detector_errors import DETECTOR
    from armland.view.marker_fit import fit_detector

    with Console(stderr=True).status("Rendering and detecting"):
        fitted = fit_detector(seed=seed)
    for name, new, old in zip(fitted._fields, fitted, DETECTOR, strict=True):
        numbers = ", ".join(f"{x:.3g}" for x in new)
        print(f"{name}: {numbers}   (in use: {', '.join(f'{x:.3g}' for x in old)})")


def _fly(seed: int, out: Path, as_json: bool) -> None:
    console = Console(stderr=True)
    announce_compilation(console, "mission", "landing.landing_tick")
    from armland.mission.landing_scenario import landing_scenario
    from armland.view.rendered_landing import draw_flight, fly_rendered, summary

    loaded = landing_scenario()
    loaded = loaded._replace(landing=loaded.landing.model_copy(update={"seed": seed}))
    with progress_bar(console) as bar:
        task = bar.add_task("landing", total=None)
        flight = fly_rendered(loaded, progress=lambda phase, t: bar.update(task, description=f"{t:5.1f} s  {phase}"))
    draw_flight(out, flight)
    result = summary(flight)
    text = json.dumps(_plain(result), indent=2)
    (out / "flight.json").write_text(text + "\n", encoding="utf-8")
    print(text if as_json else "\n".join(f"{k}: {v}" for k, v in result.items()))
    raise typer.Exit(0 if flight.judgement.success else 1)


def _plain(value: Any) -> Any:
    if hasattr(value, "_asdict"):
        value = value._asdict()
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, float) and math.isnan(value):
        return None
    return value
