import numpy as np
import pytest
from mcap.records import Chunk, Message
from mcap.stream_reader import breakup_chunk

from armland.mission.records import LANDING_TABLE
from armland.records import PAPER_TABLE as PAPER
from armland.records import MessageTable
from armland.runtime.block import MessageBlock, channels, read_block

PERIOD = 1_000_000
EACH_TABLE = pytest.mark.parametrize("table", [PAPER, LANDING_TABLE], ids=lambda t: t.kind)


def some_ticks(count: int, joints: int, first: int = 0, table: MessageTable = PAPER) -> np.ndarray:
    layout = table.tick_layout(joints)
    words = np.random.default_rng(7).integers(0, 2**63, (count, layout.itemsize // 8), np.uint64)
    ticks = words.view(layout)[:, 0]
    for name in table.messages:
        ticks[name]["tick"] = first + np.arange(count)
    return ticks


@EACH_TABLE
@pytest.mark.parametrize("joints", [1, 6, 7])
def test_library_finds_the_messages_in_the_block(joints: int, table: MessageTable) -> None:
    ticks, block = some_ticks(5, joints, 100, table), MessageBlock(table, joints, 5)
    times = block.fill(ticks, 40, PERIOD)
    assert times.tolist() == [(100 + i) * PERIOD for i in range(5)]
    data = bytes(block.records)
    messages = breakup_chunk(Chunk("", data, 0, 0, 0, len(data)))
    expected = [
        Message(
            channels(table)[name],
            (100 + i) * PERIOD,
            b"\0\1\0\0" + ticks[name][i].tobytes(),
            (100 + i) * PERIOD,
            40 + i,
        )
        for i in range(5)
        for name in table.messages
    ]
    assert messages == expected


def test_time_is_exact_where_floats_are_not() -> None:
    ticks, block = some_ticks(2, 7, first=10**10), MessageBlock(PAPER, 7, 2)
    times = block.fill(ticks, 0, 1_000_003)
    assert times.tolist() == [10**10 * 1_000_003, (10**10 + 1) * 1_000_003]


@EACH_TABLE
def test_block_is_read_back_bit_by_bit(table: MessageTable) -> None:
    ticks, block = some_ticks(5, 7, table=table), MessageBlock(table, 7, 5)
    block.fill(ticks, 0, PERIOD)
    records = read_block(bytes(block.records), table, 7)
    for name in table.messages:
        assert records[name]["payload"].tobytes() == ticks[name].tobytes()


def test_block_forgets_what_it_held_before() -> None:
    fresh, used = MessageBlock(PAPER, 7, 5), MessageBlock(PAPER, 7, 5)
    used.fill(some_ticks(5, 7, first=900), 900, PERIOD)
    for block in (fresh, used):
        block.fill(some_ticks(5, 7), 0, PERIOD)
    assert (bytes(used.records), bytes(used.index)) == (bytes(fresh.records), bytes(fresh.index))


def test_bytes_of_another_writer_are_not_taken_for_a_block() -> None:
    block = MessageBlock(PAPER, 7, 5)
    block.fill(some_ticks(5, 7), 0, PERIOD)
    data = bytearray(block.records)
    assert read_block(bytes(data), PAPER, 7) is not None
    assert read_block(bytes(data[:-1]), PAPER, 7) is None
    assert read_block(bytes(data), PAPER, 6) is None
    assert read_block(bytes(data), LANDING_TABLE, 7) is None
    data[9] = 2  # the channel of the first message
    assert read_block(bytes(data), PAPER, 7) is None
