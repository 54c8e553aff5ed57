"""The page `docs/records.md`: all messages and their fields, from the table that also makes dtypes and schemas."""

import inspect
import re

from armland.records import LIMIT_NAMES, MESSAGES, Field, Limit, UavMode

_HEAD = """\
# Messages

Made from `armland.records` by `make pages`; edit the table there.

One tick of the loop fills each of these messages once, whatever the mission. A run log holds them on the topics `/armland/<message>`,
all messages of a tick at the same time. `n` is the number of the arm's joints; units are SI, quaternions scalar first. Frames: `W`
inertial, z up; `D` deck, in which arm base, cradle and camera mount rest, on land the same as W; `B` UAV body; `E` end effector.

The metadata of a log lists the names of the `phases` and of the `faults`, separated by commas: `mission.phase` and `mission.fault`
count in these lists, from 0. `armland log FILE` says what a log holds, `armland report FILE` makes its figures, tables and
result.json, and `armland.read_log` reads it into arrays ([python.md](python.md)).
"""

_TYPES = {"f8": "float64", "u8": "uint64", "i8": "int64"}


def records_markdown() -> str:
    """The page as Markdown."""
    sections = [_section(name, fields) for name, fields in MESSAGES.items()]
    return "\n".join([_HEAD, *sections, _modes(), _limits()])


def _section(name: str, fields: tuple[Field, ...]) -> str:
    lines = [f"## {name}", "", "| field | type | unit | frame | meaning |", "|---|---|---|---|---|"]
    for f in fields:
        array = "".join(f"[{s}]" for s in f.shape)
        lines.append(f"| `{f.name}` | {_TYPES[f.type]}{array} | {f.unit} | {f.frame} | {f.meaning} |")
    return "\n".join(lines) + "\n"


def _modes() -> str:
    lines = ["## Values of `command.uav_mode`", "", "| value | name | meaning |", "|---|---|---|"]
    # The meanings are the strings below the names, which Python does not keep.
    for name, value, meaning in re.findall(r'(\w+) = (\d+)\s+"""(.+?)"""', inspect.getsource(UavMode)):
        lines.append(f"| {value} | `{name}` | {meaning} |")
    return "\n".join(lines) + "\n"


def _limits() -> str:
    lines = ["## Bits of `health.flags`", "", "| bit | name | limit |", "|---|---|---|"]
    names = {value: name for name, value in vars(Limit).items() if name.isupper()}
    lines += [f"| {bit} | `{names[bit]}` | {meaning.replace('_', ' ')} |" for bit, meaning in LIMIT_NAMES.items()]
    return "\n".join(lines) + "\n"
