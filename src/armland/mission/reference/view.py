"""Where the UAV is asked to be so that the camera sees it: inside its cone of view, and back into it once it is lost; compiled.

| symbol | name | unit |
|---|---|---|
| ℓ | `told.line` (3,): from the optical centre to the marker, less that from end effector to pivot, both level | m, D |
| x, y, z | from the optical centre to the marker: p − r + ℓ | m, D |
| θ, n | lean of the UAV against the wind, and the way it leans: `kept.hovered` over g | rad, 1, D |
| φ | half of what θ exceeds `told.level` by | rad |
| c | `told.cone`: tangent of the angle of sight to which the UAV is kept | 1 |

Seen, it is asked to be no lower than z = √(x² + y²)/c: beside the camera's axis it comes down only as far as it comes closer to it.
In wind it leans towards where the wind comes from, and so does its marker's face turn away from a camera right below. Where it is
waited for it keeps (z − `told.near`) tan φ n beside the camera's axis: then a gust of either way takes the marker out of
the field of view or beyond its largest incidence equally late, and no way at all where it is caught.

Lost, it is told to hover by its own means above the camera, by a step from where it was reckoned last: it rises, since the view
widens with the height, and moves sideways once it is high enough to pass the arm. Where it was reckoned
may be wrong, so it comes back to that step, and rises again; it is never told to come down further.
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.records import Record, Records
from armland.rotations import Array
from armland.scenario import Scenario

LEAN_DEG = 7.0
"""Lean of the UAV for which the cone leaves room: 6 degrees against a wind of 2 m/s with a gust of 0.5 m/s, rounded up; more where
more wind is expected."""

MARKER_DEG, NEAR = 5.0, 0.5
"""Half of the marker as the camera sees it from where it waits; share of that height at which the UAV is right above the camera."""

UNSEEN_S = 0.3
"""Time without an image after which a UAV that is reckoned in wind rises."""

ABOVE_M = 0.4
"""Height above its station at which a UAV that is lost is looked for first: there the cone is twice as wide."""

HEAVES_M = 0.3
"""Beyond that above a deck: it hovers in W by itself, and a hull in sea state 3 heaves by as much, mean of its highest third."""

RISE_MPS, DEEPEST = 0.1, 0.8
"""Speed at which it rises further, and comes back, until it is found; share of the camera's largest depth beyond which it does not."""

LEAST_SPAN_M = 1e-3
"""Of the search upwards, where the camera sees no further than it begins."""

ASIDE_M = 0.4
"""Largest step sideways: no UAV that has just left the view is further from it."""

LOWERS_MPS = 0.25
"""Speed at which a UAV that waits above its station in wind comes down."""

PASSES_M = 0.1
"""Height of the pivot above the end effector from which on the UAV passes above the arm, which draws back meanwhile."""

RISEN_S = 2.0
"""Time after which it has surely risen by half of what it was told to."""


@lru_cache
def told_layout() -> np.dtype:
    """What keeping in view is told."""
    # m, 1, m: highest pivot [D]; whether wind is expected; rad; m, height of the marker above the camera
    sight = [("line", "f8", (3,)), ("cone", "f8"), ("highest", "f8")]
    # m, m/s, m: how far above its station it waits, how fast it comes down from there, and how far it goes up out of view
    waits = [("above", "f8"), ("lowers", "f8"), ("lifts", "f8")]
    return np.dtype([*sight, ("leans", "i8"), ("level", "f8"), ("near", "f8"), *waits])


def told(scenario: Scenario, lever: Array, lean: float = 0.0) -> Records:
    """The record (1,) of `told_layout`.

    Args:
        scenario: believed.
        lever: (3,), m, body, from the centre of mass to the pivot.
        lean: rad, of the UAV in a gust of the wind that is expected.
    """
    camera, p = scenario.camera, np.zeros(1, told_layout())
    p["line"] = np.array(camera.marker_m) - lever - camera.position_m
    angle = min(camera.incidence_max_deg, camera.hidden_from_deg)
    widest = min(angle, 0.5 * min(camera.field_of_view_deg))
    # Of a camera that sees hardly further than a leaning UAV allows, half of what it sees.
    p["cone"] = np.tan(np.deg2rad(max(widest - max(LEAN_DEG, np.rad2deg(lean)), 0.5 * widest)))
    p["leans"] = lean > 0.0
    p["level"] = np.deg2rad(max(angle - (0.5 * min(camera.field_of_view_deg) - MARKER_DEG), 0.0))
    p["near"] = NEAR * (scenario.place.wait_below_m + p["line"][0, 2])
    p["above"], p["lowers"] = (scenario.place.waits_above_m if lean > 0.0 else 0.0), LOWERS_MPS
    p["lifts"] = ABOVE_M + (HEAVES_M if scenario.foretold_deck else 0.0)
    waits = scenario.place.catch_m[2] - scenario.place.wait_below_m
    p["highest"] = waits + DEEPEST * camera.depth_max_per_size * camera.marker_size_m - p["line"][0, 2]
    return p


@njit(cache=True)
def in_view(e: Record, waits: bool, p: Record, s: Record) -> Array:
    """The station (3,), m, D, moved as far as keeps the UAV in view.

    Args:
        e: estimate.
        waits: whether the arm waits for the UAV.
        p: what commanding the UAV is told.
        s: what acting keeps.
    """
    place, v = p.station.copy(), p.sight
    x, y = e.plate[0] - e.r[0] + v.line[0], e.plate[1] - e.r[1] + v.line[1]
    if v.leans:
        step = v.lowers * p.period * p.tick_s
        s.above += min(max((v.above if waits else 0.0) - s.above, -step), step)
        place[2] += s.above
    if v.leans and waits:
        share = upwind(e.plate[2] - e.r[2] + v.line[2], p, s)
        for i in range(2):
            place[i] += share * s.hovered[i]
        x, y = x - share * s.hovered[0], y - share * s.hovered[1]
    aside = np.hypot(x, y)
    if v.leans and e.plate_age > UNSEEN_S:
        # What is reckoned errs more by the second: away from arm and rails, and into the wider view.
        place[2] += v.lifts
    needed = e.r[2] - v.line[2] + aside / v.cone
    place[2] = max(place[2], min(needed, v.highest))
    for i in range(3):
        s.asked[i] = place[i]
    return place


@njit(cache=True)
def upwind(height: float, p: Record, s: Record) -> float:
    """How far the UAV is kept beside the camera's axis, over the acceleration that it holds against the wind with, s².

    Args:
        height: of the marker above the camera, m.
        p: what commanding the UAV is told.
        s: what acting keeps.
    """
    held = np.hypot(s.hovered[0], s.hovered[1])
    turn = 0.5 * (np.arctan(held / p.gravity) - p.sight.level)
    return float(max(height - p.sight.near, 0.0) * np.tan(turn) / held) if turn > 0.0 else 0.0


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
        s.begun = alone_s
    first = max(p.station[2] + p.sight.lifts - s.lost[2], 0.0)
    span = max(p.sight.highest - s.lost[2] - first, LEAST_SPAN_M)
    swept = (RISE_MPS * (alone_s - s.begun)) % (2.0 * span)
    s.step[2] = first + min(swept, 2.0 * span - swept)
    height = s.lost[2] + (0.5 * s.step[2] if alone_s > RISEN_S else 0.0)
    if height > e.r[2] + PASSES_M:
        share = upwind(height - e.r[2] + p.sight.line[2], p, s) if p.sight.leans else 0.0
        for i in range(2):
            s.step[i] = min(max(p.station[i] + share * s.hovered[i] - s.lost[i], -ASIDE_M), ASIDE_M)
