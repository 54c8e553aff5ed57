"""The messages as ROS 2 message definitions: what a run log says about itself, made from the table of their fields.

A definition gives type, length and name of each field in the order of its bytes; a comment its meaning, unit and frame.
"""

import math
import re
from itertools import zip_longest

import numpy as np

from armland.errors import LogError
from armland.records import Field, MessageTable

SCHEMA_ENCODING = "ros2msg"
MESSAGE_ENCODING = "cdr"

_ROS_TYPES = {"f8": "float64", "u8": "uint64", "i8": "int64"}
_NUMPY_TYPES = {ros: numpy for numpy, ros in _ROS_TYPES.items()}
_FIELD_LINE = re.compile(r"(?P<type>\w+)(\[(?P<length>\d+)\])?\s+(?P<name>\w+)$")


def topic(message: str) -> str:
    """The topic on which a message is recorded."""
    return f"/armland/{message}"


def schema_name(table: MessageTable, message: str) -> str:
    """The ROS 2 type name of a message, e.g. `armland_msgs/msg/Measurement`."""
    return f"armland_msgs/msg/{table.prefix}{message.title().replace('_', '')}"


def schema_text(table: MessageTable, message: str, joints: int) -> str:
    """The definition of a message for an arm with `joints` joints.

    Raises:
        KeyError: unknown message; the known ones are the keys of the table's `messages`.
    """
    return "".join(_line(f, joints) for f in table.messages[message])


def _line(field: Field, joints: int) -> str:
    length = math.prod(joints if s == "n" else int(s) for s in field.shape)
    array = f"[{length}]" if field.shape else ""
    frame = "" if field.frame == "-" else f", frame {field.frame}"
    return f"{_ROS_TYPES[field.type]}{array} {field.name}  # {field.meaning} [{field.unit}]{frame}\n"


def schema_layout(text: str) -> np.dtype:
    """The dtype that a definition describes.

    Raises:
        LogError: a line that is not a number or a fixed array of numbers of 8 bytes.
    """
    spec: list[tuple] = []
    for line in text.splitlines():
        code = line.partition("#")[0].strip()
        if not code:
            continue
        match = _FIELD_LINE.match(code)
        if match is None or match["type"] not in _NUMPY_TYPES:
            raise LogError(f"message definition has the line {code!r}; expected e.g. 'float64[3] r' or 'int64 tick'")
        kind = _NUMPY_TYPES[match["type"]]
        spec.append((match["name"], kind, (int(match["length"]),)) if match["length"] else (match["name"], kind))
    return np.dtype(spec)


def check_schema(table: MessageTable, message: str, joints: int, text: str) -> None:
    """Accept a stored definition that describes the same bytes as today's table; comments may differ.

    Raises:
        LogError: another layout, with the first field that differs.
    """
    stored, known = schema_layout(text), table.layout(message, joints)
    if stored == known:
        return
    for there, here in zip_longest(stored.descr, known.descr):
        if there != here:
            raise LogError(
                f"the log was written with another layout of '{message}': it has {_describe(there)} where this version "
                f"has {_describe(here)}; read it with the armland version that its metadata names"
            )


def _describe(entry: tuple | None) -> str:
    if entry is None:
        return "no further field"
    length = f"[{entry[2][0]}]" if len(entry) > 2 else ""
    return f"'{_ROS_TYPES[entry[1][1:]]}{length} {entry[0]}'"
