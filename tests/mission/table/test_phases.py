"""Phases and guards as they are written."""

import pytest

from armland.mission.table.phases import SIGNALS, Condition, Guard, Phase

BEGIN = Phase("begin", arm="hold", uav="station")


def test_guards_are_added_in_the_order_in_which_they_are_asked():
    phase = BEGIN.to("near", "offset < near_m, tilt < level_deg", 0.1).to("far", "offset > far_m")
    assert phase.guards == (
        Guard("near", (Condition("offset", "<", "near_m"), Condition("tilt", "<", "level_deg")), 0.1),
        Guard("far", (Condition("offset", ">", "far_m"),), 0.0),
    )
    assert phase._replace(guards=()) == BEGIN


@pytest.mark.parametrize("text", ["offset <", "offset < near_m and tilt < level_deg"])
def test_condition_that_is_no_comparison_is_an_error(text):
    with pytest.raises(TypeError):
        BEGIN.to("near", text)


def test_every_signal_has_a_unit():
    assert all(SIGNALS.values())
