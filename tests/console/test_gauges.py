"""Gauges: what a tick says in HTML, each number beside its bound."""

import numpy as np
import pytest

from armland.console.gauges import (
    GOOD,
    NEAR,
    OVER,
    Bar,
    bars_html,
    bars_of,
    flags_of,
    lines_html,
    name_of,
    runs_of,
    shares_html,
    strip_html,
)
from armland.records import Limit, tick_layout

LIMITS = {"sigma_min": np.array([0.03]), "hinge_max": np.array([100.0])}


@pytest.fixture
def tick():
    made = np.zeros(1, tick_layout(7))
    health = made["health"]
    health["torque_ratio"], health["speed_ratio"], health["sigma_min"] = 0.5, 0.1, 0.06
    health["joint_margin"], health["uav_age"] = 0.2, 0.05
    made["truth"]["hinge_force"] = [3.0, 0.0, 4.0]
    return made


def test_a_bar_says_how_much_of_a_limit_is_used(tick) -> None:
    bars = {bar.name: bar for bar in bars_of(tick[0], LIMITS, 0.25)}
    assert bars["joint torque"].used == 0.5
    assert bars["singularity"].used == pytest.approx(0.5)
    assert bars["hinge force"].used == pytest.approx(0.05)
    assert bars["joint range"].used == pytest.approx(0.1)
    assert bars["link"].used == pytest.approx(0.2)
    assert bars["hinge force"].words == "5.0 N, at most 100 N"
    assert bars["link"].words == "50 ms, at most 250 ms"


def test_a_limit_that_a_log_does_not_know_has_no_bar(tick) -> None:
    assert {bar.name for bar in bars_of(tick[0], {}, 0.25)} == {"joint torque", "joint speed", "joint range", "link"}


@pytest.mark.parametrize(
    ("used", "color", "width"), [(0.2, GOOD, 20), (0.8, NEAR, 80), (1.7, OVER, 100), (-1.0, GOOD, 0)]
)
def test_bars_are_coloured_by_how_near_they_are(used: float, color: str, width: int) -> None:
    html = bars_html([Bar("link", used, "words <&>")])
    assert f"width:{width}%;background:{color}" in html
    assert "words &lt;&amp;&gt;" in html


def test_a_bar_without_a_number_is_empty() -> None:
    assert "width:0%" in bars_html([Bar("link", float("nan"), "")])


def test_shares_add_up_to_the_whole_bar() -> None:
    html = shares_html(3.0, 1.0, 0.0)
    assert "width:75.0%" in html
    assert "width:25.0%" in html
    assert "rotors 3.0 N" in html
    # A foot that is pulled bears nothing, and nothing at all divides by nothing.
    assert "width:0.0%" in shares_html(1.0, -2.0, 0.0)
    assert "width:0.0%" in shares_html(0.0, 0.0, 0.0)


def test_the_strip_marks_the_phase_in_progress() -> None:
    html = strip_html(("guide", "hand_over"), [0, 1], 1)
    assert 'data-phase="hand_over"' in html
    assert html.index("guide") < html.index(">hand over<")
    assert html.count("#0072B2") == 1
    assert "number 9" in strip_html(("guide",), [0, 9], 9)


def test_names_and_runs() -> None:
    assert name_of(("a", "b"), 1) == "b"
    assert name_of(("a", "b"), 2) == "number 2"
    assert name_of((), -1) == "number -1"
    assert runs_of(np.array([0, 0, 1, 1, 0, 2])) == [0, 1, 0, 2]
    assert runs_of(np.array([], int)) == []


def test_flags_are_named(tick) -> None:
    assert flags_of(tick[0]) == []
    tick["health"]["flags"] = Limit.JOINT_SPEED | Limit.SINGULAR
    assert flags_of(tick[0]) == ["joint speed", "singularity"]


def test_lines_are_text_and_no_markup() -> None:
    assert lines_html([]) == ""
    assert "&lt;script&gt;" in lines_html(["<script>"])
    assert OVER in lines_html(["x"], warning=True)
    assert OVER not in lines_html(["x"])


def test_where_no_arm_flies_nothing_is_said_of_one() -> None:
    tick = np.zeros(1, tick_layout(0))
    assert [bar.name for bar in bars_of(tick[0], {}, 0.25)] == ["link"]
    html = shares_html(3.0, 0.0, 1.0, armless=True)
    assert "pad 1.0 N" in html
    assert "arm" not in html
    assert "cradle" not in html
