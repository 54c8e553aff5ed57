import io
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from armland.errors import LogError
from armland.mission.records import LANDING_MESSAGES, LandingTick
from armland.records import MESSAGES
from armland.runtime.log import read_log


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "run.mcap"


def rewritten(data: bytes, drop: str = "", metadata: dict[str, str | None] | None = None, **options) -> bytes:
    """The same run as another tool writes it: other chunks, compressed, schemas inside the chunks."""
    reader, stream = make_reader(io.BytesIO(data)), io.BytesIO()
    writer = Writer(stream, **options)
    writer.start()
    for record in reader.iter_metadata():
        changed = record.metadata | (metadata or {})
        writer.add_metadata(record.name, {k: v for k, v in changed.items() if v is not None})
    summary = reader.get_summary()
    for schema in summary.schemas.values():
        writer.register_schema(schema.name, schema.encoding, schema.data)
    channels = {}
    for channel in reversed(summary.channels.values()):
        if channel.topic != drop:
            channels[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, channel.schema_id)
    for _, channel, m in reader.iter_messages(topics=[c.topic for c in summary.channels.values() if c.id in channels]):
        writer.add_message(channels[channel.id], m.log_time, m.data, m.publish_time, m.sequence)
    writer.finish()
    return stream.getvalue()


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


def test_file_cut_in_its_head_is_refused(path: Path, record) -> None:
    record(path, 4)
    data = path.read_bytes()
    first = make_reader(io.BytesIO(data)).get_summary().chunk_indexes[0].chunk_start_offset
    for cut in [0, 4, 8, 20, *range(30, first, 101)]:
        path.write_bytes(data[:cut])
        with pytest.raises(LogError, match=r"not an MCAP file|cut off too early|has no messages on"):
            read_log(path)


@pytest.mark.parametrize("compression", CompressionType)
@pytest.mark.parametrize("chunk_size", [3000, 1_000_000])
def test_log_that_another_tool_rewrote_is_the_same(path: Path, record, compression, chunk_size: int) -> None:
    ticks = record(path, 11)
    path.write_bytes(rewritten(path.read_bytes(), compression=compression, chunk_size=chunk_size))
    log = read_log(path)
    assert log.complete
    for name in MESSAGES:
        assert log.messages[name].tobytes() == ticks[name].tobytes()


def test_landing_log_that_another_tool_rewrote_is_the_same(path: Path, record) -> None:
    ticks = record(path, 11, kind=LandingTick)
    path.write_bytes(rewritten(path.read_bytes(), compression=CompressionType.ZSTD, chunk_size=3000))
    log = read_log(path)
    assert log.kind == "landing"
    for name in LANDING_MESSAGES:
        assert log.messages[name].tobytes() == ticks[name].tobytes()


def test_log_that_does_not_say_its_kind_is_the_paper_s(path: Path, record) -> None:
    ticks = record(path, 5)
    path.write_bytes(rewritten(path.read_bytes(), metadata={"kind": None}))
    log = read_log(path)
    assert "kind" not in log.metadata
    assert log.kind == "paper"
    assert log.messages["proof"].tobytes() == ticks["proof"].tobytes()


def test_log_of_an_unknown_kind_is_refused(path: Path, record) -> None:
    record(path, 3)
    path.write_bytes(rewritten(path.read_bytes(), metadata={"kind": "deck", "version": "9.1"}))
    with pytest.raises(LogError, match=r"kind 'deck'; this version reads paper, landing; read it with armland 9\.1"):
        read_log(path)


def test_log_of_the_wrong_kind_is_refused(path: Path, record) -> None:
    record(path, 3, kind=LandingTick)
    path.write_bytes(rewritten(path.read_bytes(), metadata={"kind": "paper"}))
    with pytest.raises(LogError, match=r"another layout of 'measurement': it has 'int64 arm_tick' where"):
        read_log(path)


def test_names_that_the_metadata_lists(path: Path, record) -> None:
    record(path, 1, metadata={"phases": "self_test,guide,done"})
    log = read_log(path)
    assert log.names("phases") == ("self_test", "guide", "done")
    with pytest.raises(LogError, match=r"names no 'faults'; its metadata has joints, kind, period_ns, phases, version"):
        log.names("faults")


def test_messages_outside_of_chunks_are_not_overlooked(path: Path, record) -> None:
    record(path, 3)
    path.write_bytes(rewritten(path.read_bytes(), use_chunking=False))
    with pytest.raises(LogError, match="outside of chunks"):
        read_log(path)


def test_missing_topic_is_named(path: Path, record) -> None:
    record(path, 3)
    path.write_bytes(rewritten(path.read_bytes(), drop="/armland/health"))
    with pytest.raises(LogError, match=r"no messages on /armland/health; it has \['/armland/command'"):
        read_log(path)


def test_log_of_another_layout_is_refused(path: Path, record) -> None:
    record(path, 3)
    path.write_bytes(path.read_bytes().replace(b"float64[6] wrench", b"float64[5] wrench"))
    with pytest.raises(LogError, match=r"run\.mcap: .*'measurement'.*'float64\[5\] wrench'.*'float64\[6\] wrench'"):
        read_log(path)


def test_log_with_other_comments_is_accepted(path: Path, record) -> None:
    record(path, 3)
    path.write_bytes(path.read_bytes().replace(b"# joint positions", b"# JOINT POSITIONS"))
    assert len(read_log(path).messages["truth"]) == 3


@pytest.mark.parametrize("compression", [CompressionType.NONE, CompressionType.ZSTD])
def test_damaged_chunk_is_an_error(path: Path, record, compression) -> None:
    record(path, 11)
    data = path.read_bytes()
    if compression != CompressionType.NONE:
        data = rewritten(data, compression=compression)
    index = make_reader(io.BytesIO(data)).get_summary().chunk_indexes[0]
    damaged = bytearray(data)
    damaged[index.chunk_start_offset + 60] ^= 1
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
