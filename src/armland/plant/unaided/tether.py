"""Winch and rope below the UAV: what they do in each phase, and the force on the UAV; compiled.

| phase | winch |
|---|---|
| `find`, `guide`, `ready` | keeps the rope just taut |
| `descend` | reels in at the descent's speed: the UAV thrusts against it |
| `settle`, `done` | pulls the UAV on the pad |
| `away` | lets go |

Source of the method: pulled down by a winch against its thrust, as in Sensors 19(4) 886 (helicopter, cable that is kept taut). The
drum stands on the deck, which nothing moves.
"""

import numpy as np
from numba import njit

from armland.control.laws.unaided.winch import reel
from armland.mission.unaided.decide import AWAY, DESCEND, DONE, SETTLE
from armland.models.unaided.rope import POINTS, carry_rope
from armland.plant.scene.composition import Scene
from armland.records import Record, Records
from armland.rotations import Array, cross, matrix, turned
from armland.scenario import Scenario

SHORTEST_M = 0.03
"""Length that is always paid out: below it the rope's end lies in the fairlead."""


def layout() -> np.dtype:
    """What winch and rope are told and keep."""
    return np.dtype(
        [
            ("fitted", "i8"),
            ("fairlead", "f8", (3,)),  # m, D
            ("rope", "f8", (3,)),  # L, m; λ, kg/m; EA, N
            ("limits", "f8", (4,)),  # κ, m/s/N, and that while it reels in; m/s; m/s²
            ("tension", "f8", (4,)),  # N: low, against the thrust, hold, and at the drum at present
            ("sink", "f8"),  # m/s
            ("speed", "f8"),  # m/s, of the rope, in is positive
            ("gravity", "f8", (3,)),  # m/s², W
            ("tick_s", "f8"),
            ("place", "f8", (POINTS, 3)),
            ("moves", "f8", (POINTS, 3)),
            ("begun", "i8"),
            ("force", "f8", (3,)),  # N, W, on the UAV
        ]
    )


def tell(told: Records, scenario: Scenario, scene: Scene) -> None:
    """Fill `told` (1,) of `layout`."""
    t = scenario.tether
    told["fitted"], told["sink"] = 1, scenario.descent.sink_mps
    told["fairlead"] = [*scene.put_down[:2], scenario.pad.height_m]
    told["rope"] = 1.0, t.kg_per_m, t.stretch_n
    told["limits"] = t.give_mps_per_n, t.reel_mps_per_n, t.speed_mps, t.acceleration_mps2
    told["tension"] = t.low_n, t.pull_n, t.hold_n, 0.0
    told["gravity"], told["tick_s"] = scenario.environment.gravity_mps2, 1.0 / scenario.run.rate_hz


def forget(kept: Records) -> None:
    """Put the winch of `kept` (1,) to its begin: the rope is laid out at the first tick."""
    for name in ("speed", "begun", "place", "moves", "force"):
        kept[name] = np.zeros_like(kept[name])


@njit(cache=True)
def pull(p: Record, phase: int, t: Record, xipos: Array, applied: Array) -> None:
    """One tick of winch and rope.

    Args:
        p: of `layout`, updated.
        phase: of the mission.
        t: truth of the tick.
        xipos: (3,), m, W, where the wrench on the UAV acts.
        applied: (6,), N, N·m, W, wrench on the UAV, added to.
    """
    if phase == AWAY:
        p.begun = 0
        return
    ends, ends_v = np.empty((2, 3)), np.empty((2, 3))
    out = turned(matrix(t.deck_quat), p.fairlead)
    carried = cross(t.deck_omega.copy(), out)
    for i in range(3):
        ends[0, i], ends_v[0, i] = t.deck[i] + out[i], t.deck_v[i] + carried[i]
        ends[1, i], ends_v[1, i] = t.r[i], t.v[i]
    if not p.begun:
        _lay_out(p, ends, ends_v)
    asked, rate, give = p.tension[0], 0.0, p.limits[0]
    if phase == DESCEND:
        asked, rate, give = p.tension[1], p.sink, p.limits[1]
    elif phase in (SETTLE, DONE):
        asked = p.tension[2]
    p.speed = reel(p.speed, p.tension[3], asked, rate, (give, p.limits[2], p.limits[3]), p.tick_s)
    length = p.rope[0] - p.speed * p.tick_s
    p.rope[0] = max(length, SHORTEST_M)
    if length < SHORTEST_M:
        p.speed = 0.0
    force, low = carry_rope(p.place, p.moves, ends, ends_v, p.rope, p.gravity, p.tick_s)
    p.tension[3] = low
    arm = np.empty(3)
    for i in range(3):
        arm[i] = t.r[i] - xipos[i]
        p.force[i] = force[i]
    moment = cross(arm, force)
    for i in range(3):
        applied[i] += force[i]
        applied[3 + i] += moment[i]


@njit(cache=True)
def _lay_out(p: Record, ends: Array, ends_v: Array) -> None:
    # Straight, and just not taut.
    p.begun, total = 1, 0.0
    for j in range(3):
        total += (ends[1, j] - ends[0, j]) ** 2
    p.rope[0] = np.sqrt(total)
    for i in range(POINTS):
        share = (i + 1.0) / (POINTS + 1.0)
        for j in range(3):
            p.place[i, j] = ends[0, j] + share * (ends[1, j] - ends[0, j])
            p.moves[i, j] = ends_v[0, j] + share * (ends_v[1, j] - ends_v[0, j])
