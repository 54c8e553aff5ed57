"""Where an arm can catch: places for catch and cradle, and a pose to begin from, found over a coarse grid in front of the arm.

The grid stands on the arm's first axis: out along the cradle's slot, aside, and up; aside because many arms have their elbow and
wrist beside the plane of their shoulder, and must pass the slot all the same. From poses of several branches of the kinematics it is
filled outwards, from each node to its neighbours; a node that the arm can hold at the corners of its way there gets a merit. The best
nodes are then checked as any other landing is.

| symbol | name | unit |
|---|---|---|
| σ | smallest singular value of 𝒥 | 1 |
| merit | min(joint margin, 0.4 rad) + 3 min(σ, 0.15) + 2 min(room, 0.05 m), least over the corners, less `nearness` | 1 |
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from armland.mission.feasibility.obstacles import Obstacles
from armland.mission.feasibility.way import AT_ONCE, AT_THE_ENDS_M, MARGINS, SIGMAS, Stop, drawn, sinking
from armland.models.arm import ArmModel
from armland.models.arm_file.strength import poses, reach
from armland.models.description import EE_SITE
from armland.models.nearby import CAUTION, Body, Sinking, body_of, reached, sink
from armland.rotations import Array
from armland.scenario import Scenario

TRIED: tuple[tuple[float, tuple[float, float] | None], ...] = (
    (0.0, None),
    (0.0, (0.30, -0.13)),
    (0.0, (0.34, -0.10)),
    (180.0, None),
)
"""Heading of the cradle, and the way from catch to cradle, out and up, m, where it is not the scenario's; in the order in which they
are tried. Ahead and behind only: between, the skids, which stand across the base's x axis, would not cross the rails. The catch before
the cradle and hardly above it: so an arm whose wrist is wider than the slot passes below the rails and never between them."""

CALM = (0.0, (0.06, -0.159))
"""Likewise, as it is in calm air, for an arm that cannot go the longer way of rough weather."""

STEP = np.array([0.08, 0.06, 0.08])
"""Of the grid over the arm's reach: out, aside, up."""

LEAST_M, ASIDE_M = 0.12, 0.30
"""Distance from the first axis that is tried at least; aside that is tried at most."""

LOWEST_M = 0.12
"""Height of the rails above the floor that is tried at least."""

CENTRES = ((0.5, 0.35), (0.6, 0.1), (0.45, 0.6), (0.35, 0.3))
"""Shares of the reach, away from the first axis and above the shoulder, where poses to begin from are searched."""

STARTS, BRANCHES, ALIKE_RAD = 150, 10, 0.4
"""Random poses that are led to each centre; poses from which the grid is filled; how far two of those differ at least."""

SCATTERED = 12
"""Poses from anywhere that are tried where the centres lead to no place."""

SAME_RAD = 0.02
"""Poses in which the arm waits for one catch that differ by less lead to the same."""

ENOUGH = 25
"""Nodes after which no further branch is looked at."""

NEWTON = 15
"""Newton steps from a node to its neighbour."""


class Place(NamedTuple):
    """A place to land at that the corners of the way speak for."""

    catch: Array  # (3,) m, D
    put_down: Array  # (3,) m, D
    heading_deg: float
    home: Array  # (n,) rad, below the catch
    merit: float

    def of(self, scenario: Scenario) -> Scenario:
        """The scenario with catch, cradle and home there."""
        place = {
            "catch_m": [round(float(x), 3) for x in self.catch],
            "put_down_m": [round(float(x), 3) for x in self.put_down],
            "home_deg": [round(float(x), 3) for x in np.rad2deg(self.home)],
        }
        return scenario.replaced({"place": place, "cradle": {"heading_deg": self.heading_deg}})


class Bench(NamedTuple):
    """What places are tried with: an arm model that is overwritten, the believed scenario, its weight in the air in N."""

    arm: ArmModel
    scenario: Scenario
    weight: float
    obstacles: Obstacles
    nearness: float
    """Merit that a metre from the wanted catch costs."""


def places(bench: Bench, keep: frozenset[str]) -> Iterator[list[Place]]:
    """Places by falling merit, one list for each heading of the cradle.

    Args:
        bench: what they are tried with.
        keep: those of "catch" and "put_down" that stay where the scenario has them.
    """
    forecast, tried = bench.scenario, TRIED
    if forecast.foretold_mps > 0.0 or forecast.foretold_deck:
        tried = TRIED[0], CALM, *TRIED[1:]
    for heading, apart in tried if not keep else tried[:1]:
        yield _along(bench, heading, keep, apart)


def everywhere(bench: Bench) -> list[Place]:
    """All places of all headings from all branches: slower than `places`, which ends when it has enough."""
    return [place for heading, apart in TRIED for place in _along(bench, heading, frozenset(), apart, int(1e9))]


def first_axis(arm: ArmModel) -> Array:
    """Where the arm's first axis meets the floor (3,), m, D; the arm's state is overwritten."""
    arm.update(np.clip(np.zeros(arm.joints), arm.q_min, arm.q_max), np.zeros(arm.joints))
    return np.asarray(arm.anchor[0] * [1.0, 1.0, 0.0])


class _Search(NamedTuple):
    bench: Bench
    grid: "_Grid"
    body: Body
    how: Sinking
    barren: dict[bytes, list[Array]]  # Catch -> poses (n,), rad, of the arm that waits, which lead to nothing


def _along(
    bench: Bench, heading: float, keep: frozenset[str], apart: tuple[float, float] | None, enough: int = ENOUGH
) -> list[Place]:
    grid, how = _Grid(bench, heading, keep, apart), sinking(bench.arm, bench.scenario)
    search, found = _Search(bench, grid, body_of(bench.arm), how, {}), dict[_Node, Place]()
    # Poses from anywhere are slower, and tell nothing new of an arm that reaches the centres: the first that leads to places will do.
    for branches, plenty in ((_branches, enough), (_scattered, 1)):
        for q in branches(search) if not found else ():
            for node, place in _filled(search, q):
                if node not in found or place.merit > found[node].merit:
                    found[node] = place
            if len(found) >= plenty:
                break
    return sorted(found.values(), key=lambda p: -p.merit)


_Node = tuple[int, int, int]


class _Grid:
    """Nodes of a grid in front of the arm, and what a catch there means."""

    def __init__(
        self, bench: Bench, heading: float, keep: frozenset[str], apart: tuple[float, float] | None = None
    ) -> None:
        arm, place = bench.arm, bench.scenario.place
        arm.update(np.clip(np.zeros(arm.joints), arm.q_min, arm.q_max), np.zeros(arm.joints))
        angle, own = np.deg2rad(heading), np.deg2rad(bench.scenario.cradle.heading_deg)
        c, s = np.cos(angle), np.sin(angle)
        self.heading, self.frame = heading, np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        self.axis, self.shoulder = arm.anchor[0] * [1.0, 1.0, 0.0], arm.anchor[1].copy()
        self.reach, self.wanted = reach(arm.model, EE_SITE), np.array(place.catch_m)
        self.step = STEP * self.reach
        # From catch to cradle as the scenario has it, turned with the slot, or as it is told.
        c, s = np.cos(own), np.sin(own)
        there = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ (np.array(place.put_down_m) - self.wanted)
        self.apart = self.frame @ (there if apart is None else np.array([apart[0], 0.0, apart[1]]))
        skids, lever = bench.scenario.skids, bench.obstacles.lever
        self.lowest = LOWEST_M + lever[2] - skids.z_m + skids.radius_m - self.apart[2]
        self.fixed: Array | None = None
        if keep:
            self.fixed = self.wanted if "catch" in keep else np.array(place.put_down_m) - self.apart

    def catch(self, node: _Node) -> Array | None:
        """The catch (3,), m, D, that a node means; None where it is beyond what is tried."""
        if self.fixed is not None:
            return self.fixed if node == (0, 0, 0) else None
        local = self.step * node
        point = np.round(self.axis + self.frame @ local, 3)
        near = np.linalg.norm(point - self.shoulder) <= self.reach
        return point if local[0] >= LEAST_M and abs(local[1]) <= ASIDE_M and local[2] >= self.lowest and near else None

    def node(self, point: Array) -> _Node:
        """The node next to a point (3,), m, D."""
        if self.fixed is not None:
            return 0, 0, 0
        i, k, j = np.rint(self.frame.T @ (point - self.axis) / self.step).astype(int)
        return int(i), int(k), int(j)

    def centres(self) -> list[Array]:
        """Where poses to begin from are searched."""
        if self.fixed is not None:
            return [self.fixed]
        high = [max(self.shoulder[2] + up * self.reach, self.lowest) for _, up in CENTRES]
        return [
            self.axis + out * self.reach * self.frame[:, 0] + [0.0, 0.0, z]
            for (out, _), z in zip(CENTRES, high, strict=True)
        ]


def _branches(search: _Search) -> list[Array]:
    # Poses of different branches, sunk, so that those that differ by the null space alone are one.
    out: list[Array] = []
    starts = poses(search.bench.arm.model)[:STARTS]
    for centre in search.grid.centres():
        here = 0
        for start in starts:
            q = start.copy()
            if not reached(search.body, q, centre, 60, CAUTION) or not sink(
                search.body, q, centre, search.how, AT_ONCE
            ):
                continue
            if all(np.abs(q - other).max() > ALIKE_RAD for other in out):
                out.append(q)
                here += 1
            if here >= BRANCHES // 2 or len(out) >= BRANCHES:
                break
    return out[:BRANCHES]


def _scattered(search: _Search) -> list[Array]:
    # Upright poses from all over the joints' ranges, each of another node, for an arm that reaches none of the centres.
    arm, out, seen = search.bench.arm, list[Array](), set[_Node]()
    for start in poses(arm.model):
        q = start.copy()
        arm.update(q, np.zeros(arm.joints))
        there = arm.position.copy()
        node = search.grid.node(there)
        if node in seen or search.grid.catch(node) is None or not reached(search.body, q, there, 60, CAUTION):
            continue
        if sink(search.body, q, there, search.how, AT_ONCE):
            seen.add(node)
            out.append(q)
        if len(out) >= SCATTERED:
            break
    return out


def _filled(search: _Search, q: Array) -> Iterator[tuple[_Node, Place]]:
    # Outwards from the node next to a pose, over all nodes that are reached.
    arm = search.bench.arm
    arm.update(q, np.zeros(arm.joints))
    first = search.grid.node(arm.position)
    waiting, seen = [(first, q)], {first}
    while waiting:
        node, before = waiting.pop(0)
        catch, there = search.grid.catch(node), before.copy()
        if catch is None or not reached(search.body, there, catch, NEWTON, 0.0):
            continue
        place = _judged(search, catch, there)
        if place is not None:
            yield node, place
        i, j, k = node
        around = ((i - 1, j, k), (i + 1, j, k), (i, j - 1, k), (i, j + 1, k), (i, j, k - 1), (i, j, k + 1))
        waiting += [(after, there) for after in around if after not in seen]
        seen.update(around)


def _judged(search: _Search, catch: Array, q: Array) -> Place | None:
    # By the corners of its way: where the arm waits, the catch's box, above and below the cradle. Branches meet: none is tried again.
    s, grid, up = search.bench.scenario, search.grid, np.array([0.0, 0.0, 1.0])
    put_down, error, holds = catch + grid.apart, s.bounds.uav_error_m, s.control.posture_rad_s > 0.0
    out, below = error * grid.frame[:, 0], catch - s.place.wait_below_m * up
    lowest = put_down - max(s.place.withdraw_m, s.place.search_m) * up
    aside = (0.5 * (s.cradle.gap_m - s.arm.width_m) - s.control.approach.clearance_m) * grid.frame[:, 1]
    ends = error * up, out, -out, aside, -aside
    corners = [Stop(below, catch), Stop(lowest, put_down), *(Stop(catch + p, catch + p, AT_THE_ENDS_M) for p in ends)]
    corners += [Stop(p, p) for p in (catch, put_down + s.place.above_m * up)]
    merit, home, known, how = np.inf, q, search.barren.setdefault(catch.tobytes(), []), search.how
    for k, (point, pivot, slack) in enumerate(corners):
        there = q.copy()
        reaches = sink(search.body, there, point, how, AT_ONCE // 4)
        if k == 0:
            if not reaches or any(np.abs(there - other).max() < SAME_RAD for other in known):
                return None
            search.bench.obstacles.put_cradle(put_down, grid.heading)
            home = there
            q, how = (home, drawn(how, search.bench.arm, s, home)) if holds else (q, how)
        one = _merit(search.bench, there, Stop(point, pivot, slack)) if reaches else None
        if one is None:
            known.append(home)
            return None
        merit = min(merit, one)
    merit -= search.bench.nearness * float(np.linalg.norm(catch - grid.wanted))
    return Place(catch, put_down, grid.heading, home, merit)


def _merit(bench: Bench, q: Array, stop: Stop) -> float | None:
    arm, limits = bench.arm, bench.scenario.limits
    margin = float(np.minimum(q - arm.q_min, arm.q_max - q).min())
    if margin < MARGINS * limits.joint_margin_rad:
        return None
    arm.update(q, np.zeros(arm.joints))
    sigma = float(np.linalg.svd(arm.jacobian, compute_uv=False)[-1])
    needed = np.abs(arm.gravity + 1.5 * bench.weight * arm.jacobian[2]) / arm.tau_max
    if sigma < SIGMAS * limits.sigma_min or needed.max() > 0.9:
        return None
    room = bench.obstacles.nearest(q, stop.pivot, stop.slack, any_will_do=True).room
    return None if room < 0.0 else min(margin, 0.4) + 3.0 * min(sigma, 0.15) + 2.0 * room
