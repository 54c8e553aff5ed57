import json
from collections.abc import Callable

import numpy as np
import pytest

from armland import __version__
from armland.experiments.judge.brief import brief_of
from armland.records import tick_layout
from armland.runtime.log import Log
from armland.view.flown import Flown

RATE_HZ = 100
SETTLE_S = 0.5

LEG = {"start_s": SETTLE_S, "arrive_s": 2.0, "end_s": 3.0, "origin": [0.6, 0.0, 0.7], "target": [0.7, 0.15, 0.64]}


def metadata(mission: str, phases: str, legs: list[dict], **more: str) -> dict[str, str]:
    """What a log says of a mission, as far as a figure needs it."""
    return {
        "mission": mission,
        "start": "hinged" if legs else "air",
        "period_ns": str(round(1e9 / RATE_HZ)),
        "phases": phases,
        "finals": "done",
        "faults": "none",
        "limits": "{}",
        "on_cradle": "",
        "hold": "null",
        "screws": json.dumps({key: [] for key in ("joint", "hinge", "q", "anchor", "axis", "ee")}),
        "gravity": "9.81",
        "put_down": "[0.68, 0.0, 0.7]",
        "given": "[0.0, 0.0, 0.0]",
        "legs": json.dumps(legs),
        "judged_as": "path" if legs else "landing",
        "praise": "done",
        "arm": "lwr4.xml",
        "timeouts": "{}",
        "criteria": "[]",
        **more,
    }


@pytest.fixture(scope="session")
def make_run() -> Callable[..., Flown]:
    """A made-up run of 3 s: rest, one move along all axes from 1.0 s to 2.0 s, rest; the UAV swings about x."""

    def make(
        name: str = "E1",
        swing_deg: float = 5.0,
        seconds: float = 3.0,
        offset_mm: float = 2.0,
        settle_s: float = SETTLE_S,
    ) -> Flown:
        time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
        ticks = np.zeros(len(time), tick_layout(7))
        path = np.array([0.6, 0.0, 0.7]) + np.clip(time - 1.0, 0.0, 1.0)[:, None] * np.array([0.1, 0.15, -0.06])
        ticks["reference"]["r"], ticks["truth"]["r"] = path, path + 1e-3 * offset_mm
        half = 0.5 * np.deg2rad(swing_deg) * np.sin(2.0 * np.pi * time) * (time > SETTLE_S)
        ticks["reference"]["quat"] = [1.0, 0.0, 0.0, 0.0]
        ticks["truth"]["quat"][:, 0], ticks["truth"]["quat"][:, 1] = np.cos(half), np.sin(half)
        ticks["truth"]["hinge_force"] = np.column_stack([np.sin(time), np.cos(time), 2.3 + 0.1 * np.sin(9.0 * time)])
        ticks["command"]["delta_tau"] = 0.02 * np.sin(20.0 * time)[:, None]
        ticks["health"]["torque_ratio"] = 0.3
        leg = {**LEG, "start_s": settle_s}
        return Flown(name, ticks, brief_of(metadata(name, "settle,follow,rest,done", [leg])))

    return make


@pytest.fixture(scope="session")
def landing():
    """A landing as flown: an episode."""
    from armland.experiments.episode import fly
    from armland.scenario import load_scenario

    return fly(load_scenario("landing"), "landing", seed=1)


@pytest.fixture(scope="session")
def landed(landing) -> Flown:
    """Its run, as figures and tables read it."""
    return Flown("landing", landing.ticks, brief_of(landing.metadata))


@pytest.fixture(scope="session")
def log_of() -> Callable[..., Log]:
    """The log of an episode, as it would be read back."""

    def make(episode) -> Log:
        metadata = {**episode.metadata, "version": __version__, "joints": "7"}
        return Log(episode.ticks, metadata, {"scenario.toml": b'base = "landing"'}, True)

    return make


@pytest.fixture(scope="session")
def landing_log(landing, log_of) -> Log:
    """Its log."""
    return log_of(landing)


@pytest.fixture(scope="session")
def sea_log(log_of) -> Log:
    """The log of the first second of a landing at sea, in a plant that differs from the belief."""
    from armland.experiments.episode import fly
    from armland.scenario import load_scenario

    changes = {"sea": {"state": "ss3"}, "deviation": {"level": "published"}, "run": {"duration_s": 1.0}}
    return log_of(fly(load_scenario("landing", changes), "landing", seed=5))


@pytest.fixture(scope="session")
def make_row() -> Callable[..., dict]:
    """A made-up row of a campaign."""

    def make(seed: int, speed: float, success: bool = True) -> dict:
        return {
            "seed": seed,
            "success": success,
            "reason": "landed" if success else "touchdown at [too] high a speed",
            "phases": [{"name": "done", "start_s": 0.0, "end_s": 17.0}],
            "touchdown": {"speed_mps": speed, "tilt_deg": 0.2, "offset_m": 0.002},
            "capture": {"offset_m": 0.001, "relative_speed_mps": 0.12, "tilt_deg": 1.0},
            "hinge_force_max_n": 27.0,
            "joint_torque_max_ratio": 0.3,
        }

    return make
