"""The map of `docs/sea.md`: in which wind and sea a landing succeeds, with what UAV and arm can do by themselves drawn beside it.

`PYTHONPATH=tools python -m pages.weather STORE [FOLDER]` draws it from the store of `examples/weather_map.toml`, into docs/images where
FOLDER is absent, and prints its table.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import binomtest

from armland.experiments.campaign.answers.table import tabulate
from armland.experiments.campaign.store import Store
from armland.experiments.episode import prepare
from armland.mission.feasibility.pace import downwards
from armland.plant.sea.timed import deck_motion
from armland.plant.wind.limits import holds_height_in
from armland.rotations import Array
from armland.scenario import load_scenario
from armland.view.figures.canvas import PAGE_IN, drawn, sheet

IMAGES = Path(__file__).parents[2] / "docs" / "images"

WIND, SEA = "air.wind_mps", "sea.state"

HULL_M, SEAS, SAMPLED_HZ, SAMPLED = 4.0, 16, 10.0, 3000

Cells = dict[tuple[str, float], tuple[int, int]]
"""(Sea state, wind at 20 ft) -> landings and flights."""


def cells(store: Path) -> Cells:
    """What a store has flown."""
    with Store(store) as kept:
        table = tabulate(kept)
    out: Cells = {}
    for state, wind, success in zip(table.values[SEA], table.values[WIND], table.success, strict=True):
        good, flights = out.get((state, wind), (0, 0))
        out[state, wind] = good + int(success), flights + 1
    return out


def axes_of(found: Cells) -> tuple[list[str], list[float]]:
    """Sea states and winds of the map, in rising order."""
    return sorted({s for s, _ in found}, key=lambda s: (s != "calm", s)), sorted({w for _, w in found})


def markdown(found: Cells) -> str:
    """The table: landings of flights, and Wilson's interval of 95 %."""
    states, winds = axes_of(found)
    lines = ["| wind at 20 ft | " + " | ".join(states) + " |", "|---" * (len(states) + 1) + "|"]
    for wind in winds:
        row = []
        for state in states:
            good, flights = found[state, wind]
            low, high = (100.0 * x for x in binomtest(good, flights).proportion_ci(0.95, method="wilson"))
            row.append(f"{good} of {flights} ({low:.0f} to {high:.0f} %)")
        lines.append(f"| {wind:g} m/s | " + " | ".join(row) + " |")
    return "\n".join(lines)


def winds_held() -> Iterator[tuple[float, float]]:
    """Standard deviations of a gust, and the wind at 20 ft, m/s, up to which the UAV holds its height in it."""
    scenario = load_scenario("landing", {"forecast": {"wind_mps": 8.0}})
    flight = prepare(scenario, "landing", 1)
    for gust in (1.0, 2.0, 3.0):
        yield gust, holds_height_in(flight.scenario, flight.simulator.scene.uav_mass, gust)


def deck_speed(state: str) -> float:
    """Significant amplitude of the catch's vertical speed, m/s, that the deck makes; mean of `SEAS` seas."""
    if state == "calm":
        return 0.0
    found = []
    for seed in range(SEAS):
        s = load_scenario("landing", {"sea": {"state": state, "hull_m": HULL_M}}).with_seed(seed)
        q = deck_motion(s).sampled(SAMPLED_HZ, 0, SAMPLED)
        x, y, _ = s.place.catch_m
        height = q[:, 2] - x * q[:, 4] + y * q[:, 3]
        found.append(2.0 * float(np.std(np.gradient(height, 1.0 / SAMPLED_HZ))))
    return float(np.mean(found))


def arm_speed() -> float:
    """Speed, m/s, at which the LWR can draw away downwards from where it waits at sea."""
    asked = {"forecast": {"wind_mps": 8.0}, "sea": {"state": "ss3", "hull_m": HULL_M}, "air": {"wind_mps": 8.0}}
    plan = prepare(load_scenario("landing", asked), "landing", 1).plan
    return downwards(plan.arm, plan.home, plan.scenario.limits.joint_speed_share * plan.arm.qd_max)


def page(found: Cells) -> Figure:
    """The map, winds to scale."""
    states, winds = axes_of(found)
    rate = np.array([[100.0 * found[s, w][0] / found[s, w][1] for w in winds] for s in states])
    figure = sheet(PAGE_IN, 3.4)
    axes = figure.subplots()
    axes.grid(visible=False)
    image = axes.pcolormesh(_edges(winds), np.arange(len(states) + 1) - 0.5, rate, cmap="cividis", vmin=0.0, vmax=100.0)
    for i, state in enumerate(states):
        for wind in winds:
            good, flights = found[state, wind]
            colour = "k" if good > 0.6 * flights else "w"
            axes.text(wind, i, f"{good}/{flights}", ha="center", va="center", fontsize=7, color=colour)
    for gust, wind in winds_held():
        axes.axvline(wind, color="#D55E00", linewidth=1.4, linestyle=(0, (4.0, 2.0)))
        axes.text(wind, len(states) - 0.45, f"{gust:.0f}σ", ha="center", va="bottom", fontsize=8, color="#D55E00")
    level = float(np.interp(arm_speed(), [deck_speed(s) for s in states], range(len(states))))
    axes.axhline(level, color="#CC79A7", linewidth=1.4, linestyle=(0, (1.0, 1.5)))
    axes.set(xlabel="mean wind at 20 ft (m/s)", ylabel="sea state, hull of 4 m")
    axes.set_xticks(winds, [f"{w:g}" for w in winds])
    axes.set_yticks(range(len(states)), states)
    figure.colorbar(image, ax=axes, label="landings (%)")
    return figure


def _edges(values: list[float]) -> Array:
    # Between neighbours half-way, and as far beyond the ends.
    at = np.array(values)
    middle = 0.5 * (at[1:] + at[:-1])
    return np.concatenate([[2.0 * at[0] - middle[0]], middle, [2.0 * at[-1] - middle[-1]]])


def main(store: Path, out: Path) -> None:
    """Draw the map of a store into `out` and print its table, and what stands beside it."""
    found = cells(store)
    print(markdown(found))
    print({f"{gust:.0f} sigma": round(wind, 2) for gust, wind in winds_held()})
    print({s: round(deck_speed(s), 2) for s in axes_of(found)[0]}, "arm", round(arm_speed(), 2))
    for path in drawn(out, {"weather_map": lambda: page(found)}):
        if path.suffix == ".pdf":
            path.unlink()


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else IMAGES)
