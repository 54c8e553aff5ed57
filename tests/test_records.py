"""The layout of the messages: what compiled code, the recorder and a CDR decoder each rely on."""

import re

import numpy as np
import pytest

from armland.mission.records import LANDING_TABLE, LIMIT_NAMES, LandingTick, Limit, UavMode
from armland.records import PAPER_TABLE, AnyTick, Field, Flag, MessageTable, Tick, layout, tick_layout

TABLES = (PAPER_TABLE, LANDING_TABLE)
MESSAGES = [pytest.param(table, name, id=f"{table.kind}.{name}") for table in TABLES for name in table.messages]
FIELDS = [
    pytest.param(field, id=f"{table.kind}.{name}.{field.name}")
    for table in TABLES
    for name, fields in table.messages.items()
    for field in fields
]
JOINTS = [1, 6, 7]


@pytest.mark.parametrize(("table", "message"), MESSAGES)
def test_field_names_are_unique(table: MessageTable, message: str) -> None:
    names = [field.name for field in table.messages[message]]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("field", FIELDS)
def test_field_is_described_and_named_as_ros_demands(field: Field) -> None:
    assert all([field.unit, field.frame, field.meaning])
    assert re.fullmatch(r"[a-z]([a-z0-9]|_(?!_))*(?<!_)", field.name)


@pytest.mark.parametrize(("table", "message"), MESSAGES)
def test_message_begins_with_its_tick(table: MessageTable, message: str) -> None:
    assert table.messages[message][0].name == "tick"
    assert np.issubdtype(table.layout(message, 7)["tick"], np.integer)


@pytest.mark.parametrize("joints", JOINTS)
@pytest.mark.parametrize(("table", "message"), MESSAGES)
def test_bytes_are_a_cdr_payload(table: MessageTable, message: str, joints: int) -> None:
    """CDR aligns a number to its size: with 8-byte numbers only, nothing is padded and offsets follow one another."""
    dtype = table.layout(message, joints)
    offset = 0
    for name in dtype.names:
        assert dtype[name].base.itemsize == 8
        assert dtype.fields[name][1] == offset
        offset += 8 * int(np.prod(dtype[name].shape, dtype=int))
    assert dtype.itemsize == offset


@pytest.mark.parametrize("joints", JOINTS)
def test_n_is_the_number_of_joints(joints: int) -> None:
    assert layout("measurement", joints)["q"].shape == (joints,)
    assert layout("command", joints)["tau"].shape == (joints,)
    assert layout("truth", joints)["rotor_thrust"].shape == (4,)


def test_unknown_message_is_refused() -> None:
    with pytest.raises(KeyError):
        layout("telemetry", 7)


def test_equal_layouts_are_one_object() -> None:
    assert layout("truth", 7) is layout("truth", 7)
    assert tick_layout(7) is tick_layout(7)
    assert layout("truth", 7) != LANDING_TABLE.layout("truth", 7)


@pytest.mark.parametrize("kind", [Tick, LandingTick])
def test_messages_are_views_of_one_buffer(kind: type[AnyTick]) -> None:
    tick, names = kind(7), list(kind.table.messages)
    for number, name in enumerate(names, start=1):
        message = getattr(tick, name)
        assert message.shape == (1,)
        assert np.shares_memory(message, tick.buffer)
        message["tick"] = number
    assert [int(tick.buffer[name]["tick"][0]) for name in names] == list(range(1, len(names) + 1))


@pytest.mark.parametrize("kind", [Tick, LandingTick])
def test_tick_declares_the_messages_of_its_table(kind: type[AnyTick]) -> None:
    declared = set(kind.__annotations__) | (set(AnyTick.__annotations__) - {"table"})
    assert declared == set(kind.table.messages)


@pytest.mark.parametrize("table", TABLES, ids=lambda t: t.kind)
def test_tick_holds_the_messages_without_gaps(table: MessageTable) -> None:
    assert table.tick_layout(7).names == tuple(table.messages)
    assert table.tick_layout(7).itemsize == sum(table.layout(name, 7).itemsize for name in table.messages)


@pytest.mark.parametrize("table", TABLES, ids=lambda t: t.kind)
def test_table_has_what_the_recorder_needs(table: MessageTable) -> None:
    assert table.layout("measurement", 6)["q"].shape == (6,)


@pytest.mark.parametrize("bits", [Flag, Limit])
def test_flags_are_distinct_bits(bits: type) -> None:
    flags = [value for name, value in vars(bits).items() if name.isupper()]
    assert flags
    assert all(flag.bit_count() == 1 for flag in flags)
    assert len(set(flags)) == len(flags)


def test_every_limit_has_a_name_and_every_mode_a_number() -> None:
    assert sorted(LIMIT_NAMES) == sorted(value for name, value in vars(Limit).items() if name.isupper())
    modes = [value for name, value in vars(UavMode).items() if name.isupper()]
    assert sorted(modes) == list(range(len(modes)))
