"""The recorder: lends the loop rows for its ticks, and makes a run's log of the blocks that they fill.

The loop writes each tick where the recorder will read it; a full block becomes MCAP messages in bulk. A block that is on disk
stays readable whatever happens to the process, and leaving the `with` statement, by an exception too, writes the begun one.
A disk that fails ends no flight: the recorder says so in `failure` and takes no more to the disk.
"""

from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np

from armland import __version__
from armland.errors import LogError
from armland.records import Records, tick_layout
from armland.runtime.log.block import MessageBlock
from armland.runtime.log.file import McapFile

SCENARIO_NAME = "scenario.toml"
"""Name of the attachment that holds the scenario's text."""

OWN = ("version", "joints", "period_ns")
"""Metadata that the recorder sets itself."""


class Recorder:
    """Records ticks into a file, into memory, or both."""

    def __init__(
        self,
        path: str | Path | None,
        joints: int,
        period_ns: int,
        metadata: Mapping[str, str] | None = None,
        *,
        scenario: str = "",
        block: int = 500,
        keep_in_memory: bool | None = None,
    ) -> None:
        """Open the log.

        Args:
            path: the file; an earlier one is replaced when this one is whole. None records in memory only.
            joints: of the arm.
            period_ns: length of a tick; a message's time is the measurement's tick times this.
            metadata: what to know about the run (seed, mission); version, joints and period_ns are added.
            scenario: text of the scenario, attached to the file as `scenario.toml` unless empty.
            block: ticks that a killed process may lose; 500 is also the fastest.
            keep_in_memory: whether `ticks` can be asked for; by default only without a file.

        Raises:
            LogError: the file cannot be created, or `metadata` has a key that the recorder sets.
        """
        metadata = dict(metadata or {})
        if taken := sorted(set(OWN) & metadata.keys()):
            raise LogError(f"metadata {taken} are set by the recorder itself; leave out {list(OWN)}")
        self.failure: LogError | None = None
        """Why the log is cut short, where it is; the flight went on without it."""
        self._joints, self._period_ns, self._size = joints, period_ns, block
        self._keep = path is None if keep_in_memory is None else keep_in_memory
        self._kept: list[Records] = []
        self._first = 0
        self._begin_block()
        own = {"version": __version__, "joints": str(joints), "period_ns": str(period_ns)}
        texts = {SCENARIO_NAME: scenario} if scenario else {}
        self._attached: dict[str, str] = {}
        self._messages = MessageBlock(joints, block)
        self._file = None if path is None else McapFile(path, joints, own | metadata, texts)

    def rows(self, most: int) -> Records:
        """The rows (k,) of `tick_layout`, 1 ≤ k ≤ `most`, into which the next ticks go; `add` takes them over."""
        return self._ticks[self._count : self._count + most]

    def add(self, count: int) -> None:
        """Record the first `count` of the rows last lent. Never raises: see `failure`."""
        self._count += count
        if self._count == self._size:
            self._end_block()

    def attach(self, name: str, text: str) -> None:
        """Attach a text to the file before the next block of ticks; of several of one name the last one counts."""
        self._attached[name] = text

    @property
    def ticks(self) -> Records:
        """All recorded ticks (k,) of `tick_layout`, e.g. `recorder.ticks["truth"]["r"]` (k, 3).

        Raises:
            LogError: they were not kept.
        """
        if not self._keep:
            raise LogError("the ticks are in the file only; pass keep_in_memory=True or use read_log")
        blocks = [*self._kept, self._ticks[: self._count]]
        # As opaque bytes: NumPy joins structured arrays field by field.
        opaque = np.dtype((np.void, self._ticks.itemsize))
        return np.concatenate([block.view(opaque) for block in blocks]).view(self._ticks.dtype)

    def close(self) -> None:
        """Write what is left and close the file, which then has its name. Never raises: see `failure`; a second call does nothing."""
        file, self._file = self._file, None
        if file is None:
            return
        try:
            if self.failure is None:
                self._write(file)
                file.finish()
        except LogError as lost:
            self.failure = lost
        finally:
            file.close()

    def _begin_block(self) -> None:
        self._ticks = np.zeros(self._size, tick_layout(self._joints))
        self._count = 0

    def _end_block(self) -> None:
        if self._file is not None and self.failure is None:
            try:
                self._write(self._file)
            except LogError as lost:
                self.failure = lost
        self._first += self._count
        if self._keep:
            self._kept.append(self._ticks)
            self._begin_block()
        self._count = 0

    def _write(self, file: McapFile) -> None:
        while self._attached:
            file.attach(*self._attached.popitem())
        ticks = self._ticks[: self._count]
        if len(ticks):
            messages = self._messages if len(ticks) == self._size else MessageBlock(self._joints, len(ticks))
            file.write_chunk(messages, messages.fill(ticks, self._first, self._period_ns))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        self.close()
        if error is not None and self.failure is not None:
            error.add_note(f"The run log is cut short: {self.failure}")
