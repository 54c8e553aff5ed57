"""The forecast: the very entries of the supervisor's table, and what came of a fault beside them."""

import numpy as np
import pytest

from armland.console.live.forecast import (
    AT_ONCE,
    Thrown,
    end_of,
    failure,
    forecast,
    outcome,
    table_html,
    waits_html,
)
from armland.console.live.pilot import Now
from armland.errors import ConfigurationError
from armland.experiments.episode import prepare
from armland.experiments.operator.hand import Hand
from armland.experiments.operator.provoked import PROVOKED
from armland.mission.supervisor.operator import HELD_BY_HAND
from armland.mission.supervisor.table import FAULT_TABLE
from armland.mission.table.phases import SIGNALS
from armland.records import tick_layout


@pytest.fixture(scope="module")
def plan(landing_scenario):
    return Hand(prepare(landing_scenario, "landing", 1)).flight.plan


@pytest.mark.parametrize("fault", PROVOKED)
def test_ends_are_those_of_the_supervisor_s_table(plan, fault: str) -> None:
    for phase in plan.phases:
        if phase.kind != "end" and not phase.final and phase.name not in HELD_BY_HAND:
            want = FAULT_TABLE[fault][phase.kind]
            assert end_of(plan, fault, phase.name) == (want if phase.sight or fault != "camera_stale" else "-")


def test_it_is_said_in_words(plan) -> None:
    words = forecast(plan, "uav_silent", "carry")
    assert "in carry the supervisor goes to holding" in words
    assert "the magnet is on" not in words.split("holding")[0]
    assert "does not matter" in forecast(plan, "magnet_coil", "guide")


def test_the_table_has_every_fault_and_phase_and_marks_the_cell(plan) -> None:
    html = table_html(plan, ("slip", "carry"))
    assert html.count("<tr>") == len(PROVOKED) + 1
    assert html.count("background:#E69F0088") == 1
    assert "hand over" in html
    assert "held by operator" not in html
    row = html[html.index(">slip<") :]
    assert "let fly" in row[: row.index("</tr>")]


def test_failures_begin_at_once_or_with_a_phase() -> None:
    assert failure("uav_silent", AT_ONCE).phase is None
    assert failure("uav_silent", "carry").phase == "carry"
    with pytest.raises(ConfigurationError, match="nothing in the plant makes 'law_failed'"):
        failure("law_failed", AT_ONCE)


def test_the_outcome_stands_beside_what_was_said() -> None:
    thrown = Thrown("uav_silent", "carry", "holding")
    assert outcome(thrown, "uav_silent", "carry", "holding", 0.28).endswith("went to holding, as the table says")
    other = outcome(thrown, "power_lost", "carry", "holding", 0.3)
    assert "found power_lost in carry after 0.30 s" in other
    assert "the table said uav_silent to holding" in other


def now_in(plan, phase: str, signals=(), held=()) -> Now:
    tick = np.zeros(1, tick_layout(7))
    tick["mission"]["phase"], tick["mission"]["elapsed"] = plan.number(phase), 1.5
    values = np.zeros(len(SIGNALS))
    for name, value in dict(signals).items():
        values[list(SIGNALS).index(name)] = value
    held_for = np.zeros(64, int)
    for number, count in dict(held).items():
        held_for[number] = count
    return Now(tick, values, held_for, np.zeros(3))


def test_a_guard_says_how_far_it_is_from_firing(plan) -> None:
    first = int(plan.table["phases"]["first"][0, plan.number("guide")])
    now = now_in(plan, "guide", {"uav_error": 0.5, "uav_seen": 1.0}, {first: 30})
    html = waits_html(plan, now, plan.thresholds)
    assert "<b>approach</b> when, for 30 of 200 ticks" in html
    assert f"· uav error 0.5 &lt; {plan.thresholds['uav_error_m']:.3g} m" in html
    assert "✓ uav seen 1 &gt; 0.5" in html
    assert "else abort in 18.5 s" in html


def test_ends_and_holds_wait_for_nothing(plan) -> None:
    assert "has ended" in waits_html(plan, now_in(plan, "abort"), plan.thresholds)
    assert "held by the operator" in waits_html(plan, now_in(plan, "held_by_operator"), plan.thresholds)
