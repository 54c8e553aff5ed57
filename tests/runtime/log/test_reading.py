import io
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from armland.errors import LogError
from armland.records import MESSAGES
from armland.runtime.log import read_log


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "run.mcap"


def test_truncated_file_gives_all_blocks_that_are_whole(path: Path, record) -> None:
    ticks = record(path, 11)
    data = path.read_bytes()
    summary = make_reader(io.BytesIO(data)).get_summary()
    ends = [index.chunk_start_offset + index.chunk_length for index in summary.chunk_indexes]
    first = summary.chunk_indexes[0].chunk_start_offset
    for cut in [*range(first, len(data), 97), *ends, *(end - 1 for end in ends), len(data) - 1]:
        path.write_bytes(data[:cut])
        log = read_log(path)
        whole = sum(min(4, 11 - 4 * i) for i, end in enumerate(ends) if end <= cut)
        assert not log.complete
        for name in MESSAGES:
            assert log.messages[name].tobytes() == ticks[name][:whole].tobytes()


def test_file_cut_in_its_head_has_no_ticks_or_is_refused(path: Path, record) -> None:
    record(path, 4)
    data = path.read_bytes()
    first = make_reader(io.BytesIO(data)).get_summary().chunk_indexes[0].chunk_start_offset
    for cut in [0, 4, 8, 20, *range(30, first // 2, 101)]:
        path.write_bytes(data[:cut])
        with pytest.raises(LogError, match=r"not an MCAP file|cut off too early|has no messages on"):
            read_log(path)
    path.write_bytes(data[:first])
    assert (len(read_log(path).ticks), read_log(path).complete) == (0, False)


@pytest.mark.parametrize("compression", CompressionType)
@pytest.mark.parametrize("chunk_size", [3000, 1_000_000])
def test_log_that_another_tool_rewrote_is_the_same(path: Path, record, compression, chunk_size: int, rewritten) -> None:
    ticks = record(path, 11)
    path.write_bytes(rewritten(path.read_bytes(), compression=compression, chunk_size=chunk_size))
    log = read_log(path)
    assert log.complete
    for name in MESSAGES:
        assert log.messages[name].tobytes() == ticks[name].tobytes()


def test_names_that_the_metadata_lists(path: Path, record) -> None:
    record(path, 1, metadata={"phases": "self_test,guide,done"})
    log = read_log(path)
    assert log.names("phases") == ("self_test", "guide", "done")
    with pytest.raises(LogError, match=r"names no 'faults'; its metadata has joints, period_ns, phases, version"):
        log.names("faults")


def test_messages_outside_of_chunks_are_not_overlooked(path: Path, record, rewritten) -> None:
    record(path, 3)
    path.write_bytes(rewritten(path.read_bytes(), use_chunking=False))
    with pytest.raises(LogError, match="outside of chunks"):
        read_log(path)


def test_missing_topic_is_named(path: Path, record, rewritten) -> None:
    record(path, 3)
    path.write_bytes(rewritten(path.read_bytes(), drop="/armland/command"))
    with pytest.raises(LogError, match=r"no messages on /armland/command; it has /armland/estimate, "):
        read_log(path)


def test_message_that_an_older_version_had_not_is_not_a_number(path: Path, record, rewritten) -> None:
    ticks = record(path, 3)
    path.write_bytes(rewritten(path.read_bytes(), drop="/armland/proof"))
    log = read_log(path)
    assert np.isnan(log.messages["proof"]["v2"]).all()
    assert log.messages["truth"].tobytes() == ticks["truth"].tobytes()


def test_field_of_another_name_is_not_a_number(path: Path, record) -> None:
    ticks = record(path, 3)
    path.write_bytes(path.read_bytes().replace(b"float64[6] wrench ", b"float64[6] wretch "))
    log = read_log(path)
    assert np.isnan(log.messages["measurement"]["wrench"]).all()
    assert log.messages["measurement"]["q"].tobytes() == ticks["measurement"]["q"].tobytes()


def test_field_of_another_length_is_refused_with_the_version(path: Path, record, rewritten) -> None:
    record(path, 3)
    data = rewritten(path.read_bytes(), metadata={"version": "9.1"})
    path.write_bytes(
        data.replace(b"float64[4] camera_quat", b"float64[3] camera_quat").replace(
            b"float64[3] camera_position", b"float64[4] camera_position"
        )
    )
    with pytest.raises(
        LogError, match=r"run\.mcap: its field measurement\.camera_position has 4 numbers.*armland 9\.1"
    ):
        read_log(path)


def test_log_with_other_comments_is_accepted(path: Path, record) -> None:
    record(path, 3)
    path.write_bytes(path.read_bytes().replace(b"# joint positions", b"# JOINT POSITIONS"))
    assert len(read_log(path).messages["truth"]) == 3


@pytest.mark.parametrize(
    ("name", "value"), [("joints", "1000000000"), ("joints", "seven"), ("period_ns", "-1"), ("period_ns", "9" * 40)]
)
def test_metadata_that_ask_for_too_much_are_refused(path: Path, record, name: str, value: str, rewritten) -> None:
    record(path, 3)
    path.write_bytes(rewritten(path.read_bytes(), metadata={name: value}))
    with pytest.raises(LogError, match=f"its metadata says {name} = "):
        read_log(path)


def test_table_has_a_column_for_each_number(path: Path, record) -> None:
    ticks = record(path, 5)
    table = read_log(path).table()
    assert table["time"].tolist() == [0.0, 1e-3, 2e-3, 3e-3, 4e-3]
    assert table["truth.r.1"].tobytes() == ticks["truth"]["r"][:, 1].tobytes()
    assert {array.shape for array in table.values()} == {(5,)}
    assert len(table) == 1 + ticks.dtype.itemsize // 8


@pytest.mark.parametrize("compression", [CompressionType.NONE, CompressionType.ZSTD])
def test_damaged_chunk_is_an_error(path: Path, record, compression, rewritten) -> None:
    record(path, 11)
    data = path.read_bytes()
    if compression != CompressionType.NONE:
        data = rewritten(data, compression=compression)
    index = make_reader(io.BytesIO(data)).get_summary().chunk_indexes[0]
    damaged = bytearray(data)
    damaged[index.chunk_start_offset + 300] ^= 1
    path.write_bytes(damaged)
    with pytest.raises(LogError, match="damaged"):
        read_log(path)


def test_what_is_no_run_log_is_refused(path: Path) -> None:
    with pytest.raises(LogError, match="cannot read the run log"):
        read_log(path)
    path.write_bytes(b"tick,q\n0,1.5\n")
    with pytest.raises(LogError, match="not an MCAP file"):
        read_log(path)
    stream = io.BytesIO()
    writer = Writer(stream)
    writer.start()
    writer.finish()
    path.write_bytes(stream.getvalue())
    with pytest.raises(LogError, match="not armland's"):
        read_log(path)
