"""Where the UAV is asked to be so that the camera sees it: inside its cone of view, and back into it once it is lost; compiled.

| symbol | name | unit |
|---|---|---|
| ℓ | `told.line` (3,): from the optical centre to the marker, less that from end effector to pivot, both level | m, D |
| x, y, z | from the optical centre to the marker: p − r + ℓ | m, D |
| c | `told.cone`: tangent of the angle of sight to which the UAV is kept | 1 |

Seen, it is asked to be no lower than z = √(x² + y²)/c: beside the camera's axis it comes down only as far as it comes closer to it.
Lost, it is told to hover by its own means above the camera, by a step from where it was reckoned last: it rises, since the view
widens with the height, and moves sideways once it is high enough to pass the arm. It is never told to come down.
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.records import Record, Records
from armland.rotations import Array
from armland.scenario import Scenario

LEAN_DEG = 7.0
"""Lean of the UAV for which the cone leaves room: 6 degrees against a wind of 2 m/s with a gust of 0.5 m/s, rounded up."""

ABOVE_M = 0.4
"""Height above its station at which a UAV that is lost is looked for first: there the cone is twice as wide."""

RISE_MPS, DEEPEST = 0.1, 0.8
"""Speed at which it rises further until it is found; share of the camera's largest depth beyond which it does not."""

ASIDE_M = 0.4
"""Largest step sideways: no UAV that has just left the view is further from it."""

PASSES_M = 0.1
"""Height of the pivot above the end effector from which on the UAV passes above the arm, which draws back meanwhile."""

RISEN_S = 2.0
"""Time after which it has surely risen by half of what it was told to."""


@lru_cache
def told_layout() -> np.dtype:
    """What keeping in view is told."""
    return np.dtype([("line", "f8", (3,)), ("cone", "f8"), ("highest", "f8")])  # m, 1, m: highest pivot [D]


def told(scenario: Scenario, lever: Array) -> Records:
    """The record (1,) of `told_layout`; `lever` (3,), m, body, from the centre of mass to the pivot."""
    camera, p = scenario.camera, np.zeros(1, told_layout())
    p["line"] = np.array(camera.marker_m) - lever - camera.position_m
    widest = min(camera.incidence_max_deg, 0.5 * min(camera.field_of_view_deg))
    # Of a camera that sees hardly further than a leaning UAV allows, half of what it sees.
    p["cone"] = np.tan(np.deg2rad(max(widest - LEAN_DEG, 0.5 * widest)))
    waits = scenario.place.catch_m[2] - scenario.place.wait_below_m
    p["highest"] = waits + DEEPEST * camera.depth_max_per_size * camera.marker_size_m - p["line"][0, 2]
    return p


@njit(cache=True)
def in_view(e: Record, p: Record) -> Array:
    """The station (3,), m, D, raised as far as keeps the UAV in view.

    Args:
        e: estimate.
        p: what commanding the UAV is told.
    """
    place, v = p.station.copy(), p.sight
    aside = np.hypot(e.plate[0] - e.r[0] + v.line[0], e.plate[1] - e.r[1] + v.line[1])
    needed = e.r[2] - v.line[2] + aside / v.cone
    place[2] = max(place[2], min(needed, v.highest))
    return place


@njit(cache=True)
def seek(alone_s: float, e: Record, known: bool, p: Record, s: Record) -> None:
    """Set the step of a UAV that is lost, from where it is reckoned when that is found; it rises meanwhile.

    Args:
        alone_s: how long it has been told to hover by itself, s.
        e: estimate.
        known: whether it has been seen at all: where it is nobody knows of one that has not, and it stays.
        p: what commanding the UAV is told.
        s: what acting keeps; `step`, `lost`, m, D, and `sought` are written.
    """
    if not known:
        return
    if s.sought == 0:
        s.sought = 1
        for i in range(3):
            s.lost[i], s.step[i] = e.plate[i], 0.0
        s.step[2] = max(p.station[2] + ABOVE_M - e.plate[2], 0.0)
    s.step[2] = min(s.step[2] + RISE_MPS * p.tick_s, max(p.sight.highest - s.lost[2], s.step[2]))
    height = s.lost[2] + (0.5 * s.step[2] if alone_s > RISEN_S else 0.0)
    if height > e.r[2] + PASSES_M:
        for i in range(2):
            s.step[i] = min(max(p.station[i] - s.lost[i], -ASIDE_M), ASIDE_M)
