"""The file as others see it: the library's readers and an independent ROS 2 decoder."""

import io
import os
import zlib
from pathlib import Path

import numpy as np
import pytest
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.reader import NonSeekingReader, make_reader
from mcap.records import Chunk, Footer, Message, MessageIndex
from mcap.stream_reader import CRCValidationError, StreamReader, get_chunk_data_stream
from mcap_ros2.decoder import DecoderFactory
from mcap_ros2.writer import Writer as Ros2Writer

from armland.errors import LogError
from armland.records import MESSAGES, layout
from armland.runtime.log import read_log
from armland.runtime.log.schema import schema_name, schema_text, topic
from armland.runtime.recorder import Recorder

PERIOD = 1_000_000
TICKS = 11  # two blocks of four and a begun one


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "run.mcap"


def record_at(data: bytes, offset: int, opcode: Opcode) -> ReadDataStream:
    assert data[offset] == opcode
    return ReadDataStream(io.BytesIO(data[offset + 9 :]))


@pytest.mark.parametrize("reader", [make_reader, NonSeekingReader])
def test_library_reads_all_messages_in_time_order(path: Path, record, reader) -> None:
    ticks = record(path, TICKS)
    with path.open("rb") as stream:
        found = [(c.topic, s.name, m) for s, c, m in reader(stream, validate_crcs=True).iter_messages()]
    assert len(found) == TICKS * len(MESSAGES)
    for number in range(TICKS):
        of_tick = {t: (name, m) for t, name, m in found[number * len(MESSAGES) : (number + 1) * len(MESSAGES)]}
        for message in MESSAGES:
            name, m = of_tick[topic(message)]
            assert (name, m.sequence) == (schema_name(message), number)
            assert m.log_time == m.publish_time == number * PERIOD
            assert m.data == b"\0\1\0\0" + ticks[message][number].tobytes()


def test_library_seeks_by_topic_and_time(path: Path, record) -> None:
    record(path, TICKS)
    with path.open("rb") as stream:
        found = make_reader(stream, validate_crcs=True).iter_messages(
            topics="/armland/truth", starting_at=3 * PERIOD, ending_before=9 * PERIOD, reverse=True
        )
        assert [m.sequence for _, _, m in found] == [8, 7, 6, 5, 4, 3]


def test_message_indexes_point_at_the_messages(path: Path, record) -> None:
    record(path, TICKS)
    data = path.read_bytes()
    summary = make_reader(io.BytesIO(data)).get_summary()
    seen = 0
    for chunk_index in summary.chunk_indexes:
        chunk = Chunk.read(record_at(data, chunk_index.chunk_start_offset, Opcode.CHUNK))
        stream, size = get_chunk_data_stream(chunk, validate_crc=True)
        content = stream.read(size)
        assert set(chunk_index.message_index_offsets) == set(summary.channels)
        end = chunk_index.chunk_start_offset + chunk_index.chunk_length + chunk_index.message_index_length
        assert data[end] in (Opcode.CHUNK, Opcode.DATA_END)
        for channel, offset in chunk_index.message_index_offsets.items():
            index = MessageIndex.read(record_at(data, offset, Opcode.MESSAGE_INDEX))
            assert index.channel_id == channel
            for log_time, position in index.records:
                message = Message.read(record_at(content, position, Opcode.MESSAGE), 22 + 4)
                assert (message.channel_id, message.log_time) == (channel, log_time)
                assert chunk_index.message_start_time <= log_time <= chunk_index.message_end_time
                seen += 1
    assert seen == TICKS * len(MESSAGES)


def test_statistics_count_what_is_there(path: Path, record) -> None:
    record(path, TICKS, scenario="a = 1")
    with path.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    statistics = summary.statistics
    assert statistics.message_count == TICKS * len(MESSAGES)
    assert statistics.channel_message_counts == dict.fromkeys(summary.channels, TICKS)
    assert (statistics.message_start_time, statistics.message_end_time) == (0, (TICKS - 1) * PERIOD)
    assert (statistics.chunk_count, len(summary.chunk_indexes)) == (3, 3)
    assert (statistics.attachment_count, statistics.metadata_count) == (1, 1)
    assert statistics.schema_count == statistics.channel_count == len(MESSAGES)


def test_summary_offsets_and_checksum(path: Path, record) -> None:
    record(path, TICKS)
    data = path.read_bytes()
    footer = Footer.read(record_at(data, len(data) - 8 - 29, Opcode.FOOTER))
    assert zlib.crc32(data[footer.summary_start : len(data) - 8 - 4]) == footer.summary_crc
    offsets = [r for r in StreamReader(io.BytesIO(data)).records if type(r).__name__ == "SummaryOffset"]
    position = footer.summary_start
    for offset in offsets:
        assert (offset.group_start, data[position]) == (position, offset.group_opcode)
        position += offset.group_length
    assert position == footer.summary_offset_start


def test_damaged_chunk_is_noticed_by_the_library(path: Path, record) -> None:
    record(path, TICKS)
    data = bytearray(path.read_bytes())
    index = make_reader(io.BytesIO(bytes(data))).get_summary().chunk_indexes[1]
    data[index.chunk_start_offset + 200] ^= 1
    with pytest.raises(CRCValidationError):
        list(make_reader(io.BytesIO(bytes(data)), validate_crcs=True).iter_messages())


@pytest.mark.parametrize("joints", [1, 6, 7])
def test_independent_decoder_finds_the_same_bits(path: Path, record, joints: int) -> None:
    ticks = record(path, 3, joints=joints)
    decoded = 0
    with path.open("rb") as stream:
        for found in make_reader(stream, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
            name = found.channel.topic.removeprefix("/armland/")
            row = ticks[name][found.message.sequence]
            for field in layout(name, joints).names:
                value = getattr(found.decoded_message, field)
                assert np.array(value, row[field].dtype).tobytes() == row[field].tobytes(), f"{name}.{field}"
                decoded += 1
    assert decoded == 3 * sum(len(fields) for fields in MESSAGES.values())


@pytest.mark.parametrize("message", MESSAGES)
def test_independent_encoder_makes_the_same_bytes(message: str) -> None:
    """Alignment included: another writer's payload for these numbers is the encapsulation header and the record."""
    row = np.zeros(1, layout(message, 7))
    for number, field in enumerate(row.dtype.names, start=1):
        row[field] = number
    values = {field: row[field][0].tolist() for field in row.dtype.names}
    stream = io.BytesIO()
    writer = Ros2Writer(stream)
    schema = writer.register_msgdef(schema_name(message), schema_text(message, 7))
    writer.write_message(topic(message), schema, values, log_time=0, publish_time=0)
    writer.finish()
    stream.seek(0)
    ((_, _, found),) = make_reader(stream).iter_messages()
    assert found.data == b"\0\1\0\0" + row.tobytes()


def test_earlier_log_stays_until_the_new_one_is_whole(path: Path, record, fill_tick) -> None:
    record(path, TICKS)
    earlier = path.read_bytes()
    with Recorder(path, 7, PERIOD, block=4) as recorder:
        for number in range(9):
            fill_tick(recorder.rows(1), number)
            recorder.add(1)
        assert path.read_bytes() == earlier
        unfinished = read_log(path.with_name("run.mcap.part"))
        assert (len(unfinished.ticks), unfinished.complete) == (8, False)
    assert [p.name for p in path.parent.iterdir()] == ["run.mcap"]
    assert len(read_log(path).ticks) == 9


@pytest.mark.parametrize("linked", ["run.mcap", "run.mcap.part"])
def test_link_is_replaced_and_not_followed(path: Path, record, linked: str) -> None:
    precious = path.parent / "precious.txt"
    precious.write_text("keep me")
    (path.parent / linked).symlink_to(precious)
    record(path, TICKS)
    assert precious.read_text() == "keep me"
    assert not path.is_symlink()
    assert len(read_log(path).ticks) == TICKS


def test_what_is_no_file_is_refused(path: Path, record) -> None:
    os.mkfifo(path)
    with pytest.raises(LogError, match=r"cannot create the run log .*it is no file"):
        record(path, 1)
    assert [p.name for p in path.parent.iterdir()] == ["run.mcap"]
