"""The paper's demonstrator for short runs: without noise unless asked for, home pose searched once."""

from types import SimpleNamespace

import numpy as np
import pytest

from armland.config import load_scenario
from armland.experiments.assembly import assemble, survey
from armland.records import Tick, tick_layout

NOISELESS = {
    "joint_position_rad": 0.0,
    "joint_velocity_rad_s": 0.0,
    "force_n": 0.0,
    "torque_nm": 0.0,
    "attitude_rad": 0.0,
    "rate_rad_s": 0.0,
}
# Starts to move at once: a short run sees acceleration on every axis.
BRISK = {"moves": [{"to_m": [0.08, 0.1, -0.05], "duration_s": 0.5, "rest_s": 0.5}], "start_m": [0.58, 0.0, 0.74]}


def merged(base, extra):
    out = dict(base)
    for key, value in extra.items():
        out[key] = merged(out.get(key, {}), value) if isinstance(value, dict) else value
    return out


@pytest.fixture(scope="session")
def paper():
    """The paper's scenario, noiseless and brisk, with changes."""

    def scenario(**sections):
        base = {"sensors": NOISELESS, "trajectory": BRISK, "run": {"settle_s": 0.0, "tail_s": 0.0}}
        return load_scenario("paper", merged(base, sections))

    return scenario


@pytest.fixture(scope="session")
def workplace(paper):
    """Where the arm starts; the path belongs to the base rate of 1 kHz."""
    return survey(paper())


@pytest.fixture(scope="session")
def flight(paper, workplace):
    """Fly a scenario; returns its ticks and the plant. `watch(plant, k)` is called after each step."""

    def fly(scenario=None, experiment="E1", ticks=1000, watch=None):
        scenario = scenario or paper()
        own = (
            workplace
            if scenario.run.rate_hz == 1000 and scenario.trajectory == paper().trajectory
            else survey(scenario)
        )
        a = assemble(scenario, experiment, own)
        record = np.zeros(ticks, tick_layout(a.controller.arm.joints))
        a.plant.connect()
        for k in range(ticks):
            a.plant.read(a.tick)
            a.controller.update(a.tick)
            a.plant.command(a.tick)
            record[k] = a.tick.buffer[0]
            if watch is not None:
                watch(a.plant, k)
        return SimpleNamespace(ticks=record, plant=a.plant, scenario=scenario)

    return fly


@pytest.fixture
def held(paper, workplace):
    """A demonstrator that is commanded by hand: `step(tau, delta_tau, thrust)` reads, commands and returns the tick."""

    def build(scenario=None):
        scenario = scenario or paper()
        plant = assemble(scenario, "E1", workplace).plant
        plant.connect()
        tick = Tick(7)
        rest = plant.data.ctrl.copy()

        def step(tau=None, delta_tau=(0.0, 0.0, 0.0), thrust=scenario.control.thrust_n):
            plant.read(tick)
            tick.command["tau"] = rest if tau is None else tau
            tick.command["delta_tau"], tick.command["thrust"] = delta_tau, thrust
            plant.command(tick)
            return tick

        return SimpleNamespace(plant=plant, tick=tick, step=step)

    return build
