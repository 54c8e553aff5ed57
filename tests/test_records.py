"""The layout of the messages: what compiled code, the recorder and a CDR decoder each rely on."""

import re

import numpy as np
import pytest

from armland.records import LIMIT_NAMES, MESSAGES, Field, Limit, Tick, UavMode, layout, tick_layout

FIELDS = [pytest.param(field, id=f"{name}.{field.name}") for name, fields in MESSAGES.items() for field in fields]
JOINTS = [1, 6, 7]


@pytest.mark.parametrize("message", MESSAGES)
def test_field_names_are_unique(message: str) -> None:
    names = [field.name for field in MESSAGES[message]]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("field", FIELDS)
def test_field_is_described_and_named_as_ros_demands(field: Field) -> None:
    assert all([field.unit, field.frame, field.meaning])
    assert re.fullmatch(r"[a-z]([a-z0-9]|_(?!_))*(?<!_)", field.name)
    # A vector says in which frame or of which joints it is; D and W are told apart.
    assert field.frame != "-" or len(field.shape) == 0 or field.name in ("camera_sigma", "foul")


def test_what_the_controller_reads_is_in_the_deck_frame_and_the_truth_in_the_inertial_one() -> None:
    """The controller knows the deck's frame only; the plant's truth is inertial."""
    frames = {name: " ".join(field.frame for field in fields) for name, fields in MESSAGES.items()}
    for name in ("estimate", "reference", "mission", "health", "proof"):
        assert not re.search(r"\bW\b", frames[name])
    assert not re.search(r"\bD\b", frames["truth"])
    assert "W" in frames["truth"]


@pytest.mark.parametrize("message", MESSAGES)
def test_message_begins_with_its_tick(message: str) -> None:
    assert MESSAGES[message][0].name == "tick"
    assert np.issubdtype(layout(message, 7)["tick"], np.integer)


@pytest.mark.parametrize("joints", JOINTS)
@pytest.mark.parametrize("message", MESSAGES)
def test_bytes_are_a_cdr_payload(message: str, joints: int) -> None:
    """CDR aligns a number to its size: with 8-byte numbers only, nothing is padded and offsets follow one another."""
    dtype = layout(message, joints)
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
    assert layout("truth", joints)["rotor_thrust"].shape == (8,)


def test_unknown_message_is_refused() -> None:
    with pytest.raises(KeyError):
        layout("telemetry", 7)


def test_equal_layouts_are_one_object() -> None:
    assert layout("truth", 7) is layout("truth", 7)
    assert tick_layout(7) is tick_layout(7)
    assert layout("truth", 7) != layout("truth", 6)


@pytest.mark.parametrize(
    "buffer", [None, np.zeros(3, np.dtype([("other", "f8"), ("tick", tick_layout(7))]))["tick"][1:2]]
)
def test_messages_are_views_of_one_buffer(buffer: np.ndarray | None) -> None:
    """A buffer of its own, or a field of a larger record."""
    tick = Tick(7, buffer)
    for number, name in enumerate(MESSAGES, start=1):
        message = getattr(tick, name)
        assert message.shape == (1,)
        assert np.shares_memory(message, tick.buffer)
        message["tick"] = number
    assert [int(tick.buffer[name]["tick"][0]) for name in MESSAGES] == list(range(1, len(MESSAGES) + 1))
    assert buffer is None or np.shares_memory(tick.buffer, buffer)


def test_tick_declares_the_messages_of_the_table() -> None:
    assert set(Tick.__annotations__) == set(MESSAGES)


def test_tick_holds_the_messages_without_gaps() -> None:
    assert tick_layout(7).names == tuple(MESSAGES)
    assert tick_layout(7).itemsize == sum(layout(name, 7).itemsize for name in MESSAGES)


def test_flags_are_distinct_bits() -> None:
    flags = [value for name, value in vars(Limit).items() if name.isupper()]
    assert flags
    assert all(flag.bit_count() == 1 for flag in flags)
    assert len(set(flags)) == len(flags)


def test_every_limit_has_a_name_and_every_mode_a_number() -> None:
    assert sorted(LIMIT_NAMES) == sorted(value for name, value in vars(Limit).items() if name.isupper())
    modes = [value for name, value in vars(UavMode).items() if name.isupper()]
    assert sorted(modes) == list(range(len(modes)))
