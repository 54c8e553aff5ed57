"""Reading a run log back: every tick in today's layout, whole or as far as a killed run got.

The recorder's own chunks are decoded in bulk. A log that another tool rewrote (`mcap compress`, `mcap recover`, ...) holds the
same messages among other records; it is read message by message, which takes much longer. A log says of which fields its
messages are: what an older version wrote is read by the fields' names, and what it lacked is NaN, or 0 in whole numbers.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armland.errors import LogError
from armland.records import MESSAGES, Records, tick_layout
from armland.runtime.log.block import CDR_LITTLE_ENDIAN, read_block
from armland.runtime.log.columns import columns
from armland.runtime.log.container import Content, damaged, parse, payloads, unpacked
from armland.runtime.log.schema import converted, schema_layout, topic

LARGEST_ARM = 64
"""Joints of an arm in a log."""

LONGEST_TICK_NS = 10**10
"""Length of a tick, ns."""

NEEDED = ("measurement", "command")
"""Messages without which a log is none of a run."""


@dataclass(frozen=True)
class Log:
    """A recorded run."""

    ticks: Records
    """(k,) of `records.tick_layout`."""
    metadata: dict[str, str]
    """What the recorder was told about the run, and `version`, `joints`, `period_ns`."""
    attachments: dict[str, bytes]
    """Attached files by name."""
    complete: bool
    """False where the file ends before its footer: the process was killed while it recorded."""

    @property
    def messages(self) -> dict[str, Records]:
        """Message name to structured array (k,), e.g. `log.messages["truth"]["r"]` (k, 3): views of `ticks`."""
        return {name: self.ticks[name] for name in MESSAGES}

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
        """Times of the ticks in s (k,)."""
        return self.ticks["measurement"]["tick"] * (int(self.metadata["period_ns"]) * 1e-9)

    def table(self) -> dict[str, NDArray]:
        """The run as flat columns, see `columns.columns`: `pandas.DataFrame(log.table())`."""
        return columns(self.ticks, int(self.metadata["period_ns"]))


def read_log(path: str | Path) -> Log:
    """Read a run log; of a truncated file, all blocks that are whole.

    Raises:
        LogError: no run log, a damaged one, or one whose messages cannot be read as today's.
    """
    try:
        data = Path(path).read_bytes()
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else error
        raise LogError(f"cannot read the run log {path}: {why}") from error
    try:
        return _decode(parse(data))
    except LogError as error:
        raise LogError(f"{path}: {error}") from error
    except Exception as error:
        # A crafted file can ask NumPy for anything.
        raise LogError(f"{path}: {damaged(error)}") from error


def _decode(content: Content) -> Log:
    # A landing without an arm has no joint.
    joints = _number(content.metadata, "joints", LARGEST_ARM, least=0)
    _number(content.metadata, "period_ns", LONGEST_TICK_NS)
    channels = _channels(content)
    layouts = {
        number: schema_layout(content.schemas[content.channels[number].schema_id].data.decode()) for number in channels
    }
    blocks = []
    for chunk in content.chunks:
        data = unpacked(chunk)
        records = read_block(data, layouts)
        if records is not None:
            blocks.append({number: records[f"c{number}"]["payload"] for number in layouts})
        else:
            found = payloads(data, {n: dtype.itemsize for n, dtype in layouts.items()}, len(CDR_LITTLE_ENDIAN))
            blocks.append({number: np.frombuffer(found[number], dtype) for number, dtype in layouts.items()})
    ticks = np.zeros(_length(blocks, channels, content.complete), tick_layout(joints))
    for name in MESSAGES:
        numbers = [number for number, message in channels.items() if message == name]
        dtype = layouts[numbers[0]] if numbers else np.dtype([("tick", "i8")])
        rows = np.zeros(len(ticks), dtype)
        _join(rows, [block[numbers[0]] for block in blocks] if numbers else [])
        try:
            converted(rows, ticks[name], name)
        except LogError as error:
            raise LogError(
                f"{error}; read it with armland {content.metadata.get('version', 'of another version')}"
            ) from error
    return Log(ticks, content.metadata, content.attachments, content.complete)


def _join(rows: Records, parts: list[Records]) -> None:
    # As opaque bytes: NumPy copies structured arrays field by field.
    opaque, first = np.dtype((np.void, rows.itemsize)), 0
    for part in parts:
        count = min(len(part), len(rows) - first)
        rows.view(opaque)[first : first + count] = np.ascontiguousarray(part[:count]).view(opaque)
        first += count


def _length(blocks: list[dict[int, Records]], channels: dict[int, str], complete: bool) -> int:
    # A file that another tool wrote may be cut off in the middle of a tick.
    counts = {name: sum(len(block[number]) for block in blocks) for number, name in channels.items()}
    if complete and len(set(counts.values())) > 1:
        raise LogError(f"damaged, it has not as many messages of each kind: {counts}")
    return min(counts.values())


def _number(metadata: dict[str, str], name: str, largest: int, least: int = 1) -> int:
    text = metadata.get(name, "")
    if not text:
        raise LogError("it has no metadata of a run: not armland's, or cut off too early")
    if not (text.isascii() and text.isdigit() and len(text) < 20 and least <= int(text) <= largest):
        raise LogError(f"damaged, its metadata says {name} = {text[:30]!r}; it is between {least} and {largest}")
    return int(text)


def _channels(content: Content) -> dict[int, str]:
    # Channel number to message, in the order in which the recorder writes them.
    names = {topic(name): name for name in MESSAGES}
    found = {n: names[c.topic] for n, c in sorted(content.channels.items()) if c.topic in names}
    for name in NEEDED:
        if name not in found.values():
            there = sorted(c.topic for c in content.channels.values())
            raise LogError(
                f"it has no messages on {topic(name)}; it has {', '.join(there[:20])[:400] or 'none at all'}"
            )
    if len(set(found.values())) < len(found):
        raise LogError("damaged, it has two channels of one topic")
    if lost := [n for n in found if content.channels[n].schema_id not in content.schemas]:
        raise LogError(f"it has no messages on {topic(found[lost[0]])} that it defines: damaged, or cut off too early")
    return found
