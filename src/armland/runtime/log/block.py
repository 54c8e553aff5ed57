"""A block of ticks as MCAP message records: all messages of hundreds of ticks made in a few NumPy calls.

One packed record per tick holds the message records of all channels one after the other, so the bytes of an array of
them are the content of an MCAP chunk. What never changes (opcodes, lengths, channels) is written once, when the block
is made. Layouts: <https://mcap.dev/spec>, records Message and Message Index.
"""

from collections.abc import Mapping

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray

from armland.records import MESSAGES, Records, layout, tick_layout

CDR_LITTLE_ENDIAN = (0, 1, 0, 0)
"""The encapsulation header of a CDR payload; alignment counts from its end, so 8-byte fields need no padding."""

_PREFIX = 9  # opcode and length, which the length of a record does not count
_FIXED = ("opcode", "length", "channel", "encapsulation")

CHANNELS = {name: number for number, name in enumerate(MESSAGES, start=1)}
"""Channel (and schema) number of each message."""


def record_layout(payloads: Mapping[int, np.dtype]) -> np.dtype:
    """The packed dtype of one tick's message records by channel number, `c1` and so on; the message is the field `payload`."""
    head = [("opcode", "u1"), ("length", "<u8"), ("channel", "<u2"), ("sequence", "<u4")]
    head += [("log_time", "<u8"), ("publish_time", "<u8")]
    tail = ("encapsulation", "u1", (len(CDR_LITTLE_ENDIAN),))
    return np.dtype([(f"c{channel}", [*head, tail, ("payload", dtype)]) for channel, dtype in payloads.items()])


def _blank(payloads: Mapping[int, np.dtype], size: int) -> Records:
    records = np.zeros(size, record_layout(payloads))
    for channel in payloads:
        record = records[f"c{channel}"]
        record["opcode"] = Opcode.MESSAGE
        record["length"] = record.dtype.itemsize - _PREFIX
        record["channel"] = channel
        record["encapsulation"] = CDR_LITTLE_ENDIAN
    return records


def _offset(dtype: np.dtype, name: str) -> int:
    fields = dtype.fields
    assert fields is not None
    return int(fields[name][1])


class MessageBlock:
    """The message records of `size` ticks and their message indexes, allocated once and filled again and again."""

    def __init__(self, joints: int, size: int) -> None:
        self.size = size
        self._records = _blank({channel: layout(name, joints) for name, channel in CHANNELS.items()}, size)
        entries = ("entries", [("log_time", "<u8"), ("offset", "<u8")], (size,))
        index = [("opcode", "u1"), ("length", "<u8"), ("channel", "<u2"), ("entries_bytes", "<u4"), entries]
        self._index = np.zeros(len(CHANNELS), index)
        self._index["opcode"] = Opcode.MESSAGE_INDEX
        self._index["length"] = self._index.dtype.itemsize - _PREFIX
        self._index["channel"] = list(CHANNELS.values())
        self._index["entries_bytes"] = size * 16
        self.records = self._records.view(np.uint8).data
        """Bytes of all message records, tick by tick."""
        self.index = self._index.view(np.uint8).data
        """Bytes of the message index records, channel by channel."""
        self.index_stride = self._index.dtype.itemsize
        self._columns = self._records.view(np.uint8).reshape(size, -1)
        self._copies = []
        for i, (name, channel) in enumerate(CHANNELS.items()):
            start, length = _offset(self._records.dtype, f"c{channel}"), layout(name, joints).itemsize
            source = _offset(tick_layout(joints), name)
            target = start + _offset(self._records.dtype[f"c{channel}"], "payload")
            self._copies.append((slice(target, target + length), slice(source, source + length)))
            self._index["entries"]["offset"][i] = start + np.arange(size) * self._records.dtype.itemsize

    def fill(self, ticks: Records, first: int, period_ns: int) -> NDArray[np.uint64]:
        """Take over `size` ticks of `tick_layout`, the first of which is number `first` of the run.

        Returns:
            The times of the ticks in ns: the measurement's tick times `period_ns`.
        """
        rows = ticks.view(np.uint8).reshape(self.size, -1)
        for target, source in self._copies:
            self._columns[:, target] = rows[:, source]
        times = ticks["measurement"]["tick"].astype(np.uint64) * np.uint64(period_ns)
        sequence = np.arange(first, first + self.size)
        for name in self._records.dtype.names or ():
            record = self._records[name]
            record["sequence"] = sequence
            record["log_time"] = times
            record["publish_time"] = times
        self._index["entries"]["log_time"] = times
        return times


def read_block(data: bytes, payloads: Mapping[int, np.dtype]) -> Records | None:
    """The records, `record_layout`, in the content of a chunk, or None where another writer laid it out.

    Args:
        data: content of the chunk.
        payloads: layout of the messages on each channel, in the order of the channels.
    """
    dtype = record_layout(payloads)
    if len(data) % dtype.itemsize:
        return None
    records, blank = np.frombuffer(data, dtype), _blank(payloads, 1)
    same = all((records[name][part] == blank[name][part]).all() for name in dtype.names or () for part in _FIXED)
    return records if same else None
