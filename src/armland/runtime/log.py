"""Reading a run log back: every message as one structured array, whole or as far as a killed run got.

The recorder's own chunks are decoded in bulk. A log that another tool rewrote (`mcap compress`, `mcap recover`, ...)
holds the same messages among other records; it is read message by message, which takes much longer. The file says which
table its messages are of.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, Message, Metadata, Schema
from mcap.stream_reader import breakup_chunk, get_chunk_data_stream
from mcap.writer import MCAP0_MAGIC
from numpy.typing import NDArray
from zstandard import ZstdError

from armland.errors import LogError
from armland.mission.records import LANDING_TABLE
from armland.records import PAPER_TABLE, MessageTable
from armland.runtime.block import CDR_LITTLE_ENDIAN, channels, read_block
from armland.runtime.mcap_file import METADATA_NAME
from armland.runtime.schema import check_schema, topic

TABLES = {table.kind: table for table in (PAPER_TABLE, LANDING_TABLE)}
"""The tables whose logs can be read, by their kind."""


@dataclass(frozen=True)
class Log:
    """A recorded run."""

    messages: dict[str, NDArray[np.void]]
    """Message name to structured array (ticks,), e.g. `log.messages["truth"]["r"]` (ticks, 3)."""
    metadata: dict[str, str]
    """What the recorder was told about the run, and `kind`, `version`, `joints`, `period_ns`."""
    attachments: dict[str, bytes]
    """Attached files by name."""
    complete: bool
    """False where the file ends before its footer: the process was killed while it recorded."""

    @property
    def kind(self) -> str:
        """Kind of the run: `paper` or `landing`."""
        return _kind(self.metadata)

    def names(self, what: str) -> tuple[str, ...]:
        """What a number in the messages stands for: `phases` for `mission.phase`, `faults` for `mission.fault`.

        Raises:
            LogError: the log has no such list.
        """
        if what not in self.metadata:
            raise LogError(f"the log names no {what!r}; its metadata has {', '.join(sorted(self.metadata))}")
        return tuple(self.metadata[what].split(","))

    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the ticks in s (ticks,)."""
        return self.messages["measurement"]["tick"] * (int(self.metadata["period_ns"]) * 1e-9)


@dataclass
class _Content:
    """The parsed records of a file."""

    metadata: dict[str, str] = field(default_factory=dict)
    attachments: dict[str, bytes] = field(default_factory=dict)
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    chunks: list[Chunk] = field(default_factory=list)
    complete: bool = False


def read_log(path: str | Path) -> Log:
    """Read a run log; of a truncated file, all blocks that are whole.

    Raises:
        LogError: no run log, a damaged one, or one with another layout of the messages.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise LogError(f"cannot read the run log {path}: {error.strerror}") from error
    try:
        return _decode(_parse(data))
    except LogError as error:
        raise LogError(f"{path}: {error}") from error
    except (ValueError, McapError, ZstdError) as error:
        raise LogError(f"{path}: damaged, {error}; `mcap recover` may save a part of it") from error


def _records(data: bytes) -> Iterator[tuple[int, memoryview]]:
    """Opcode and content of each record that is whole."""
    position, view = len(MCAP0_MAGIC), memoryview(data)
    while position + 9 <= len(data):
        opcode, length = struct.unpack_from("<BQ", data, position)
        end = position + 9 + length
        if end > len(data):
            return
        yield opcode, view[position + 9 : end]
        position = end
        if opcode == Opcode.FOOTER:
            return


def _parse(data: bytes) -> _Content:
    if not data.startswith(MCAP0_MAGIC):
        raise LogError("this is not an MCAP file")
    content = _Content()
    for opcode, body in _records(data):
        stream = ReadDataStream(BytesIO(body))
        match opcode:
            case Opcode.METADATA:
                record = Metadata.read(stream)
                if record.name == METADATA_NAME:
                    content.metadata = record.metadata
            case Opcode.ATTACHMENT:
                attachment = Attachment.read(stream)
                content.attachments[attachment.name] = attachment.data
            case Opcode.SCHEMA:
                schema = Schema.read(stream)
                content.schemas[schema.id] = schema
            case Opcode.CHANNEL:
                channel = Channel.read(stream)
                content.channels[channel.id] = channel
            case Opcode.CHUNK:
                content.chunks.append(Chunk.read(stream))
            case Opcode.MESSAGE:
                raise LogError("it has messages outside of chunks; `mcap compress` puts them into chunks")
            case Opcode.FOOTER:
                content.complete = data.endswith(MCAP0_MAGIC)
    return content


def _decode(content: _Content) -> Log:
    try:
        joints = int(content.metadata["joints"])
    except KeyError:
        raise LogError("it has no metadata of a run: not armland's, or cut off too early") from None
    table = _table(content.metadata)
    numbers = _channel_numbers(content, table, joints)
    layouts = {name: table.layout(name, joints) for name in table.messages}
    parts: dict[str, list[NDArray[np.void]]] = {name: [np.empty(0, dtype)] for name, dtype in layouts.items()}
    for chunk in content.chunks:
        stream, length = get_chunk_data_stream(chunk, validate_crc=True)
        records = read_block(stream.read(length), table, joints) if numbers == channels(table) else None
        if records is None:
            for name, payloads in _payloads(chunk, numbers).items():
                parts[name].append(np.frombuffer(payloads, layouts[name]))
        else:
            for name in layouts:
                parts[name].append(records[name]["payload"])
    messages = {name: _join(arrays) for name, arrays in parts.items()}
    return Log(messages, content.metadata, content.attachments, content.complete)


def _kind(metadata: dict[str, str]) -> str:
    # Logs of before there were landings do not say.
    return metadata.get("kind", PAPER_TABLE.kind)


def _table(metadata: dict[str, str]) -> MessageTable:
    kind = _kind(metadata)
    if kind not in TABLES:
        raise LogError(
            f"it is the log of a run of kind {kind!r}; this version reads {', '.join(TABLES)}; read it with armland "
            f"{metadata.get('version', 'of a later version')}"
        )
    return TABLES[kind]


def _join(arrays: list[NDArray[np.void]]) -> NDArray[np.void]:
    # As opaque bytes: NumPy joins structured arrays field by field.
    dtype = arrays[0].dtype
    return np.concatenate([array.view(np.dtype((np.void, dtype.itemsize))) for array in arrays]).view(dtype)


def _channel_numbers(content: _Content, table: MessageTable, joints: int) -> dict[str, int]:
    """Channel number of each message, once its stored definition is known to be today's."""
    topics = {channel.topic: channel for channel in content.channels.values()}
    numbers = {}
    for name in table.messages:
        channel = topics.get(topic(name))
        if channel is None or channel.schema_id not in content.schemas:
            raise LogError(f"it has no messages on {topic(name)}; it has {sorted(topics)}")
        check_schema(table, name, joints, content.schemas[channel.schema_id].data.decode())
        numbers[name] = channel.id
    return numbers


def _payloads(chunk: Chunk, numbers: dict[str, int]) -> dict[str, bytes]:
    messages = [record for record in breakup_chunk(chunk) if isinstance(record, Message)]
    skip = len(CDR_LITTLE_ENDIAN)
    return {
        name: b"".join(message.data[skip:] for message in messages if message.channel_id == number)
        for name, number in numbers.items()
    }
