"""The records of an MCAP file, whole or as far as a killed run got, within bounds on all that a file can ask for.

A file is not trusted: what it says about lengths, counts and sizes is checked before memory is asked for, and whatever the
parsers of others make of damaged bytes becomes one `LogError`. Format: <https://mcap.dev/spec>.
"""

import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO

import lz4.frame
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, Metadata, Schema
from mcap.writer import MCAP0_MAGIC

from armland.errors import LogError

METADATA_NAME = "armland"
"""Name of the metadata record that describes the run."""

LARGEST_CHUNK = 1 << 28
"""Bytes of a chunk when unpacked."""

EXPANSION, ALLOWANCE = 200, 1 << 26
"""A log unpacks to at most this many times its size, and this many bytes more: packed numbers shrink by far less."""

_MESSAGE = struct.Struct("<BQHIQQ")


@dataclass
class Content:
    """The parsed records of a file."""

    metadata: dict[str, str] = field(default_factory=dict)
    attachments: dict[str, bytes] = field(default_factory=dict)
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    chunks: list[Chunk] = field(default_factory=list)
    complete: bool = False
    """False where the file ends before its footer."""


def parse(data: bytes) -> Content:
    """The records of a file.

    Raises:
        LogError: no MCAP file, or a damaged one.
    """
    if not data.startswith(MCAP0_MAGIC):
        raise LogError("this is not an MCAP file")
    content = Content()
    try:
        for opcode, body in _records(memoryview(data)[len(MCAP0_MAGIC) :]):
            _take(content, opcode, body)
    except LogError:
        raise
    except Exception as error:
        raise damaged(error) from error
    content.complete = content.complete and data.endswith(MCAP0_MAGIC)
    if sum(chunk.uncompressed_size for chunk in content.chunks) > EXPANSION * len(data) + ALLOWANCE:
        raise LogError(f"damaged, it unpacks to more than {EXPANSION} times its size")
    return content


def damaged(error: Exception) -> LogError:
    """What to say where parsing ended in `error`."""
    return LogError(f"damaged, {str(error) or type(error).__name__}; `mcap recover` may save a part of it")


def unpacked(chunk: Chunk) -> bytes:
    """The content of a chunk.

    Raises:
        LogError: it is damaged, larger than it may be, or packed in an unknown manner.
    """
    size = chunk.uncompressed_size
    if size > LARGEST_CHUNK:
        raise LogError(f"damaged, a chunk of {size} bytes; they have at most {LARGEST_CHUNK}")
    try:
        match chunk.compression:
            case "":
                data = bytes(chunk.data)
            case "zstd":
                with zstandard.ZstdDecompressor().stream_reader(chunk.data) as stream:
                    data = stream.read(size + 1)
            case "lz4":
                data = lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=size + 1)
            case _:
                raise LogError(f"its chunks are packed by {chunk.compression[:20]!r}; known are lz4 and zstd")
    except LogError:
        raise
    except Exception as error:
        raise damaged(error) from error
    if len(data) != size or (chunk.uncompressed_crc and zlib.crc32(data) != chunk.uncompressed_crc):
        raise LogError("damaged, a chunk's content is not what was written; `mcap recover` may save a part of it")
    return data


def payloads(data: bytes, lengths: dict[int, int], skip: int) -> dict[int, bytes]:
    """Messages in the content of a chunk by channel number, one after the other, each without its first `skip` bytes.

    Args:
        data: content.
        lengths: of the messages on the channels that are wanted, without those bytes.
        skip: length of the encapsulation's head.

    Raises:
        LogError: a message of another length, or a record that ends behind the chunk.
    """
    found: dict[int, list[memoryview]] = {number: [] for number in lengths}
    for opcode, body in _records(memoryview(data), whole=True):
        if opcode != Opcode.MESSAGE:
            continue
        number = int.from_bytes(body[:2], "little")
        if number in found:
            message = body[_MESSAGE.size - 9 + skip :]
            if len(message) != lengths[number]:
                raise LogError(f"damaged, a message of {len(message)} bytes where its definition has {lengths[number]}")
            found[number].append(message)
    return {number: b"".join(parts) for number, parts in found.items()}


def _records(data: memoryview, whole: bool = False) -> Iterator[tuple[int, memoryview]]:
    # Opcode and content of each record; one that is cut off ends them, or is an error where all should be `whole`.
    position = 0
    while position + 9 <= len(data):
        opcode, length = struct.unpack_from("<BQ", data, position)
        end = position + 9 + length
        if end > len(data):
            break
        yield opcode, data[position + 9 : end]
        position = end
        if opcode == Opcode.FOOTER:
            return
    if whole and position != len(data):
        raise LogError("damaged, a record ends behind its chunk")


def _take(content: Content, opcode: int, body: memoryview) -> None:
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
            content.complete = True
