"""Something touches an arm that carries nothing where no force sensor feels it: the supervisor stops the arm, by its joints alone."""

from functools import cache

import numpy as np
import pytest

from armland.cli.options import load
from armland.experiments.episode import fly_prepared, prepare
from armland.mission.supervisor.table import FAULTS

ARMS = {"lwr": None, "six_axis": "examples/six_axis.urdf", "seven_axis": "examples/seven_axis.urdf"}

CELLS = (
    ("landing", "self_test", "braked_refused"),
    ("landing", "guide", "braked_free"),
    ("landing", "approach", "braked_free"),
    ("landing", "align", "braked_free"),
    ("landing", "close", "braked_free"),
    ("takeoff", "self_test", "braked_refused"),
    ("takeoff", "reach", "braked_refused"),
    ("takeoff", "release", "braked_free"),
    ("takeoff", "clear", "braked_free"),
)
"""Phases of free motion of each kind, and where they lead."""

PUSH_N, AFTER_S = 45.0, 0.05


@cache
def ready(arm, mission):
    """A flight of which nothing but faults will differ: catch and cradle are found once."""
    return prepare(load("landing", {"arm": ARMS[arm], "deviation": "nominal"}), mission, 1)


def flown(arm, mission, phase, blind=False, push=PUSH_N):
    """Fault, its delay, s, and the last phase of a flight in which somebody pushes the elbow aside."""
    first = ready(arm, mission)
    fault = {"kind": "push", "body": "elbow", "size": push, "direction": (0.0, 1.0, 0.0), "phase": phase}
    flight = prepare(first.scenario.replaced({"faults": [{**fault, "after_s": AFTER_S}]}), mission, 1)
    if blind:
        flight.controller.board["told"]["estimate"]["momentum"]["steady"] = np.inf
    ticks, names = fly_prepared(flight).ticks, flight.plan.names
    there = ticks["mission"]
    begun = int(np.flatnonzero(there["phase"] == names.index(phase))[0])
    found = np.flatnonzero(there["fault"][begun:])
    if not found.size:
        return "none", np.inf, names[int(there["phase"][-1])]
    return (
        FAULTS[int(there["fault"][begun + found[0]])],
        1e-3 * int(found[0]) - AFTER_S,
        names[int(there["phase"][-1])],
    )


QUICK = (("lwr", CELLS[1]), ("six_axis", CELLS[1]))


@pytest.mark.parametrize(
    ("arm", "cell"),
    [pytest.param(arm, cell, marks=() if (arm, cell) in QUICK else pytest.mark.slow) for arm in ARMS for cell in CELLS],
)
def test_push_on_the_elbow_stops_the_arm_in_each_phase_of_free_motion(arm, cell):
    mission, phase, end = cell
    fault, delay_s, last = flown(arm, mission, phase)
    assert (fault, last) == ("arm_blocked", end)
    assert delay_s < 0.15


@pytest.mark.parametrize(("arm", "cell"), QUICK)
def test_without_the_observer_nobody_notices(arm, cell):
    fault, _, last = flown(arm, *cell[:2], blind=True)
    assert fault == "none"
    assert not last.startswith("braked")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arm", "mission", "seeds"),
    [("lwr", "landing", 40), ("lwr", "takeoff", 20), ("six_axis", "landing", 10), ("six_axis", "takeoff", 5)],
)
def test_arms_that_nothing_touches_stay_below_two_thirds_of_the_doubt(arm, mission, seeds):
    """At published deviations; a flight that is ended by it would be a false alarm."""
    first, peaks = prepare(load("landing", {"arm": ARMS[arm], "deviation": "published"}), mission, 1), []
    for seed in range(1, seeds + 1):
        flight = prepare(first.scenario, mission, seed, known=first.plan)
        fly_prepared(flight)
        peaks.append(float(flight.controller.board["kept"]["estimate"]["momentum"]["peak"][0]))
    assert max(peaks) < 2.0 / 3.0
    # A doubt that is never filled would notice nothing either.
    assert np.median(peaks) > 0.1
