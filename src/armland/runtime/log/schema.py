"""The messages as ROS 2 message definitions: what a run log says about itself, made from the table of their fields.

A definition gives type, length and name of each field in the order of its bytes; a comment its meaning, unit and frame.
"""

import math
import re

import numpy as np

from armland.errors import LogError
from armland.records import MESSAGES, Field, Records

SCHEMA_ENCODING = "ros2msg"
MESSAGE_ENCODING = "cdr"

_ROS_TYPES = {"f8": "float64", "u8": "uint64", "i8": "int64"}
_NUMPY_TYPES = {ros: numpy for numpy, ros in _ROS_TYPES.items()}
_FIELD_LINE = re.compile(r"(?P<type>\w+)(\[(?P<length>\d{1,9})\])?\s+(?P<name>\w+)$")


LARGEST = 1000
"""Most fields of a message and most numbers of a field."""


def topic(message: str) -> str:
    """The topic on which a message is recorded."""
    return f"/armland/{message}"


def schema_name(message: str) -> str:
    """The ROS 2 type name of a message, e.g. `armland_msgs/msg/Measurement`."""
    return f"armland_msgs/msg/{message.title()}"


def schema_text(message: str, joints: int) -> str:
    """The definition of a message for an arm with `joints` joints; without an arm, without the fields of its joints.

    Raises:
        KeyError: unknown message; the known ones are the keys of `MESSAGES`.
    """
    return "".join(_line(f, joints) for f in MESSAGES[message])


def _line(field: Field, joints: int) -> str:
    length = math.prod(joints if s == "n" else int(s) for s in field.shape)
    if not length:
        # ROS 2 knows no array without numbers.
        return ""
    array = f"[{length}]" if field.shape else ""
    frame = "" if field.frame == "-" else f", frame {field.frame}"
    return f"{_ROS_TYPES[field.type]}{array} {field.name}  # {field.meaning} [{field.unit}]{frame}\n"


def schema_layout(text: str) -> np.dtype:
    """The dtype that a definition describes.

    Raises:
        LogError: a line that is not a number or a fixed array of numbers of 8 bytes; more numbers than a message has; a name twice.
    """
    spec: list[tuple] = []
    for line in text.splitlines():
        code = line.partition("#")[0].strip()
        if not code:
            continue
        match = _FIELD_LINE.match(code)
        if match is None or match["type"] not in _NUMPY_TYPES:
            raise LogError(
                f"message definition has the line {code[:80]!r}; expected e.g. 'float64[3] r' or 'int64 tick'"
            )
        if match["length"] and not 1 <= int(match["length"]) <= LARGEST:
            raise LogError(f"message definition has the line {code!r}; an array has 1 to {LARGEST} numbers")
        kind = _NUMPY_TYPES[match["type"]]
        spec.append((match["name"], kind, (int(match["length"]),)) if match["length"] else (match["name"], kind))
    if not 1 <= len(spec) <= LARGEST or len({entry[0] for entry in spec}) < len(spec):
        raise LogError(f"message definition has {len(spec)} fields, or two of one name; expected 1 to {LARGEST}")
    return np.dtype(spec)


def converted(rows: Records, target: Records, what: str) -> None:
    """Fill `target` (k,) from `rows` (k,) of an older layout, field by field; what those lack becomes NaN, or 0 in whole numbers.

    Args:
        rows: as they were written.
        target: of today's layout of the message, written.
        what: name of the message.

    Raises:
        LogError: a field that had another length then.
    """
    here = target.dtype.names or ()
    for name in here:
        then, now = rows.dtype[name] if name in (rows.dtype.names or ()) else None, target.dtype[name]
        if then is None:
            target[name] = np.nan if now.base.kind == "f" else 0
        elif math.prod(then.shape) == math.prod(now.shape):
            # A number that today's type cannot hold is damage, not a reason to warn.
            with np.errstate(invalid="ignore"):
                target[name] = rows[name].reshape(target[name].shape)
        else:
            raise LogError(
                f"its field {what}.{name} has {math.prod(then.shape)} numbers where this version has {math.prod(now.shape)}"
            )
