"""Files that nobody should trust: each ends in ticks or in one message, in little memory and time."""

import io
import struct
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import zstandard
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.writer import CompressionType

from armland.errors import LogError
from armland.runtime.log import read_log
from armland.runtime.log.container import LARGEST_CHUNK, parse

MUTATIONS = 150

LENGTHS = (0, 1, 2**31, 2**32 - 1, 2**40, 2**63, 2**64 - 1)


@pytest.fixture
def whole(tmp_path: Path, record) -> bytes:
    record(tmp_path / "whole.mcap", 6, joints=1, block=3, metadata={"phases": "a,b"}, scenario="a = 1")
    return (tmp_path / "whole.mcap").read_bytes()


def read(path: Path, data: bytes) -> str:
    """What reading `data` says: nothing where it can be read. Anything but a `LogError` goes through."""
    path.write_bytes(data)
    try:
        log = read_log(path)
    except LogError as error:
        return str(error)
    assert all(len(rows) == len(log.ticks) == len(log.time) for rows in log.messages.values())
    return ""


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """One of the ways in which a file can be damaged, or crafted: bits, lengths, pieces lost, doubled or swapped."""
    out, at = bytearray(data), int(rng.integers(len(data)))
    match rng.integers(6):
        case 0:
            out[at] ^= 1 << int(rng.integers(8))
        case 1:
            out[at : at + 8] = struct.pack("<Q", LENGTHS[int(rng.integers(len(LENGTHS)))])
        case 2:
            out[at : at + 4] = rng.bytes(4)
        case 3:
            del out[at : at + int(rng.integers(1, 200))]
        case 4:
            out[at:at] = out[at : at + int(rng.integers(1, 200))]
        case 5:
            out = out[:at]
    return bytes(out)


@pytest.mark.parametrize("compression", [None, CompressionType.ZSTD, CompressionType.LZ4])
def test_damaged_file_ends_in_ticks_or_in_one_message(tmp_path: Path, whole: bytes, rewritten, compression) -> None:
    data = whole if compression is None else rewritten(whole, compression=compression, chunk_size=2000)
    rng, said = np.random.default_rng(5), set()
    for _ in range(MUTATIONS):
        text = read(tmp_path / "run.mcap", mutated(data, rng))
        assert "\n" not in text
        assert len(text) < 1000
        said.add(text.rpartition(": ")[2])
    assert len(said) > 5


def chunk(packed: bytes, size: int, compression: bytes, crc: int = 0) -> bytes:
    body = struct.pack("<QQQI", 0, 0, size, crc) + struct.pack("<I", len(compression)) + compression
    body += struct.pack("<Q", len(packed)) + packed
    return struct.pack("<BQ", Opcode.CHUNK, len(body)) + body


def with_chunk(whole: bytes, extra: bytes) -> bytes:
    first = make_reader(io.BytesIO(whole)).get_summary().chunk_indexes[0].chunk_start_offset
    return whole[:first] + extra + whole[first:]


@pytest.mark.parametrize("claimed", [5 << 30, 1 << 27, 64])
def test_file_that_unpacks_to_gigabytes_is_refused_in_little_memory(tmp_path: Path, whole: bytes, claimed: int) -> None:
    bomb = zstandard.ZstdCompressor().compress(bytes(1 << 28))
    data = with_chunk(whole, chunk(bomb, claimed, b"zstd"))
    assert len(data) < 100_000
    tracemalloc.start()
    said = read(tmp_path / "run.mcap", data)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert "damaged" in said
    assert peak < 1 << 25


def test_chunk_above_the_bound_is_refused_also_in_a_large_file(tmp_path: Path, whole: bytes) -> None:
    said = read(tmp_path / "run.mcap", with_chunk(whole, chunk(bytes(10), LARGEST_CHUNK + 1, b"")))
    assert "damaged" in said


def test_chunk_packed_by_something_unknown_is_named(tmp_path: Path, whole: bytes) -> None:
    said = read(tmp_path / "run.mcap", with_chunk(whole, chunk(b"abc", 3, b"brotli")))
    assert "packed by 'brotli'; known are lz4 and zstd" in said


def test_record_that_ends_behind_its_chunk_is_damage(tmp_path: Path, whole: bytes) -> None:
    inside = struct.pack("<BQ", Opcode.MESSAGE, 1 << 40)
    assert "ends behind its chunk" in read(tmp_path / "run.mcap", with_chunk(whole, chunk(inside, len(inside), b"")))


def test_message_of_another_length_is_damage(tmp_path: Path, whole: bytes) -> None:
    inside = struct.pack("<BQHIQQ", Opcode.MESSAGE, 22 + 12, 1, 0, 0, 0) + bytes(12)
    assert "a message of 8 bytes" in read(tmp_path / "run.mcap", with_chunk(whole, chunk(inside, len(inside), b"")))


def test_unequal_numbers_of_messages_are_damage_in_a_whole_file(tmp_path: Path, whole: bytes) -> None:
    inside = bytes(parse(whole).chunks[0].data)
    first = struct.unpack_from("<Q", inside, 1)[0] + 9
    data = with_chunk(whole, chunk(inside[:first], first, b""))
    assert "as many messages of each kind" in read(tmp_path / "run.mcap", data)
