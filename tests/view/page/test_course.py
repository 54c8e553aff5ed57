import numpy as np

from armland.experiments.judge.judgement import phase_times
from armland.mission.table.phases import SIGNALS
from armland.runtime.log import Log
from armland.view.flown import flown, scenario_of
from armland.view.page.course import course, stretches


def events(log):
    run = flown(log)
    phases = phase_times(log.messages["mission"]["phase"], run.brief.phases, run.brief.rate_hz)
    return course(run, phases, log.metadata, scenario_of(log)), phases


def test_each_phase_is_entered_with_its_guard(landing_log) -> None:
    found, phases = events(landing_log)
    led = [e for e in found if e.kind == "phase"]
    assert [e.what.split(" → ")[1].replace(" ", "_") for e in led] == [p.name for p in phases[1:]]
    assert [e.time_s for e in led] == [p.start_s for p in phases[1:]]
    why = {e.what: e.why for e in led}
    assert why["close → capture"] == "contact"
    assert why["set down → unload"].startswith("ground share > 0.15")
    assert "uav speed < 0.15 m/s" in why["guide → approach"]
    assert not any(e.kind == "fault" for e in found)


def test_fault_comes_with_its_time_sign_end_and_remedy(failed_log) -> None:
    found, _ = events(failed_log)
    (fault,) = [e for e in found if e.kind == "fault"]
    number = failed_log.metadata["faults"].split(",").index("rotor_lost")
    assert fault.time_s == np.argmax(failed_log.messages["mission"]["fault"] == number) / 1000
    assert fault.what.startswith("fault rotor_lost, seen for 5 ms; led to balancing")
    assert "Remedy: look at its motors" in fault.why
    into = [e for e in found if e.what == "carry → balancing"]
    assert [e.why for e in into] == ["fault rotor_lost"]


def test_time_that_ran_out_says_for_what(landing_log) -> None:
    ticks, (_, phases) = landing_log.ticks.copy(), events(landing_log)
    k = round(phases[-1].start_s * 1000)
    ticks["mission"]["unmet"][k] = 1 << list(SIGNALS).index("uav_seen")
    found, _ = events(Log(ticks, landing_log.metadata, {}, True))
    last = [e for e in found if e.kind == "phase"][-1]
    assert last.why == "the time for withdraw was over: the UAV was not seen"


def test_events_stand_in_the_order_of_time(failed_log) -> None:
    times = [e.time_s for e in events(failed_log)[0]]
    assert times == sorted(times)


def test_stretches_join_what_is_near() -> None:
    where = np.zeros(30, bool)
    where[[3, 4, 8, 20]] = True
    assert stretches(where, 5) == [(3, 8, 3), (20, 20, 1)]
    assert stretches(where, 3) == [(3, 4, 2), (8, 8, 1), (20, 20, 1)]
    assert stretches(~where | where, 1) == [(0, 29, 30)]
    assert stretches(np.zeros(5, bool), 5) == []


def test_limits_are_told_with_their_ticks(landing_log) -> None:
    found = [e for e in events(landing_log)[0] if e.kind == "limit"]
    flags = landing_log.messages["health"]["flags"]
    told = sum(int(e.why.split()[0]) for e in found if e.what.startswith("torque rate"))
    assert told == int((flags & 16 != 0).sum())
