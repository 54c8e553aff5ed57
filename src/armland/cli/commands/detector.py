"""The command `detector`: the marker's detector on rendered pictures, its fit, and a landing that sees by it."""

import math
from pathlib import Path
from typing import Any

from armland.cli import options
from armland.cli.console import diagnostics, phases_told, ready
from armland.cli.results import Work, publish

DETECTOR_EPILOG = """**Examples**

`armland detector` prints pose error against distance beside the measurement model's and the published one.

`armland detector --fit` prints the coefficients of the measurement model anew.

`armland detector --fly --seed 3` flies a landing with rendered pictures and the real detector in the loop.

Exit code: 0, or with --fly 1 if the landing fails; 2 for bad input, 3 if something broke, 130 if it was stopped.
"""


@options.taken(
    DETECTOR_EPILOG,
    per_distance=options.option(int, "Pictures at each distance.", default=8, min=1, max=10_000),
    seed=options.option(int, "Seed of poses and picture noise, or of the landing.", default=1, min=0),
    out=options.out("detector"),
    as_json=options.AS_JSON,
    fit=options.option(bool, "Fit the measurement model's coefficients (some minutes).", "--fit", default=False),
    fly=options.option(bool, "Fly a landing that sees by rendered pictures (minutes).", "--fly", default=False),
)
def detector(**given: Any) -> None:
    """Detect a fiducial marker on rendered pictures: pose error against distance, beside the camera's measurement model."""
    ready()
    if given["fit"]:
        _fit(given["seed"])
    elif given["fly"]:
        publish(given, "flight.json", ("fig_marker_sheet.*",), lambda _: _fly(given["seed"]))
    else:
        owned = ("fig_marker_error.*", "fig_marker_demo.*")
        publish(given, "detector.json", owned, lambda _: _study(given["per_distance"], given["seed"]))


def _study(per_distance: int, seed: int) -> Work:
    from armland.experiments.envelope.sight import by_distance, landing_sight
    from armland.scenario import load_scenario
    from armland.view.figures.markers import draw_marker_demo, draw_marker_figure
    from armland.view.tables.markers import errors_table, sight_table
    from armland.vision.scene import build_marker_scene
    from armland.vision.study import DISTANCES_M, marker_study, rows

    with diagnostics().status("Rendering and detecting", spinner="line"):
        bands = by_distance(landing_sight(load_scenario("landing")))
        scene = build_marker_scene()
        study = marker_study(DISTANCES_M, per_distance, seed, scene=scene)
        found = rows(study)

    def draw(folder: Path) -> None:
        draw_marker_figure(folder, found, study.camera)
        draw_marker_demo(folder, scene)

    data = {"errors": [_plain(r) for r in found], "sight": [_plain(b) for b in bands]}
    return Work(True, data, lambda _: print(f"{sight_table(bands)}\n\n{errors_table(found)}"), draw)


def _fit(seed: int) -> None:
    from armland.plant.devices.detector_errors import DETECTOR
    from armland.vision.fit import fit_detector

    with diagnostics().status("Rendering and detecting", spinner="line"):
        fitted = fit_detector(seed=seed)
    for name, new, old in zip(fitted._fields, fitted, DETECTOR, strict=True):
        numbers = ", ".join(f"{x:.3g}" for x in new)
        print(f"{name}: {numbers}   (in use: {', '.join(f'{x:.3g}' for x in old)})")


def _fly(seed: int) -> Work:
    from armland.scenario import load_scenario
    from armland.view.figures.markers import draw_flight
    from armland.vision.flight import fly_rendered, summary

    with phases_told(diagnostics(), "landing") as tell:
        flight = fly_rendered(load_scenario("landing").with_seed(seed), progress=tell)
    result = _plain(summary(flight))
    return Work(
        bool(result["success"]),
        result,
        lambda _: print("\n".join(f"{k}: {v}" for k, v in result.items())),
        lambda folder: draw_flight(folder, flight),
    )


def _plain(value: Any) -> Any:
    if hasattr(value, "_asdict"):
        value = value._asdict()
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, float) and math.isnan(value):
        return None
    return value
