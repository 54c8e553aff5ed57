"""Plots: which numbers, thinned, with phases as ground and actions as bands."""

import numpy as np
import pytest

from armland.console.plots import (
    ACTION_S,
    GROUNDS,
    MOST_HZ,
    PANELS,
    Charts,
    Curves,
    actions,
    curves_of,
    cut,
    joined,
    thin,
)
from armland.records import tick_layout

PERIOD_S = 1e-3


@pytest.fixture
def ticks():
    made = np.zeros(3000, tick_layout(7))
    made["measurement"]["tick"] = np.arange(3000)
    made["truth"]["quat"][:, 0] = 1.0
    made["truth"]["r"][:, 2], made["truth"]["ee"][:, 2] = 1.0, 0.7
    made["truth"]["r"][:, 0] = np.linspace(0.0, 0.03, 3000)
    made["truth"]["rotor_thrust"][:, :4], made["truth"]["hinge_force"] = 1.25, [0.0, 0.0, 2.0]
    made["mission"]["phase"][1000:], made["mission"]["fault"][2000:] = 3, 5
    made["proof"]["v2"], made["health"]["uav_age"] = np.nan, 0.012
    return made


@pytest.fixture
def curves(ticks):
    return curves_of(thin(ticks, 1000), PERIOD_S)


def line(curves, title: str, number: int = 0):
    (i,) = [i for i, p in enumerate(PANELS) if p.title.startswith(title)]
    return curves.lines[i][number]


def test_no_more_points_than_the_eye_sees(ticks) -> None:
    assert len(thin(ticks, 1000)) <= 3.1 * MOST_HZ
    assert len(thin(ticks, 10)) == len(ticks)


def test_lines_are_what_their_titles_say(curves) -> None:
    assert line(curves, "height", 0)[0] == 1.0
    assert line(curves, "height", 1)[0] == 0.7
    assert line(curves, "horizontal distance")[-1] == pytest.approx(30.0, abs=0.4)
    assert line(curves, "hinge force")[0] == 2.0
    assert line(curves, "who carries", 0)[0] == pytest.approx(5.0)
    assert line(curves, "who carries", 1)[0] == 2.0
    assert line(curves, "age of")[0] == pytest.approx(12.0)
    # A chart knows no gaps: what is not a number would leave it blank.
    assert line(curves, "V₂")[0] == 0.0
    assert all(len(one) == len(curves.time) for panel in curves.lines for one in panel)


def test_every_panel_says_its_unit() -> None:
    assert all("(" in p.title for p in PANELS)
    assert len({p.title for p in PANELS}) == len(PANELS)


def test_actions_begin_when_a_fault_is_named(curves) -> None:
    shown = curves.time[actions(curves)]
    assert shown[0] == pytest.approx(2.0, abs=0.05)
    assert shown[-1] - shown[0] == pytest.approx(ACTION_S, abs=0.07)
    quiet = curves._replace(fault=np.zeros_like(curves.fault))
    assert not actions(quiet).any()


def test_cut_and_joined_undo_each_other(curves) -> None:
    parts = [cut(curves, 0.0, 0.999), cut(curves, 1.0, 9.0)]
    assert 0 < len(parts[0].time) < len(curves.time)
    whole = joined(parts)
    np.testing.assert_array_equal(whole.time, curves.time)
    np.testing.assert_array_equal(line(whole, "height"), line(curves, "height"))
    np.testing.assert_array_equal(whole.phase, curves.phase)


def test_charts_show_grounds_actions_and_now(server, curves) -> None:
    charts = Charts(server.viser.gui, ["now"])
    charts.show(curves, now=1.5)
    data = charts._charts[0].data
    assert len(data) == 1 + len(GROUNDS) + 2 + 2
    np.testing.assert_array_equal(data[0], curves.time)
    grounds = np.array(data[1 : 1 + len(GROUNDS)])
    # One ground at a time, another one from 1 s on.
    np.testing.assert_array_equal(grounds.sum(axis=0), 1.0)
    assert grounds[0, 0] == grounds[0, -1] == 1.0
    other = curves._replace(phase=np.where(curves.phase == 3, 4, 0))
    charts.show(other)
    assert charts._charts[0].data[2][-1] == 1.0
    now = data[2 + len(GROUNDS)]
    assert curves.time[np.flatnonzero(now)[0]] == pytest.approx(1.5, abs=0.04)
    assert data[1 + len(GROUNDS)].sum() == actions(curves).sum()


def test_two_flights_and_their_difference(server, curves) -> None:
    charts = Charts(server.viser.gui, ["1", "2"])
    higher = curves._replace(lines=tuple(tuple(one + 1.0 for one in panel) for panel in curves.lines))
    charts.show(higher, curves)
    data = charts._charts[0].data
    np.testing.assert_allclose(data[-1], 1.0)
    np.testing.assert_allclose(data[-2], 1.0)
    np.testing.assert_array_equal(data[-3], curves.lines[0][1])


def test_a_single_point_is_no_chart(server, curves) -> None:
    charts = Charts(server.viser.gui, ["now"])
    before = charts._charts[0].data
    charts.show(cut(curves, 0.0, 0.01))
    assert charts._charts[0].data is before


def test_where_no_arm_flies_no_chart_is_of_one(server) -> None:
    shown = [words for panel in PANELS for _, words in panel.shown(arm=False)]
    assert shown == ["UAV", "UAV to its place", "force", "rotors", "pad", "link"]
    charts = Charts(server.viser.gui, ["now"], arm=False)
    assert [PANELS[n].title.split(" (")[0] for n, _ in charts._shown] == [
        *("height", "horizontal distance", "hinge force", "who carries the weight", "age of the UAV's sample"),
    ]
    time, few = np.arange(3.0), np.zeros(3, int)
    lines = tuple(tuple(np.full(3, 10.0 * n + i) for i in range(len(p.lines))) for n, p in enumerate(PANELS))
    charts.show(Curves(time, few, few, lines))
    # Rotors and pad, of the fifth panel: the arm between them is left out.
    assert [float(values[0]) for values in charts._charts[3].data[-2:]] == [40.0, 42.0]
