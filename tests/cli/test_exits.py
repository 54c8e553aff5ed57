"""Whatever ends a command is one message and an exit code."""

import errno
import os
import signal
import time

import pytest

from armland.cli.exits import Judged, attempted, run_guarded
from armland.errors import ConfigurationError, LogError, ModelError, PictureError, PlantError, WorkspaceError

ENDS = [
    (Judged(True), 0, ""),
    (Judged(False), 1, ""),
    (ConfigurationError("no such key"), 2, "armland: no such key\n"),
    (ModelError("no frame"), 2, "armland: no frame\n"),
    (WorkspaceError("too far"), 2, "armland: too far\n"),
    (LogError("no log"), 2, "armland: no log\n"),
    (PlantError("not finite"), 3, "armland: not finite\n"),
    (PictureError("no OpenGL"), 3, "armland: no OpenGL\n"),
    (OSError(errno.ENOSPC, "No space left on device", "out/x"), 3, "armland: out/x: No space left on device\n"),
    (MemoryError(), 3, "armland: there is not enough memory\n"),
    (KeyboardInterrupt(), 130, "armland: stopped\n"),
    (SystemExit(130), 130, "armland: stopped\n"),
    (SystemExit(None), 0, ""),
]


@pytest.mark.parametrize(("end", "code", "said"), ENDS)
def test_each_end_has_its_code_and_words(end: BaseException, code: int, said: str, capsys) -> None:
    def command() -> None:
        raise end

    assert run_guarded(command) == code
    assert capsys.readouterr().err == said


def test_unexpected_error_is_one_line_and_its_details_go_where_the_user_says(tmp_path, monkeypatch, capsys) -> None:
    def command() -> None:
        raise TypeError("a\nb")

    assert run_guarded(command) == 3
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "TypeError: a" in said
    assert "Traceback" not in said
    assert list(tmp_path.iterdir()) == []
    monkeypatch.setenv("ARMLAND_TRACEBACK", str(tmp_path / "trace.txt"))
    assert run_guarded(command) == 3
    assert "TypeError: a" in (tmp_path / "trace.txt").read_text()


@pytest.mark.parametrize(("end", "code"), [(None, 3), (Judged(True), 0), (Judged(False), 1)])
def test_lost_output_is_an_error_only_where_there_is_nothing_else(end, code, capsys, monkeypatch) -> None:
    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    def command() -> None:
        import sys

        monkeypatch.setattr(sys.stdout._stream, "write", full)
        print("the result")
        if end is not None:
            raise end

    assert run_guarded(command) == code
    assert capsys.readouterr().err == "armland: standard output cannot be written: No space left on device\n"


def test_what_a_result_can_be_without_does_not_end_it(capsys) -> None:
    with attempted("figures"):
        raise PictureError("no OpenGL")
    with pytest.raises(KeyboardInterrupt), attempted("figures"):
        raise KeyboardInterrupt
    assert capsys.readouterr().err == "armland: no figures: no OpenGL\n"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupt_that_was_swallowed_still_counts(number, capsys) -> None:
    def command() -> None:
        try:
            os.kill(os.getpid(), number)
            time.sleep(1.0)
        except KeyboardInterrupt:
            raise RuntimeError("half compiled") from None

    before = signal.getsignal(number)
    assert run_guarded(command) == 130
    assert capsys.readouterr().err == "armland: stopped\n"
    assert signal.getsignal(number) is before
