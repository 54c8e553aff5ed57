"""`armland report`: from a whole log, a part of one, a foreign one, one of another version, without OpenGL."""

import json
from pathlib import Path

import pytest

from armland.runtime.log import read_log
from armland.runtime.log.file import McapFile
from armland.runtime.recorder import Recorder


@pytest.fixture
def log(landed) -> Path:
    return Path(landed.log)


@pytest.fixture(autouse=True)
def no_opengl(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "disable")


def rewritten(log: Path, path: Path, **metadata: str) -> Path:
    """The first second of a log with other metadata."""
    found = read_log(log)
    told = {k: v for k, v in found.metadata.items() if k not in ("version", "joints", "period_ns")} | metadata
    with Recorder(path, 7, int(found.metadata["period_ns"]), told) as recorder:
        for first in range(0, 1000, 500):
            rows = recorder.rows(500)
            rows[:] = found.ticks[first : first + 500]
            recorder.add(500)
    return path


def test_report_is_a_page_and_says_that_there_are_no_pictures(armland, log, tmp_path, landed) -> None:
    done = armland("report", str(log), "--out", "out")
    assert done.code == 0, done.err
    assert done.err == ""
    page = (tmp_path / "out" / "report.html").read_text()
    assert "There is no film strip: no OpenGL" in page
    assert "armland land --seed 1" in page
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["touchdown"] == landed.result["touchdown"]


def test_former_page_goes_with_the_former_result(armland, log, tmp_path) -> None:
    (tmp_path / "out").mkdir()
    for name in ("report.html", "notes.html"):
        (tmp_path / "out" / name).write_text("old")
    assert armland("report", str(log), "--out", "out", "--no-figures").code == 0
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["notes.html", "result.json"]


@pytest.mark.slow
def test_log_that_was_cut_off_is_shown_as_far_as_it_goes(armland, log, tmp_path) -> None:
    (tmp_path / "cut.mcap").write_bytes(log.read_bytes()[: log.stat().st_size // 2])
    done = armland("report", "cut.mcap", "--out", "out")
    assert done.code == 1
    page = (tmp_path / "out" / "report.html").read_text()
    assert "still in phase" in page
    assert "when the time was over" in page


def test_log_of_another_version_gives_what_it_can(armland, log, tmp_path) -> None:
    rewritten(log, tmp_path / "old.mcap", scenario='{"title": 7}')
    done = armland("report", "old.mcap", "--out", "out")
    assert done.code == 1
    assert "armland: no report: this version does not know the log's scenario" in done.err
    assert "result.json" in [p.name for p in (tmp_path / "out").iterdir()]
    assert not (tmp_path / "out" / "report.html").exists()


@pytest.mark.parametrize(
    ("content", "says"),
    [(b"", "not an MCAP file"), (b"x" * 1000, "not an MCAP file"), (None, "cannot read the run log")],
)
def test_foreign_log_is_one_message_and_writes_nothing(armland, tmp_path, content, says) -> None:
    if content is not None:
        (tmp_path / "foreign.mcap").write_bytes(content)
    before = sorted(tmp_path.iterdir())
    done = armland("report", "foreign.mcap", "--out", "out")
    assert (done.code, done.out) == (2, "")
    assert says in done.err
    assert sorted(tmp_path.iterdir()) == before


def test_log_without_a_tick_is_refused(armland, log, tmp_path) -> None:
    found = read_log(log)
    file = McapFile(tmp_path / "empty.mcap", 7, found.metadata, {})
    file.finish()
    file.close()
    (tmp_path / "empty.mcap.part").unlink(missing_ok=True)
    done = armland("report", "empty.mcap", "--out", "out")
    assert done.code == 2
    assert not (tmp_path / "out").exists()


def test_folder_that_cannot_be_written_is_refused(armland, log) -> None:
    done = armland("report", str(log), "--out", "/proc/armland")
    assert done.code == 2
    assert "cannot be made a folder to write to" in done.err
