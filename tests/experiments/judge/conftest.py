"""Records made by hand: a UAV that stands, and a brief of a landing and of a take-off."""

import json

import numpy as np
import pytest

from armland.experiments.judge.brief import brief_of
from armland.records import tick_layout

SCREWS = {
    "joint": [0, 1, 2],
    "hinge": [True, True, True],
    "q": [0.0, -0.5 * np.pi, 0.0],
    "anchor": [[0.0, 0.0, 0.5]] * 3,
    "axis": [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    "ee": [0.0, 0.0, 0.5],
}
"""A wrist: its outer axes cross at a right angle where q is zero, and coincide where the middle joint is at −90°."""

PHASES = ("guide", "close", "carry", "release", "done", "abort", "holding")

METADATA = {
    "mission": "landing",
    "start": "air",
    "period_ns": "1000000",
    "phases": ",".join(PHASES),
    "finals": "done,abort,holding",
    "on_cradle": "release,done",
    "hold": json.dumps({"rating_n": 100.0, "shear_share": 0.2, "share": 0.6}),
    "screws": json.dumps(SCREWS),
    "gravity": "9.81",
    "faults": "none,uav_silent,slip",
    "limits": json.dumps(
        {
            "q_min": [-2.0] * 7,
            "q_max": [2.0] * 7,
            "qd_max": [1.9] * 7,
            "tau_max": [100.0] * 7,
            "torque_rate": 1500.0,
            "sigma_min": 0.03,
            "hinge_max": 106.2,
        }
    ),
    "put_down": "[0.68, 0.0, 0.701]",
    "given": "[0.0, 0.0, 0.0]",
    "legs": "[]",
    "judged_as": "landing",
    "praise": "landed",
    "arm": "lwr4.xml",
    "timeouts": json.dumps({"carry": "the arm did not arrive: look for what is in its way"}),
    "criteria": json.dumps(
        [
            ["touchdown_speed", 0.15, "m/s", "speed at touchdown"],
            ["placed", 0.01, "m", "placed beside the cradle's middle"],
            ["rest.speed_mps", 0.01, "m/s", "speed at the end"],
        ]
    ),
}


def standing(ticks=4000):
    """A UAV that flies, is caught at 1 s, and stands from 2 s on; phases end at 1, 1.5, 2, 2.5 s."""
    r = np.zeros(ticks, tick_layout(7))
    t = r["truth"]
    t["quat"][:, 0] = t["plate_quat"][:, 0] = t["ee_quat"][:, 0] = 1.0
    t["r"] = t["ee"] = [0.681, 0.0, 0.701]
    t["r"][:2000, 2] = t["ee"][:2000, 2] = 0.9
    t["r"][:1000, 0] += 0.003
    t["r_cm"] = t["r"] + [0.0, 0.0, 0.06]
    t["v"][1500:2000, 2] = -0.1
    t["touching"][1000:2500] = 4
    t["cradle_force"][2000:, 2] = 4.7
    r["health"]["sigma_min"] = 0.2
    r["command"]["magnet"][900:2500] = 1
    r["mission"]["phase"] = np.searchsorted([1000, 1500, 2000, 2500], np.arange(ticks), side="right")
    return r


@pytest.fixture
def ticks():
    return standing()


@pytest.fixture
def brief():
    return brief_of(METADATA)


@pytest.fixture
def metadata():
    return dict(METADATA)
