"""The figure of `docs/sea.md` on prediction: how far deck and plate are from where they were said to be, against the horizon.

`PYTHONPATH=tools python -m pages.prediction [FOLDER]` flies `SEEDS` landings in each weather of `WEATHERS`, draws it, into docs/images
where FOLDER is absent, and prints the errors.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numba import njit
from scipy.spatial.transform import Rotation

from armland.cli.options import load
from armland.estimation import deck
from armland.experiments.episode import prepare
from armland.mission.reference import riding
from armland.models.environment import on_land
from armland.records import Record, Records
from armland.rotations import Array, matrix, rotation_error
from armland.runtime import loops
from armland.runtime.recorder import Recorder
from armland.scenario import Scenario
from armland.view.figures.canvas import PAGE_IN, drawn, sheet
from pages import foresight

IMAGES = Path(__file__).parents[2] / "docs" / "images"

WEATHERS: dict[str, dict[str, Any]] = {
    "ss2": {"sea": "ss2", "hull": 4.0},
    "ss3": {"sea": "ss3", "hull": 4.0},
    "tank": {"sea": "tank"},
    "ss3, 8 m/s": {"sea": "ss3", "hull": 4.0, "wind": 8.0},
}
"""As `armland land` is told of them."""

SEEDS = range(160001, 160004)

HORIZONS_S = np.array([0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5])

WAYS = ("hold", "constant velocity", "constant acceleration", "(D.2), (D.3)")

SEEN = ("tilt of the deck (°)", "way of the deck (mm)", "plate (mm)")

FLIES = ("find", "self_test", "guide", "approach", "align", "miss")
"""Phases in which the UAV flies guided."""

KEPT = np.dtype([("deck", deck.kept_layout()), ("prediction", foresight.kept_layout()), ("ride", riding.kept_layout())])
"""What is remembered from tick to tick."""

BEGINS_S, EVERY = 3.0, 20
"""From when on, and every how many ticks, it is asked."""


def flown(scenario: Scenario, seed: int) -> tuple[Records, tuple[str, ...], Records]:
    """Ticks of a landing, names of its phases, and what the controller was told."""
    f = prepare(scenario.with_seed(seed), "landing", seed)
    with Recorder(None, f.plan.joints, f.period_ns, f.metadata) as recorder:
        loops.fly(f.simulator, f.controller, f.plan, recorder)
    return recorder.ticks, f.plan.names, f.controller.board["told"]


@njit
def said(ticks: Records, told: Record, kept: Record, e: Record, ask: Array, horizons: Array) -> Array:
    """What is said at each tick of `ask` (k,): (k, horizons, ways, 9) of tilt and way, in the axes of then, and plate.

    Args:
        ticks: of a flight.
        told: of the controller's board.
        kept: of `KEPT`, zeros.
        e: environment on land.
        ask: rising ticks.
        horizons: s.
    """
    out, ahead = np.zeros((len(ask), len(horizons), 4, 9)), e.copy()
    gravity, next_one, s, uav = e[0].gravity.copy(), 0, kept.prediction, told.act.uav
    for k in range(len(ticks)):
        deck.know_deck(ticks[k].measurement, gravity, 1e-3, told.estimate.deck, kept.deck, e[0])
        foresight.foresee(k, 1e-3, e[0], s)
        riding.ride(told.decide.station.copy(), uav.rides, uav.lags.copy(), 1e-3, e[0], kept.ride)
        if next_one < len(ask) and ask[next_one] == k:
            since = (k - s.tick) * 1e-3
            for j in range(len(horizons)):
                _say(ticks[k].estimate, e[0], horizons[j], out[next_one, j])
                p = ticks[k].estimate
                plate = p.plate.copy(), p.plate_v.copy(), p.plate_a.copy()
                place, _ = foresight.plate_ahead(horizons[j], since, plate, kept.ride.share, e[0], s, ahead[0])
                way = foresight.ahead(horizons[j], since, e[0], s, ahead[0])
                then = matrix(e[0].base_quat.copy()).T @ matrix(ahead[0].base_quat.copy())
                out[next_one, j, 3, :3], out[next_one, j, 3, 3:6] = rotation_error(np.eye(3), then), way
                out[next_one, j, 3, 6:] = place
            next_one += 1
    return out


@njit
def _say(p: Record, e: Record, h: float, out: Array) -> None:
    # By what is held: nothing, the first derivatives, the second; of the deck's way the velocity counts as the first.
    w, alpha, v = e.base_omega.copy(), e.base_alpha.copy(), e.base_v.copy()
    a = e.base_a.copy()
    out[1, :3], out[2, :3] = w * h, (w + 0.5 * alpha * h) * h
    out[1, 3:6], out[2, 3:6] = v * h, (v + 0.5 * a * h) * h
    out[0, 6:], out[1, 6:] = p.plate, p.plate + p.plate_v * h
    out[2, 6:] = p.plate + (p.plate_v + 0.5 * p.plate_a * h) * h


def errors(ticks: Records, names: tuple[str, ...], told: Records, horizons: Array = HORIZONS_S) -> Array:
    """Errors (k, 3 of `SEEN`, horizons, ways, 3), rad, m, of what is said in a flight; the plate's only where it flies, else NaN."""
    rate = 1000
    late = round(horizons[-1] * rate)
    ask = np.arange(round(BEGINS_S * rate), len(ticks) - late, EVERY)
    found = said(ticks, told[0], np.zeros(1, KEPT)[0], on_land(), ask, horizons)
    truth, out = ticks["truth"], np.full((len(ask), 3, len(horizons), 4, 3), np.nan)
    turn, at = Rotation.from_quat(truth["deck_quat"], scalar_first=True), ask
    seen = turn.inv().apply(truth["r"] - truth["deck"])
    flies = np.isin([names[i] for i in ticks["mission"]["phase"]], FLIES) & (ticks["estimate"]["plate_valid"] > 0)
    for j, h in enumerate(horizons):
        then = at + round(h * rate)
        moved = (turn[at].inv() * turn[then]).as_rotvec(), turn[at].inv().apply(truth["deck"][then] - truth["deck"][at])
        for i, real in enumerate((*moved, seen[then])):
            out[:, i, j] = found[:, j, :, 3 * i : 3 * i + 3] - real[:, None, :]
        out[~(flies[at] & flies[then]), 2, j] = np.nan
    out[:, 0, ..., 2] = 0.0
    return out


def measured(scenario: Scenario, seeds: range = SEEDS) -> Array:
    """Root mean squares (3 of `SEEN`, horizons, ways), deg, mm, mm, over landings of the scenario."""
    rows = np.concatenate([errors(*flown(scenario, seed)) for seed in seeds])
    size = np.sqrt(np.nanmean(np.sum(rows**2, axis=-1), axis=0))
    return size * np.array([np.rad2deg(1.0), 1e3, 1e3])[:, None, None]


def page(found: dict[str, Array]) -> Figure:
    """What is missed against the horizon: a row for each of `SEEN`, a column for each weather."""
    figure = sheet(PAGE_IN, 5.2)
    grid = figure.subplots(len(SEEN), len(found), sharex=True, sharey="row")
    for column, (name, size) in zip(grid.T, found.items(), strict=True):
        for i, axes in enumerate(column):
            _curves(axes, size[i])
        column[0].set_title(name)
        column[-1].set_xlabel("horizon (s)")
    for axes, what in zip(grid[:, 0], SEEN, strict=True):
        axes.set_ylabel(what)
    for row, found_row in zip(grid, zip(*found.values(), strict=True), strict=True):
        row[0].set_ylim(0.0, 1.1 * max(size[:, [0, 3]].max() for size in found_row))
    grid[0, 0].legend(loc="upper left", fontsize="x-small")
    return figure


def _curves(axes: Axes, size: Array) -> None:
    for way, colour in enumerate(("#999999", "#56B4E9", "#E69F00", "#D55E00")):
        axes.plot(HORIZONS_S, size[:, way], color=colour, linewidth=1.6 if way == 3 else 1.0, label=WAYS[way])


def main(out: Path) -> None:
    """Draw the figure into `out` and print what is missed at some horizons, deg and mm."""
    found = {
        name: measured(load("landing", {"deviation": "published", **weather})) for name, weather in WEATHERS.items()
    }
    for name, size in found.items():
        for i, what in enumerate(SEEN):
            for way, label in enumerate(WAYS):
                print(f"{name:12} {what:22} {label:22}", *(f"{x:8.2f}" for x in size[i, [0, 2, 4, 6, 8, 10], way]))
    for path in drawn(out, {"sea_prediction": lambda: page(found)}):
        if path.suffix == ".pdf":
            path.unlink()


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else IMAGES)
