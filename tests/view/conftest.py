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


@pytest.fixture(scope="session")
def made_up_margins():
    """Margins of four deviations, and a pair."""
    from armland.experiments.margins.corners import chosen, largest
    from armland.experiments.margins.screening import Listed, Screening
    from armland.experiments.margins.search import Bracket, Failure
    from armland.experiments.margins.study import Margin, Margins, Terms
    from armland.view.figures.margins import LEAST

    mass, thrust, drag, loss = chosen("uav.mass,uav.thrust,uav.drag,link.loss")
    why = Failure(2, "limits violated: too fast", "lost")
    margins = (
        Margin(loss, Bracket(0.0, LEAST, why, 6), largest(loss)),
        Margin(mass, Bracket(2.0, 2.4, why, 6), largest(mass)),
        Margin(drag, Bracket(largest(drag), None, None, 4), largest(drag)),
        Margin(thrust, Bracket(8.0, None, None, 4), largest(thrust)),
    )
    pair = Listed(("uav.mass", "link.loss"), ("high", "there"), 0.31, 0.02, True)
    return Margins(Terms(), (1, 2, 3), margins, Screening(24, 20, 1.0, (pair._replace(rows=("uav.mass",)),), (pair,)))


@pytest.fixture(scope="session")
def made_up_envelope():
    """An envelope of few points."""
    from armland.experiments.envelope.bench import Capture
    from armland.experiments.envelope.bounds import Allowed, Axis, Edge, Map
    from armland.experiments.envelope.interception import Tracked
    from armland.experiments.envelope.study import EnvelopeStudy, Flown

    directions = [0.0, 0.5 * np.pi, np.pi]

    def axis(name, bound):
        edges = tuple(Edge(bound, "3 of 4 pads", w) for w in directions)
        return Axis(name, edges, edges, 1.1 * bound, bound)

    bounds = {"offset": 0.0065, "speed": 0.2, "tilt": 0.4, "plate": 0.3, "fastest": 0.6, "slowest": 0.01}
    boundary = (Edge(0.2, "3 of 4 pads"), Edge(0.1, "3 of 4 pads"))
    maps = (
        Map("offset", "speed", (0.0, 0.008), boundary, (0.2, 0.1), (0.004, 0.06)),
        Map("offset", "tilt", (0.0, 0.008), boundary, (0.2, 0.1), (0.004, 0.1)),
        Map("closing", "speed", (0.0, 0.8), boundary, (0.2, 0.1), (0.16, 0.06)),
    )
    limits = dict.fromkeys(
        ("offset", "relative speed", "joint speed", "joint torque", "torque rate", "track filter"), 0.1
    )
    held = Capture(True, "held", 4, 15.0, 6.0, 0.005, 0.03)
    return EnvelopeStudy(
        allowed=Allowed(0.004, 0.06, 0.1, 0.015, 0.04, 0.16),
        closing=0.1,
        axes=tuple(axis(k, v) for k, v in bounds.items()),
        maps=maps,
        corners=((0.0, held),),
        flown=(Flown(1, 0.001, 0.02, 0.09, 0.2, 1.0), Flown(2, 0.002, 0.01, 0.1, 0.1, 0.5)),
        tracked=tuple(Tracked(f, 0.01, 0.1 * f, 0.05, {**limits, "offset": 0.04 / f}) for f in (0.5, 1.0)),
        captures=10,
    )


@pytest.fixture(scope="session")
def made_up_spread():
    """Both demonstrators at a few points."""
    from armland.experiments.spread import E1_LARGEST, E2_LARGEST, PAPER, RATIO, Demonstrator, Sensitivity, Spread

    def point(e1, e2):
        return dict.fromkeys(PAPER, 0.5) | {E1_LARGEST: e1, E2_LARGEST: e2}

    both = [
        Demonstrator(n, point(9.0, 7.0), [point(4.0, 8.0), point(170.0, 8.0)], {"E2 overshoots less": 0.75})
        for n in ("fitted", "bench")
    ]
    return Spread(both, [Sensitivity("control.thrust_n", 4.7, point(9.0, 6.7) | {RATIO: 0.99}, {"+1 N": 1.33})])


@pytest.fixture(scope="session")
def made_up_factorial():
    """One law with every board under every arm."""
    from armland.experiments.factorial import ARMS, BOARDS, Cell, Factorial
    from armland.experiments.judge.tracking import Metrics

    return Factorial(
        [
            Cell(
                "E3", board, arm, Metrics(10.0 * i + j + 1.0, 0.0, [0.0] * 3, [1e-3 * (j + 1)] * 3, [0.0] * 3, 0.0, 0.0)
            )
            for i, board in enumerate(BOARDS)
            for j, arm in enumerate(ARMS)
        ]
    )
