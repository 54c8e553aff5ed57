"""Touchdown, capture and their forces change by under 10 % where the physics steps twice and four times in a tick.

Control and magnet keep their rate and the noise is off, so that nothing but the physics' step differs.
"""

from functools import lru_cache

import mujoco
import numpy as np
import pytest

from armland.experiments.episode import prepare
from armland.plant.scene.closing import RATE, closing
from armland.scenario import load_scenario

QUIET = {"imperfections": {"noise": False, "camera": False}}


def divide_steps(model, steps):
    """Step `steps` times as often; what meets with a rate does so by what belongs to that step."""
    before, model.opt.timestep = model.opt.timestep, model.opt.timestep / steps
    by_rate = (model.pair_solref == closing(RATE, before)).all(axis=1)
    assert by_rate.sum() >= 4
    model.pair_solref[by_rate] = closing(RATE, model.opt.timestep)


def flown(mission, seed, steps):
    """The ticks of a flight whose physics makes `steps` steps in each."""
    flight = prepare(load_scenario("landing").replaced(QUIET), mission, seed)
    simulator, controller, tick, rows = flight.simulator, flight.controller, flight.controller.tick, []
    divide_steps(simulator.scene.model, steps)
    simulator.connect()
    while len(rows) < flight.plan.ticks and controller.ended_for() < flight.plan.watch:
        simulator.read(tick)
        controller.update(tick)
        rows.append(tick.buffer[0].copy())
        simulator.command(tick)
        mujoco.mj_step(simulator.scene.model, simulator.data, nstep=steps - 1) if steps > 1 else None
    return np.array(rows)


@lru_cache
def figures(mission, seed, steps):
    """What the step size may change, by name; speeds in m/s, lengths in m, forces in N."""
    truth = flown(mission, seed, steps)["truth"]
    hinge = np.linalg.norm(truth["hinge_force"], axis=1)
    touch = int(np.flatnonzero(truth["touching"] > 0)[0])
    closing = np.linalg.norm(truth["v"] - truth["ee_v"], axis=1)[touch - 30 : touch + 1]
    found = {"snap": closing.max(), "capture force": hinge[touch - 10 : touch + 300].max()}
    if mission == "landing":
        down = int(np.flatnonzero(truth["cradle_force"][:, 2] > 0.2)[0])
        found["capture offset"] = np.hypot(*(truth["r"] - truth["ee"])[touch, :2])
        found["touchdown speed"] = np.linalg.norm(truth["v"][down - 2])
        found["touchdown force"] = hinge[down - 10 : down + 500].max()
        found["cradle force"] = truth["cradle_force"][down - 10 : down + 500, 2].max()
    return found


def changes(mission, seed, steps):
    """Share by which each figure changes."""
    whole, parts = figures(mission, seed, 1), figures(mission, seed, steps)
    changed = {name: float(parts[name] / value - 1.0) for name, value in whole.items()}
    print(mission, seed, steps, {name: f"{value:.4g} {100.0 * changed[name]:+.1f} %" for name, value in whole.items()})
    return changed


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("steps", [2, 4])
def test_shorter_steps_change_nothing_of_a_landing_by_a_tenth(seed, steps):
    changed = changes("landing", seed, steps)
    assert max(map(abs, changed.values())) < 0.10, changed


@pytest.mark.slow
@pytest.mark.parametrize("steps", [2, 4])
def test_shorter_steps_change_snap_and_force_of_a_takeoff_by_less_than_a_tenth(steps):
    changed = changes("takeoff", 1, steps)
    assert max(map(abs, changed.values())) < 0.10, changed
