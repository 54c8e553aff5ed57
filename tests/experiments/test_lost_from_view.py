"""A UAV that leaves the camera's view before it is caught: kept in view, found again, or given up after the longest search."""

import numpy as np
import pytest

from armland.experiments.episode import fly_prepared, prepare
from armland.scenario import load_scenario

WIND = {"deviation": {"air": {"wind_mps": [2.0, 2.0], "gust_mps": [0.5, 0.5]}}}
NARROW = {"camera": {"incidence_max_deg": 25.0}}
"""A camera that sees no marker at flatter angles, from whichever side."""

SHOVE = {"kind": "push", "phase": "align", "body": "uav", "size": 0.8, "direction": [0.0, 1.0, 0.0], "lasts_s": 1.0}
"""A sixth of its weight."""


def flown(change=None, seed=5000, **settings):
    """A landing; `change` may change what the controller has been made of."""
    flight = prepare(load_scenario("landing", settings), "landing", seed)
    if change is not None:
        change(flight.controller.board)
    return fly_prepared(flight)


def unseen_s(episode):
    """The longest time without an image while the UAV flies guided or is looked for."""
    ticks, names = episode.ticks, episode.metadata["phases"].split(",")
    flies = np.isin(
        ticks["mission"]["phase"], [names.index(n) for n in ("guide", "approach", "align", "close", "miss")]
    )
    return float(ticks["estimate"]["plate_age"][flies].max())


def no_cone(board):
    board["told"]["act"]["uav"]["sight"]["cone"] = 1e3


def no_search(board):
    board["table"]["phases"]["seeks"] = 0


@pytest.mark.parametrize(("change", "stays"), [(None, True), (no_cone, False)])
def test_uav_that_a_wind_takes_aside_stays_in_view_or_is_found(change, stays):
    """Negative control: brought down to its station first, it leaves the view, and must be looked for."""
    episode = flown(change, **WIND, **NARROW)
    assert episode.result["success"], episode.result["reason"]
    assert (unseen_s(episode) < 0.5) == stays


@pytest.mark.parametrize(("change", "lands"), [(None, True), (no_search, False)])
def test_uav_that_is_shoved_out_of_view_is_found_and_lands(change, lands):
    """Negative control: where nobody looks for it the mission ends after two seconds."""
    episode = flown(change, faults=[SHOVE])
    assert episode.result["success"] == lands, episode.result["reason"]
    assert unseen_s(episode) > 1.9
    if not lands:
        assert episode.judgement.fault == "camera_stale"


@pytest.mark.parametrize(
    ("phase", "lasts_s", "end"), [("guide", 4.0, "done"), ("guide", None, "abort"), ("align", None, "abort")]
)
def test_camera_that_is_blind_for_good_ends_the_mission_safely_after_the_longest_search(phase, lasts_s, end):
    lasts = {} if lasts_s is None else {"lasts_s": lasts_s}
    episode = flown(faults=[{"kind": "camera_lost", "phase": phase, **lasts}])
    assert episode.judgement.end == end
    if end == "abort":
        j = episode.judgement
        assert (j.fault, j.state, j.limits_violated) == ("camera_stale", "flying", [])
        assert unseen_s(episode) == pytest.approx(8.0, abs=0.02)
        np.testing.assert_array_equal(episode.ticks["truth"]["foul"], 0.0)
