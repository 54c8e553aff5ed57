import numpy as np
import pytest
from mcap.records import Chunk, Message
from mcap.stream_reader import breakup_chunk

from armland.records import MESSAGES, layout, tick_layout
from armland.runtime.log.block import CHANNELS, MessageBlock, read_block

PERIOD = 1_000_000


def payloads(joints: int) -> dict[int, np.dtype]:
    return {channel: layout(name, joints) for name, channel in CHANNELS.items()}


def some_ticks(count: int, joints: int, first: int = 0) -> np.ndarray:
    kind = tick_layout(joints)
    words = np.random.default_rng(7).integers(0, 2**63, (count, kind.itemsize // 8), np.uint64)
    ticks = words.view(kind)[:, 0]
    for name in MESSAGES:
        ticks[name]["tick"] = first + np.arange(count)
    return ticks


@pytest.mark.parametrize("joints", [1, 6, 7])
def test_library_finds_the_messages_in_the_block(joints: int) -> None:
    ticks, block = some_ticks(5, joints, 100), MessageBlock(joints, 5)
    times = block.fill(ticks, 40, PERIOD)
    assert times.tolist() == [(100 + i) * PERIOD for i in range(5)]
    data = bytes(block.records)
    messages = breakup_chunk(Chunk("", data, 0, 0, 0, len(data)))
    expected = [
        Message(
            CHANNELS[name],
            (100 + i) * PERIOD,
            b"\0\1\0\0" + ticks[name][i].tobytes(),
            (100 + i) * PERIOD,
            40 + i,
        )
        for i in range(5)
        for name in MESSAGES
    ]
    assert messages == expected


def test_time_is_exact_where_floats_are_not() -> None:
    ticks, block = some_ticks(2, 7, first=10**10), MessageBlock(7, 2)
    times = block.fill(ticks, 0, 1_000_003)
    assert times.tolist() == [10**10 * 1_000_003, (10**10 + 1) * 1_000_003]


def test_block_is_read_back_bit_by_bit() -> None:
    ticks, block = some_ticks(5, 7), MessageBlock(7, 5)
    block.fill(ticks, 0, PERIOD)
    records = read_block(bytes(block.records), payloads(7))
    for name in MESSAGES:
        assert records[f"c{CHANNELS[name]}"]["payload"].tobytes() == ticks[name].tobytes()


def test_block_forgets_what_it_held_before() -> None:
    fresh, used = MessageBlock(7, 5), MessageBlock(7, 5)
    used.fill(some_ticks(5, 7, first=900), 900, PERIOD)
    for block in (fresh, used):
        block.fill(some_ticks(5, 7), 0, PERIOD)
    assert (bytes(used.records), bytes(used.index)) == (bytes(fresh.records), bytes(fresh.index))


def test_bytes_of_another_writer_are_not_taken_for_a_block() -> None:
    block = MessageBlock(7, 5)
    block.fill(some_ticks(5, 7), 0, PERIOD)
    data = bytearray(block.records)
    assert read_block(bytes(data), payloads(7)) is not None
    assert read_block(bytes(data[:-1]), payloads(7)) is None
    assert read_block(bytes(data), payloads(6)) is None
    assert read_block(bytes(data), dict(reversed(payloads(7).items()))) is None
    data[9] = 2  # the channel of the first message
    assert read_block(bytes(data), payloads(7)) is None
