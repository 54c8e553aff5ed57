"""Scripts of an operator: text and back, files and logs, and what is refused in them."""

import numpy as np
import pytest

from armland.errors import LogError
from armland.experiments.operator import script
from armland.experiments.operator.message import message_of
from armland.experiments.operator.script import (
    SCRIPT_NAME,
    first_difference,
    messages_of,
    read_script,
    script_of,
    text_of,
)
from armland.records import tick_layout
from armland.runtime.recorder import Recorder

MESSAGES = (
    message_of({"tick": 10, "do": "wind", "value": 3.25}),
    message_of({"tick": 10, "do": "hold"}),
    message_of(
        {"tick": 900, "do": "fault", "fault": {"kind": "rotor_loss", "rotor": 3, "size": 0.5, "phase": "carry"}}
    ),
)


def test_text_and_back() -> None:
    text = text_of(MESSAGES)
    assert text.count("\n") == 3
    assert messages_of(text, "here") == MESSAGES
    assert messages_of("\n" + text + "\n\n", "here") == MESSAGES
    assert messages_of("", "here") == ()


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ('{"do": "hold"', "here: line 1"),
        ('{"do": "hold"}\n{"do": "jump"}', "here: line 2: do"),
        ('{"do": "hold", "tick": 5}\n{"do": "hold", "tick": 4}', "tick 4 comes after tick 5"),
        ("[]", "line 1"),
    ],
)
def test_what_is_none_is_refused_with_its_line(text: str, complaint: str) -> None:
    with pytest.raises(LogError, match=complaint):
        messages_of(text, "here")


def test_more_than_an_operator_gives_is_refused(monkeypatch) -> None:
    monkeypatch.setattr(script, "MOST_MESSAGES", 2)
    with pytest.raises(LogError, match="3 messages; an operator gives 2 at most"):
        messages_of(text_of(MESSAGES), "here")


def test_a_log_without_script_has_no_messages() -> None:
    assert script_of({}) == ()
    assert script_of({SCRIPT_NAME: text_of(MESSAGES).encode()}) == MESSAGES
    with pytest.raises(LogError, match="no text"):
        script_of({SCRIPT_NAME: b"\xff\xfe"})


def test_files_and_logs_are_read(tmp_path) -> None:
    file, log = tmp_path / "mine.jsonl", tmp_path / "run.mcap"
    file.write_text(text_of(MESSAGES))
    assert read_script(file) == MESSAGES
    with Recorder(log, 7, 1_000_000) as recorder:
        recorder.rows(1)[:] = 0
        recorder.add(1)
        recorder.attach(SCRIPT_NAME, text_of(MESSAGES[:1]))
        recorder.attach(SCRIPT_NAME, text_of(MESSAGES))
    assert read_script(log) == MESSAGES


def test_files_that_cannot_be_read_are_refused(tmp_path, monkeypatch) -> None:
    with pytest.raises(LogError, match="cannot read the operator's script"):
        read_script(tmp_path / "none.jsonl")
    with pytest.raises(LogError, match="cannot read the run log"):
        read_script(tmp_path / "none.mcap")
    (tmp_path / "binary.jsonl").write_bytes(b"\xff\xff")
    with pytest.raises(LogError, match="cannot read"):
        read_script(tmp_path / "binary.jsonl")
    monkeypatch.setattr(script, "LARGEST", 3)
    (tmp_path / "long.jsonl").write_text("{}" * 10)
    with pytest.raises(LogError, match="20 bytes are no script"):
        read_script(tmp_path / "long.jsonl")


def test_first_difference() -> None:
    ticks = np.zeros(5, tick_layout(7))
    assert first_difference(ticks, ticks.copy()) is None
    other = ticks.copy()
    other["truth"]["r"][3, 1] = 1e-300
    assert first_difference(ticks, other) == 3
    assert first_difference(ticks, ticks[:4]) == 4
    assert first_difference(ticks, np.zeros(5, tick_layout(6))) == 0
    # Bits count, not numbers: what is not a number equals itself.
    ticks["proof"]["v2"] = np.nan
    assert first_difference(ticks, ticks.copy()) is None
