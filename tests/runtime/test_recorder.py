import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from armland import __version__
from armland.errors import LogError
from armland.mission.records import LandingTick
from armland.records import MESSAGES, AnyTick, Tick
from armland.runtime.log import read_log
from armland.runtime.recorder import Recorder

PERIOD = 1_000_000


@pytest.mark.parametrize("kind", [Tick, LandingTick])
@pytest.mark.parametrize("count", [1, 3, 4, 5, 8, 11])
def test_file_and_memory_hold_every_tick(tmp_path: Path, record, count: int, kind: type[AnyTick]) -> None:
    ticks = record(tmp_path / "run.mcap", count, kind=kind)
    assert ticks.dtype == kind.table.tick_layout(7)
    assert ticks["health"]["tick"].tolist() == list(range(count))
    log = read_log(tmp_path / "run.mcap")
    assert log.complete
    assert log.kind == kind.table.kind
    assert set(log.messages) == set(kind.table.messages)
    for name in kind.table.messages:
        assert log.messages[name].tobytes() == ticks[name].tobytes()


def test_recorded_tick_is_a_copy() -> None:
    tick = Tick(7)
    with Recorder(None, tick, PERIOD, block=4) as recorder:
        for number in range(10):
            tick.command["tau"] = number
            recorder.append()
            assert len(recorder.ticks) == number + 1
        tick.command["tau"] = -1
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
    own = {"kind": "paper", "version": __version__, "joints": "7", "period_ns": str(PERIOD)}
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
    tick = Tick(7)

    def fly() -> None:
        with Recorder(tmp_path / "run.mcap", tick, PERIOD, block=4) as recorder:
            for number in range(100):
                if number == 7:
                    raise ZeroDivisionError("the law broke")
                fill_tick(tick, number)
                recorder.append()

    with pytest.raises(ZeroDivisionError, match="the law broke"):
        fly()
    log = read_log(tmp_path / "run.mcap")
    assert log.messages["command"]["tick"].tolist() == list(range(7))
    assert log.complete


def test_killed_process_leaves_all_full_blocks(tmp_path: Path) -> None:
    code = """
import os, sys
from armland.records import Tick
from armland.runtime.recorder import Recorder
tick = Tick(7)
recorder = Recorder(sys.argv[1], tick, 1_000_000, block=4)
for number in range(11):
    tick.measurement["tick"] = number
    recorder.append()
os._exit(9)
"""
    process = subprocess.run([sys.executable, "-c", code, tmp_path / "run.mcap"], check=False, timeout=60)
    assert process.returncode == 9
    log = read_log(tmp_path / "run.mcap")
    assert log.messages["measurement"]["tick"].tolist() == list(range(8))
    assert not log.complete


def test_folder_that_does_not_exist_is_named(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"cannot create the run log .*run\.mcap.*create the folder .*missing first"):
        Recorder(tmp_path / "missing" / "run.mcap", Tick(7), PERIOD)
    with pytest.raises(LogError, match="name a file in a folder that can be written"):
        Recorder(tmp_path, Tick(7), PERIOD)


def test_metadata_of_the_recorder_cannot_be_replaced(tmp_path: Path) -> None:
    for key, value in (("joints", "6"), ("kind", "landing")):
        with pytest.raises(LogError, match=rf"\['{key}'\] are set by the recorder"):
            Recorder(tmp_path / "run.mcap", Tick(7), PERIOD, {key: value})
    assert not (tmp_path / "run.mcap").exists()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")
def test_full_disk_at_the_start_is_an_error() -> None:
    with pytest.raises(LogError, match="No space left on device; it holds the first 0 ticks"):
        Recorder("/dev/full", Tick(7), PERIOD)


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


def test_disk_that_fills_up_leaves_all_full_blocks(tmp_path: Path, fill_tick) -> None:
    tick = Tick(7)
    recorder = Recorder(tmp_path / "run.mcap", tick, PERIOD, block=4, keep_in_memory=True)

    def fly() -> None:
        with recorder:
            for number in range(100):
                if number == 4:
                    recorder._file._file = _FullDisk(recorder._file._file, room=3000)
                fill_tick(tick, number)
                recorder.append()

    with pytest.raises(LogError, match="No space left on device; it holds the first 4 ticks") as caught:
        fly()
    assert not hasattr(caught.value, "__notes__")
    assert len(recorder.ticks) == 8
    log = read_log(tmp_path / "run.mcap")
    assert (len(log.messages["truth"]), log.complete) == (4, False)


class _Piecewise:
    """A file that takes a thousand bytes at a time."""

    def __init__(self, file) -> None:
        self._file = file

    def write(self, data: memoryview) -> int:
        return self._file.write(data[:1000])

    def __getattr__(self, name: str) -> object:
        return getattr(self._file, name)


def test_write_in_small_pieces_is_continued(tmp_path: Path, record, fill_tick) -> None:
    tick = Tick(7)
    with Recorder(tmp_path / "run.mcap", tick, PERIOD, block=4) as recorder:
        recorder._file._file = _Piecewise(recorder._file._file)
        for number in range(7):
            fill_tick(tick, number)
            recorder.append()
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
    tick = Tick(7)

    def fly() -> None:
        with Recorder(tmp_path / "run.mcap", tick, PERIOD, block=4) as recorder:
            recorder._file._file = _InterruptedOnce(recorder._file._file)
            for number in range(100):
                fill_tick(tick, number)
                recorder.append()

    with pytest.raises(KeyboardInterrupt):
        fly()
    record(tmp_path / "undisturbed.mcap", 4)
    assert (tmp_path / "run.mcap").read_bytes() == (tmp_path / "undisturbed.mcap").read_bytes()


def test_full_disk_does_not_hide_why_the_run_broke(tmp_path: Path) -> None:
    tick = Tick(7)

    def fly() -> None:
        with Recorder(tmp_path / "run.mcap", tick, PERIOD, block=4) as recorder:
            recorder.append()
            recorder._file._file = _FullDisk(recorder._file._file, room=0)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError) as caught:
        fly()
    assert ["No space left" in note for note in caught.value.__notes__] == [True]


@pytest.mark.parametrize("in_memory", [True, False])
def test_closed_recorder_refuses_ticks(tmp_path: Path, in_memory: bool) -> None:
    recorder = Recorder(None if in_memory else tmp_path / "run.mcap", Tick(7), PERIOD, keep_in_memory=True)
    recorder.append()
    recorder.close()
    recorder.close()
    with pytest.raises(LogError, match="closed"):
        recorder.append()
    assert len(recorder.ticks) == 1


def test_ticks_that_were_not_kept_are_refused(tmp_path: Path) -> None:
    with Recorder(tmp_path / "run.mcap", Tick(7), PERIOD) as recorder:
        recorder.append()
        with pytest.raises(LogError, match="keep_in_memory"):
            _ = recorder.ticks


def test_time_follows_the_tick_of_the_measurement(tmp_path: Path) -> None:
    tick = Tick(7)
    with Recorder(tmp_path / "run.mcap", tick, 2_500_000) as recorder:
        for number in (1000, 1001):
            tick.measurement["tick"] = number
            recorder.append()
    with (tmp_path / "run.mcap").open("rb") as stream:
        times = {m.log_time for _, _, m in make_reader(stream).iter_messages()}
    assert times == {2_500_000_000, 2_502_500_000}
    np.testing.assert_allclose(read_log(tmp_path / "run.mcap").time, [2.5, 2.5025], rtol=1e-15)
