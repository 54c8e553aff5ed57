"""Recordings: what can be shown of a log is shown, and what cannot be is said."""

import numpy as np
import pytest

from armland.console.recording import Recording, threshold
from armland.errors import LogError
from armland.experiments.operator.script import SCRIPT_NAME
from armland.runtime.log import Log, read_log


def changed(log, file, **metadata):
    """The log with other metadata; None takes a key away."""
    kept = {k: v for k, v in (log.metadata | metadata).items() if v is not None}
    return Recording(Log(log.ticks, kept, log.attachments, log.complete), file)


def test_a_whole_log_has_nothing_to_note(recording, landed) -> None:
    assert recording.notes == []
    assert recording.scene is not None
    assert recording.name == "landing seed 1 (landing)"
    assert recording.end == pytest.approx((len(landed.ticks) - 1) * 1e-3)
    assert recording.at(1.234)["measurement"]["tick"] == 1234
    assert recording.at(-5.0)["measurement"]["tick"] == 0
    assert recording.at(1e9)["measurement"]["tick"] == len(landed.ticks) - 1
    assert recording.wind(1.0) is None


def test_events_are_phases_in_order(recording, landed) -> None:
    phases = [e for e in recording.events if e.kind == "phase"]
    assert [e.words for e in phases] == [p.name.replace("_", " ") for p in landed.judgement.phases]
    assert [e.time for e in phases] == pytest.approx([p.start_s for p in landed.judgement.phases])


def test_the_way_ahead_is_the_reference_s(recording) -> None:
    ahead = recording.ahead(5.0, 1.0)
    assert ahead.shape == (16, 3)
    np.testing.assert_array_equal(ahead[0], recording.ticks["reference"]["r"][5000])


def test_supervisor_and_operator_are_among_the_events(recording, log_file) -> None:
    ticks = recording.ticks.copy()
    ticks["mission"]["fault"][7000:] = 6
    line = b'{"tick": 3000, "do": "wind", "value": 5.0}\n{"tick": 6000, "do": "hold"}\n'
    log = Log(ticks, recording.log.metadata, {SCRIPT_NAME: line}, True)
    made = Recording(log, log_file)
    told = [(e.time, e.kind, e.words) for e in made.events if e.kind != "phase"]
    assert told[0] == (3.0, "operator", "wind 5 m/s at 20 ft")
    assert told[1] == (6.0, "operator", "hold")
    assert told[2][:2] == (7.0, "supervisor")
    assert "uav_silent found" in told[2][2]
    assert made.wind(1.0) is None
    assert np.linalg.norm(made.wind(4.0)) > 1.0


def test_a_log_that_was_cut_off_is_shown_as_far_as_it_goes(log_file, tmp_path) -> None:
    data, file = log_file.read_bytes(), tmp_path / "cut.mcap"
    file.write_bytes(data[: len(data) // 2])
    made = Recording(read_log(file), file)
    assert 1000 < len(made.ticks) < 13_000
    assert made.notes == ["cut.mcap was cut off: what stands in it until then is shown."]
    assert made.scene is not None


def test_names_that_are_missing_become_numbers(recording, log_file) -> None:
    made = changed(recording.log, log_file, phases=None, faults=None)
    assert "names no 'phases'" in made.notes[0]
    assert "by their numbers" in made.notes[1]
    assert made.phase(made.at(0.0)) == "number 0"
    assert made.events[0].words == "number 0"


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"scenario": None}, "has no 'scenario'"),
        ({"start": None}, "has no 'start'"),
        ({"scenario": "{}"}, "none of this version"),
        ({"scenario": "no json"}, "none of this version"),
        ({"scenario": '{"nonsense": 1}'}, "none of this version"),
    ],
)
def test_without_its_scenario_the_plots_are_shown(recording, log_file, change: dict, why: str) -> None:
    made = changed(recording.log, log_file, **change)
    assert made.scene is None
    assert why in made.notes[-1]
    assert made.notes[-1].endswith("Its plots are shown.")
    np.testing.assert_array_equal(made.curves.time, recording.curves.time)


def without_arm(recording, log_file) -> Recording:
    text = recording.log.metadata["scenario"].replace('"lwr4.xml"', '"gone.xml"')
    return changed(recording.log, log_file, scenario=text)


def test_without_the_arm_s_file_all_else_is_shown(recording, log_file) -> None:
    made = without_arm(recording, log_file)
    assert made.armless
    assert "gone.xml" in made.notes[-1]
    assert made.notes[-1].endswith("All but the arm is shown.")


def test_without_the_uav_s_file_too_the_plots_are_shown(recording, log_file) -> None:
    text = recording.log.metadata["scenario"].replace('"ardrone2.xml"', '"gone_too.xml"')
    made = changed(recording.log, log_file, scenario=text)
    assert made.scene is None
    assert not made.armless
    assert "gone_too.xml" in made.notes[-1]
    assert made.notes[-1].endswith("Its plots are shown.")


def test_of_an_arm_of_other_joints_all_else_is_shown(recording, log_file) -> None:
    from armland.records import tick_layout

    log = Log(np.zeros(100, tick_layout(6)), recording.log.metadata, {}, True)
    made = Recording(log, log_file)
    assert made.armless
    assert "not as many joints" in made.notes[-1]


@pytest.mark.parametrize("count", [0, 1])
def test_a_log_of_nothing_is_refused(recording, log_file, count: int) -> None:
    with pytest.raises(LogError, match=f"it holds {count} ticks"):
        Recording(Log(recording.ticks[:count], recording.log.metadata, {}, True), log_file)


def test_a_damaged_script_is_said_and_left_out(recording, log_file) -> None:
    log = Log(recording.ticks, recording.log.metadata, {SCRIPT_NAME: b"nonsense"}, True)
    made = Recording(log, log_file)
    assert made.told == ()
    assert "what the operator did is not shown" in made.notes[-1]


def test_the_command_flies_the_same_again(recording, log_file) -> None:
    assert recording.command.startswith("armland land --seed 1")
    assert "--operator" not in recording.command
    script = b'{"tick": 1500, "do": "sea", "value": 0.5}\n{"tick": 2500, "do": "hold"}\n'
    steered = Recording(Log(recording.ticks, recording.log.metadata, {SCRIPT_NAME: script}, True), log_file)
    assert steered.command.endswith(f"--operator {log_file}")
    assert [steered.share_of_sea(t) for t in (1.0, 2.0, 9.0)] == [1.0, 0.5, 0.5]
    assert changed(recording.log, log_file, seed=None).command == ""


def test_thresholds(recording) -> None:
    assert threshold(recording.log.metadata, "align_offset_m") > 0.0
    assert threshold({}, "align_offset_m") == 0.0
    assert threshold({"thresholds": "[1]"}, "x") == 0.0
    assert threshold({"thresholds": '{"x": "a"}'}, "x") == 0.0
