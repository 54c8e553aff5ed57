"""Tunes a method to land on training seeds: `PYTHONPATH=src:tools python -m tuning METHOD [CANDIDATES]`; prints the best settings.

Each method is given the same number of candidates, seeds and conditions: calm, 6 m/s on ss1, 8 m/s on ss2 and on ss3.
"""

import sys
import time

from armland.experiments.methods.table import METHODS
from armland.scenario import load_scenario
from armland.scenario.tables import update
from tuning.search import draw, flown, near, tune

CONDITIONS = ((0.0, "calm"), (6.0, "ss1"), (8.0, "ss2"), (8.0, "ss3"))
SEEDS = tuple(range(5001, 5006))
BOUNDS = {"touchdown.speed_mps": 0.25, "touchdown.tilt_deg": 5.0}

STATION = {
    "control.station.k_position": (0.6, 2.5),
    "control.station.k_velocity": (2.0, 5.0),
    "control.station.gust_share": (0.0, 1.0),
}
DESCENT = {
    "descent.sink_mps": (0.05, 0.3),
    "descent.ready_m": (0.08, 0.4),
    "descent.level_m": (0.0, 0.4),
    "descent.cut_m": (0.0, 0.05),
    "descent.quiet": (0.3, 2.0),
    "descent.align_m": (0.04, 0.2),
    "descent.patience_s": (3.0, 20.0),
}
SPACES = {
    "arm": {
        **STATION,
        "control.approach.beyond_m": (0.002, 0.02),
        "bounds.align_speed_mps": (0.03, 0.12),
        "place.standoff_m": (0.02, 0.06),
    },
    "unassisted": {**STATION, **DESCENT},
    "hexapod": {**STATION, **DESCENT},
    "tether": {**STATION, **DESCENT},
}


def conditions(name: str) -> list:
    """The method's scenario under each of `CONDITIONS`."""
    method, out = METHODS[name], []
    for wind, state in CONDITIONS:
        over: dict = {"deviation": {"level": "published"}}
        update(over, dict(method.overrides))
        if wind > 0.0:
            update(over, {"air": {"wind_mps": wind, "turbulence": "by_wind"}})
        if state != "calm":
            update(over, {"sea": {"state": state, "hull_m": 4.0}})
        out.append(load_scenario(method.scenario, over))
    return out


def main() -> None:
    """Tune the method that the command line names."""
    name, number = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 40
    space, begun, count = SPACES[name], time.monotonic(), 0

    def fly(scenario, method, seed):
        nonlocal count
        count += 1
        if count % 50 == 0:
            print(f"{count} flights, {time.monotonic() - begun:.0f} s", flush=True)
        return flown(scenario, method, seed)

    flights, method = conditions(name), METHODS[name]
    trials = tune(method, space, flights, SEEDS, draw(space, number, 1), BOUNDS, fly)
    box = near(space, trials[0].settings)
    print(f"first round, {count} flights: {trials[0]}", flush=True)
    trials = sorted(
        [trials[0], *tune(method, space, flights, SEEDS, draw(box, number, 2), BOUNDS, fly)], key=lambda t: t.cost
    )
    print(f"{name}: {count} flights of seeds {SEEDS[0]} to {SEEDS[-1]}, twice {number} candidates")
    for trial in trials[:5]:
        print(f"cost {trial.cost:.3f} over {trial.flights}: {trial.settings or 'as they stand'}")


if __name__ == "__main__":
    main()
