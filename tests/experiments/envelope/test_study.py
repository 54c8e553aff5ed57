"""The whole study: what lies outside is named, and the result is as documented."""

from dataclasses import replace

import numpy as np
import pytest

from armland.experiments.envelope.bounds import Axis, Edge
from armland.experiments.envelope.study import at_the_gate
from armland.models.capture import GATE_M


def test_captures_hold_with_all_thresholds_at_once(small):
    found = small
    assert found.corners_held == len(found.corners) == 10


def test_what_lies_outside_is_named(small):
    found = small
    assert found.holds
    assert found.outside == []
    late = replace(found, allowed=found.allowed._replace(lost=0.015))
    assert [m.threshold for m in late.margins if not m.holds] == ["bounds.lost_offset_m"]
    assert not late.holds
    assert "bounds.lost_offset_m = 0.015 m" in late.outside[0]
    wide = replace(found, allowed=found.allowed._replace(offset=0.0065))
    assert "bounds.align_offset_m" in wide.outside[0]


def test_the_lowest_closing_speed_is_bounded_from_below(small):
    axis = Axis("slowest", (Edge(0.01, "x"),), (Edge(0.01, "x"), Edge(0.05, "y")), 0.0, 0.0)
    found = replace(small, axes=(*(a for a in small.axes if a.name != "slowest"), axis))
    lowest = found.margins[-1]
    assert not lowest.holds
    assert lowest.margin == pytest.approx(found.allowed.slowest - 0.05)


def test_result_has_the_documented_keys(small):
    result = small.result()
    assert set(result) == {
        "holds",
        "outside",
        "gate_m",
        "closing_mps",
        "thresholds",
        "corners",
        "axes",
        "maps",
        "flown",
        "interception",
        "captures",
    }
    assert set(result["thresholds"][0]) == {
        "threshold",
        "unit",
        "value",
        "bound",
        "alone",
        "closed_form",
        "margin",
        "limit",
        "holds",
    }


def test_at_the_gate_reads_the_tick_of_passing(landed):
    close = landed.metadata["phases"].split(",").index("close")
    state = at_the_gate(landed.ticks, close)
    truth, phase = landed.ticks["truth"], landed.ticks["mission"]["phase"]
    gap = (truth["r"] - truth["ee"])[:, 2]
    first = int(np.flatnonzero((phase == close) & (gap < GATE_M))[0])
    assert state is not None
    assert state[0] == pytest.approx(np.hypot(*(truth["r"] - truth["ee"])[first, :2]))
    assert at_the_gate(landed.ticks[:1000], close) is None


def test_flown_landings_lie_well_inside(small):
    (flown,) = small.flown
    assert flown.offset < 0.5 * small.axis("offset").bound.bound
    assert flown.speed < 0.5 * small.axis("speed").bound.bound
    assert flown.closing == pytest.approx(small.closing, rel=0.4)
