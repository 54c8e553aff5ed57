"""An MCAP file that is written block by block: head, chunks, and the summary that makes it seekable.

The library's own writer takes one Python call per message, which costs more than the whole loop. Here its record
classes write everything but the chunks and their indexes, and those arrive ready made as a `MessageBlock`. Chunks are
not compressed: simulated numbers shrink by a fifth only, and that takes longer than all the rest. A file depends on
nothing but what is recorded: no clock, no host, no path, so equal runs give equal bytes.
"""

import io
import os
import struct
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
from mcap.writer import MCAP0_MAGIC
from numpy.typing import NDArray

from armland import __version__
from armland.errors import LogError
from armland.runtime.log.block import CHANNELS, MessageBlock
from armland.runtime.log.container import METADATA_NAME
from armland.runtime.log.schema import MESSAGE_ENCODING, SCHEMA_ENCODING, schema_name, schema_text, topic

UNFINISHED = ".part"
"""What the name of a log ends in until it is whole."""


class McapFile:
    """One file being written. Every write ends on a whole record, so what is on disk can always be read.

    It has its name from `finish` on. Until then it is called so with `.part` at the end, and an earlier file of the name stays.
    """

    def __init__(
        self,
        path: str | Path,
        joints: int,
        metadata: Mapping[str, str],
        texts: Mapping[str, str],
    ) -> None:
        """Open the file and write its head: metadata, the attached `texts` by name, schemas and channels.

        Raises:
            LogError: the file cannot be created or written.
        """
        self.path = Path(path)
        self._part = self.path.with_name(f"{self.path.name}{UNFINISHED}")
        self._size = 0
        self._ticks = 0
        self._chunks: list[ChunkIndex] = []
        self._attachments: list[AttachmentIndex] = []
        self._metadata: list[MetadataIndex] = []
        self._schemas = [
            Schema(number, schema_text(name, joints).encode(), SCHEMA_ENCODING, schema_name(name))
            for name, number in CHANNELS.items()
        ]
        self._channels = [
            Channel(number, topic(name), MESSAGE_ENCODING, {}, number) for name, number in CHANNELS.items()
        ]
        self._file = _create(self.path, self._part)
        try:
            self._write_head(metadata, texts)
        except LogError:
            self.close()
            raise

    def _write_head(self, metadata: Mapping[str, str], texts: Mapping[str, str]) -> None:
        self._write(MCAP0_MAGIC, _pack(Header("ros2", f"armland {__version__}")))
        record = _pack(Metadata(METADATA_NAME, dict(sorted(metadata.items()))))
        self._metadata.append(MetadataIndex(self._size, len(record), METADATA_NAME))
        self._write(record)
        for name, text in texts.items():
            self.attach(name, text)
        self._write(_pack(*self._schemas, *self._channels))

    def attach(self, name: str, text: str) -> None:
        """Append an attachment.

        Raises:
            LogError: the disk is full or the file is gone.
        """
        data = text.encode()
        record = _pack(Attachment(0, 0, name, "text/plain", data))
        self._attachments.append(AttachmentIndex(self._size, len(record), 0, 0, len(data), name, "text/plain"))
        self._write(record)

    def write_chunk(self, block: MessageBlock, times: NDArray[np.uint64]) -> None:
        """Append a filled block whose ticks have the `times` in ns.

        Raises:
            LogError: the disk is full or the file is gone; the file ends with the last whole block.
        """
        start, end, size = int(times.min()), int(times.max()), len(block.records)
        head = struct.pack("<QQQIIQ", start, end, size, zlib.crc32(block.records), 0, size)  # 0: no compression
        chunk = struct.pack("<BQ", Opcode.CHUNK, len(head) + size) + head
        index = self._size + len(chunk) + size
        offsets = {channel: index + i * block.index_stride for i, channel in enumerate(CHANNELS.values())}
        chunk_index = ChunkIndex(len(chunk) + size, self._size, "", size, end, len(block.index), offsets, start, size)
        self._write(chunk, block.records, block.index)
        self._chunks.append(chunk_index)
        self._ticks += block.size

    def finish(self) -> None:
        """Write the end of the data, the summary with all indexes, and the footer; the file takes its name.

        Raises:
            LogError: the disk is full, or the file cannot take its name.
        """
        self._write(_pack(DataEnd(0)))
        builder, start, offsets = RecordBuilder(), self._size, []
        for opcode, records in self._summary():
            group = builder.count
            for record in records:
                record.write(builder)
            if records:
                offsets.append(SummaryOffset(opcode, start + group, builder.count - group))
        footer = Footer(start, start + builder.count, 0)
        for offset in offsets:
            offset.write(builder)
        summary = builder.end()
        # The footer's checksum covers the summary and the footer itself up to the checksum.
        footer.summary_crc = zlib.crc32(_pack(footer)[:-4], zlib.crc32(summary))
        self._write(summary, _pack(footer), MCAP0_MAGIC)
        try:
            os.replace(self._part, self.path)
        except OSError as error:
            raise LogError(f"the run log is {self._part}; it cannot be called {self.path}: {error.strerror}") from error

    def _summary(self) -> list[tuple[Opcode, Sequence[McapRecord]]]:
        statistics = Statistics(
            attachment_count=len(self._attachments),
            channel_count=len(self._channels),
            channel_message_counts={channel.id: self._ticks for channel in self._channels if self._ticks},
            chunk_count=len(self._chunks),
            message_count=self._ticks * len(self._channels),
            message_end_time=max((c.message_end_time for c in self._chunks), default=0),
            message_start_time=min((c.message_start_time for c in self._chunks), default=0),
            metadata_count=len(self._metadata),
            schema_count=len(self._schemas),
        )
        return [
            (Opcode.SCHEMA, self._schemas),
            (Opcode.CHANNEL, self._channels),
            (Opcode.STATISTICS, [statistics]),
            (Opcode.CHUNK_INDEX, self._chunks),
            (Opcode.ATTACHMENT_INDEX, self._attachments),
            (Opcode.METADATA_INDEX, self._metadata),
        ]

    def _write(self, *parts: bytes | memoryview) -> None:
        try:
            self._file.seek(self._size)  # an interrupted write is repeated in place
            for part in parts:
                rest = memoryview(part)
                while rest:
                    rest = rest[self._file.write(rest) :]
        except OSError as error:
            kept = f"{self._part.name} holds the first {self._ticks} ticks" if self._ticks else "no tick of it is kept"
            raise LogError(f"cannot write the run log {self.path.name}: {error.strerror}; {kept}") from error
        self._size += sum(len(part) for part in parts)

    def close(self) -> None:
        """Close the file as it is; one that holds no tick and came to no end is removed."""
        self._file.close()
        if not self._ticks:
            self._part.unlink(missing_ok=True)


def _pack(*records: McapRecord) -> bytes:
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    return builder.end()


def _create(path: Path, part: Path) -> io.FileIO:
    # A file of its own, whatever stands there: a link, which might lead anywhere, is replaced and not followed.
    try:
        if path.exists() and not path.is_file():
            raise IsADirectoryError(21, "it is no file")
        part.unlink(missing_ok=True)
        return io.FileIO(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666), "wb")
    except (OSError, ValueError) as error:
        advice = "name a file in a folder that can be written"
        if not path.parent.is_dir():
            advice = f"create the folder {path.parent} first"
        why = error.strerror if isinstance(error, OSError) else error
        raise LogError(f"cannot create the run log {path}: {why}; {advice}") from error
