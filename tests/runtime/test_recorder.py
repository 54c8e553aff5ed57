import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from armland import __version__
from armland.errors import LogError
from armland.records import MESSAGES, tick_layout
from armland.runtime.log import read_log
from armland.runtime.recorder import Recorder

PERIOD = 1_000_000


@pytest.mark.parametrize("count", [1, 3, 4, 5, 8, 11])
def test_file_and_memory_hold_every_tick(tmp_path: Path, record, count: int) -> None:
    ticks = record(tmp_path / "run.mcap", count)
    assert ticks.dtype == tick_layout(7)
    assert ticks["health"]["tick"].tolist() == list(range(count))
    log = read_log(tmp_path / "run.mcap")
    assert log.complete
    assert set(log.messages) == set(MESSAGES)
    for name in MESSAGES:
        assert log.messages[name].tobytes() == ticks[name].tobytes()


def test_rows_lent_end_with_the_block() -> None:
    with Recorder(None, 7, PERIOD, block=4) as recorder:
        assert len(recorder.rows(3)) == 3
        recorder.add(3)
        assert len(recorder.rows(3)) == 1
        recorder.add(1)
        assert len(recorder.rows(3)) == 3
        recorder.add(0)
        assert len(recorder.ticks) == 4


def test_rows_of_a_full_block_are_the_ticks_and_not_lent_again() -> None:
    with Recorder(None, 7, PERIOD, block=4) as recorder:
        for number in range(10):
            recorder.rows(1)["command"]["tau"] = number
            recorder.add(1)
            assert len(recorder.ticks) == number + 1
        recorder.rows(1)["command"]["tau"] = -1
    assert recorder.ticks["command"]["tau"][:, 6].tolist() == list(range(10))


def test_equal_runs_give_equal_files(tmp_path: Path, record) -> None:
    (tmp_path / "elsewhere").mkdir()
    paths = [tmp_path / "run.mcap", tmp_path / "elsewhere" / "other.mcap"]
    for path, metadata in zip(paths, [{"seed": "1", "wind": "2"}, {"wind": "2", "seed": "1"}], strict=True):
        record(path, 11, metadata=metadata, scenario="a = 1")
    assert paths[0].read_bytes() == paths[1].read_bytes()
    record(paths[1], 11, metadata={"seed": "2", "wind": "2"}, scenario="a = 1")
    assert paths[0].read_bytes() != paths[1].read_bytes()


def test_metadata_and_scenario_are_in_the_file(tmp_path: Path, record) -> None:
    record(tmp_path / "run.mcap", 1, metadata={"seed": "3"}, scenario="wind = 4  # m/s, from Südwest\n")
    log = read_log(tmp_path / "run.mcap")
    own = {"version": __version__, "joints": "7", "period_ns": str(PERIOD)}
    assert log.metadata == {"seed": "3", **own}
    assert log.attachments == {"scenario.toml": "wind = 4  # m/s, from Südwest\n".encode()}
    with (tmp_path / "run.mcap").open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert [a.name for a in reader.iter_attachments()] == ["scenario.toml"]
        assert [m.metadata["seed"] for m in reader.iter_metadata()] == ["3"]


def test_empty_run_is_a_valid_file(tmp_path: Path, record) -> None:
    ticks = record(tmp_path / "run.mcap", 0)
    assert ticks.shape == (0,)
    with (tmp_path / "run.mcap").open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert list(reader.iter_messages()) == []
        assert reader.get_summary().statistics.message_count == 0
    log = read_log(tmp_path / "run.mcap")
    assert log.complete
    assert {name: len(log.messages[name]) for name in MESSAGES} == dict.fromkeys(MESSAGES, 0)


def test_run_that_raises_is_readable_to_the_last_tick(tmp_path: Path, fill_tick) -> None:
    def fly() -> None:
        with Recorder(tmp_path / "run.mcap", 7, PERIOD, block=4) as recorder:
            for number in range(100):
                if number == 7:
                    raise ZeroDivisionError("the law broke")
                fill_tick(recorder.rows(1), number)
                recorder.add(1)

    with pytest.raises(ZeroDivisionError, match="the law broke"):
        fly()
    log = read_log(tmp_path / "run.mcap")
    assert log.messages["command"]["tick"].tolist() == list(range(7))
    assert log.complete


def test_killed_process_leaves_all_full_blocks(tmp_path: Path) -> None:
    code = """
import os, sys
from armland.runtime.recorder import Recorder
recorder = Recorder(sys.argv[1], 7, 1_000_000, block=4)
for number in range(11):
    recorder.rows(1)["measurement"]["tick"] = number
    recorder.add(1)
os._exit(9)
"""
    process = subprocess.run([sys.executable, "-c", code, tmp_path / "run.mcap"], check=False, timeout=60)
    assert process.returncode == 9
    log = read_log(tmp_path / "run.mcap.part")
    assert log.messages["measurement"]["tick"].tolist() == list(range(8))
    assert not log.complete


def test_folder_that_does_not_exist_is_named(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"cannot create the run log .*run\.mcap.*create the folder .*missing first"):
        Recorder(tmp_path / "missing" / "run.mcap", 7, PERIOD)
    with pytest.raises(LogError, match="name a file in a folder that can be written"):
        Recorder(tmp_path, 7, PERIOD)


def test_metadata_of_the_recorder_cannot_be_replaced(tmp_path: Path) -> None:
    for key, value in (("joints", "6"), ("version", "9")):
        with pytest.raises(LogError, match=rf"\['{key}'\] are set by the recorder"):
            Recorder(tmp_path / "run.mcap", 7, PERIOD, {key: value})
    assert not (tmp_path / "run.mcap").exists()


class _FullDisk:
    """A file on a disk with room for half a block more."""

    def __init__(self, file, room: int) -> None:
        self._file, self._room = file, room

    def write(self, data: memoryview) -> int:
        if not self._room:
            raise OSError(28, "No space left on device")
        written = self._file.write(data[: self._room])
        self._room -= written
        return written

    def __getattr__(self, name: str) -> object:
        return getattr(self._file, name)


def test_disk_that_fills_up_ends_no_flight_and_leaves_all_full_blocks(tmp_path: Path, record, fill_tick) -> None:
    record(tmp_path / "run.mcap", 3)
    earlier = (tmp_path / "run.mcap").read_bytes()
    with Recorder(tmp_path / "run.mcap", 7, PERIOD, block=4, keep_in_memory=True) as recorder:
        for number in range(30):
            if number == 4:
                recorder._file._file = _FullDisk(recorder._file._file, room=3000)
            fill_tick(recorder.rows(1), number)
            recorder.add(1)
            assert (recorder.failure is not None) == (number >= 7)
    assert "No space left on device; run.mcap.part holds the first 4 ticks" in str(recorder.failure)
    assert recorder.ticks["truth"]["tick"].tolist() == list(range(30))
    assert (tmp_path / "run.mcap").read_bytes() == earlier
    log = read_log(tmp_path / "run.mcap.part")
    assert (len(log.messages["truth"]), log.complete) == (4, False)


def test_disk_that_is_full_at_the_end_is_told(tmp_path: Path) -> None:
    with Recorder(tmp_path / "run.mcap", 7, PERIOD, block=4, keep_in_memory=True) as recorder:
        recorder.rows(1)
        recorder.add(1)
        recorder._file._file = _FullDisk(recorder._file._file, room=0)
    assert "No space left on device; no tick of it is kept" in str(recorder.failure)
    assert len(recorder.ticks) == 1
    assert [*tmp_path.iterdir()] == []


class _Piecewise:
    """A file that takes a thousand bytes at a time."""

    def __init__(self, file) -> None:
        self._file = file

    def write(self, data: memoryview) -> int:
        return self._file.write(data[:1000])

    def __getattr__(self, name: str) -> object:
        return getattr(self._file, name)


def test_write_in_small_pieces_is_continued(tmp_path: Path, record, fill_tick) -> None:
    with Recorder(tmp_path / "run.mcap", 7, PERIOD, block=4) as recorder:
        recorder._file._file = _Piecewise(recorder._file._file)
        for number in range(7):
            fill_tick(recorder.rows(1), number)
            recorder.add(1)
    record(tmp_path / "undisturbed.mcap", 7)
    assert (tmp_path / "run.mcap").read_bytes() == (tmp_path / "undisturbed.mcap").read_bytes()


class _InterruptedOnce:
    """A file in whose second write the user presses Ctrl-C."""

    def __init__(self, file) -> None:
        self._file, self._writes = file, 0

    def write(self, data: memoryview) -> int:
        self._writes += 1
        if self._writes == 2:
            self._file.write(data[:100])
            raise KeyboardInterrupt
        return self._file.write(data)

    def __getattr__(self, name: str) -> object:
        return getattr(self._file, name)


def test_interrupted_write_is_repeated(tmp_path: Path, record, fill_tick) -> None:
    def fly() -> None:
        with Recorder(tmp_path / "run.mcap", 7, PERIOD, block=4) as recorder:
            recorder._file._file = _InterruptedOnce(recorder._file._file)
            for number in range(100):
                fill_tick(recorder.rows(1), number)
                recorder.add(1)

    with pytest.raises(KeyboardInterrupt):
        fly()
    record(tmp_path / "undisturbed.mcap", 4)
    assert (tmp_path / "run.mcap").read_bytes() == (tmp_path / "undisturbed.mcap").read_bytes()


def test_full_disk_does_not_hide_why_the_run_broke(tmp_path: Path) -> None:
    def fly() -> None:
        with Recorder(tmp_path / "run.mcap", 7, PERIOD, block=4) as recorder:
            recorder.rows(1)
            recorder.add(1)
            recorder._file._file = _FullDisk(recorder._file._file, room=0)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError) as caught:
        fly()
    assert ["No space left" in note for note in caught.value.__notes__] == [True]


def test_second_close_does_nothing(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "run.mcap", 7, PERIOD, keep_in_memory=True)
    recorder.add(1)
    recorder.close()
    written = (tmp_path / "run.mcap").read_bytes()
    recorder.close()
    assert (tmp_path / "run.mcap").read_bytes() == written
    assert len(recorder.ticks) == 1


def test_ticks_that_were_not_kept_are_refused(tmp_path: Path) -> None:
    with Recorder(tmp_path / "run.mcap", 7, PERIOD) as recorder:
        recorder.add(1)
        with pytest.raises(LogError, match="keep_in_memory"):
            _ = recorder.ticks


def test_time_follows_the_tick_of_the_measurement(tmp_path: Path) -> None:
    with Recorder(tmp_path / "run.mcap", 7, 2_500_000) as recorder:
        for number in (1000, 1001):
            recorder.rows(1)["measurement"]["tick"] = number
            recorder.add(1)
    with (tmp_path / "run.mcap").open("rb") as stream:
        times = {m.log_time for _, _, m in make_reader(stream).iter_messages()}
    assert times == {2_500_000_000, 2_502_500_000}
    np.testing.assert_allclose(read_log(tmp_path / "run.mcap").time, [2.5, 2.5025], rtol=1e-15)
