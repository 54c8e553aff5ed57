"""Phases of a record made by hand."""

from armland.experiments.judge.phases import end_of, last_flown, phase_times


def test_phases_join_without_gaps(ticks, brief):
    times = phase_times(ticks["mission"]["phase"], brief.phases, brief.rate_hz)
    assert [(p.name, p.start_s, p.end_s) for p in times[:2]] == [("guide", 0.0, 1.0), ("close", 1.0, 1.5)]
    assert times[-1].end_s == len(ticks) / brief.rate_hz


def test_an_end_that_another_follows_is_no_phase_of_the_mission(ticks, brief):
    assert (end_of(ticks, brief), last_flown(ticks, brief)) == ("done", "release")
    ticks["mission"]["phase"][1500:2500] = brief.phases.index("abort")
    assert last_flown(ticks, brief) == "close"


def test_a_mission_that_has_not_ended_was_last_in_its_phase(ticks, brief):
    assert last_flown(ticks[:1800], brief) == "carry"
