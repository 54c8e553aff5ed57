"""The page `docs/records.md`: all messages and their fields, from the one table that also makes dtypes and schemas.

Written anew by `python -m armland.view.messages > docs/records.md`.
"""

import inspect
import re

from armland.records import MESSAGES, Field, Flag

_HEAD = """\
# Messages

Made from `armland.records` by `python -m armland.view.messages > docs/records.md`; edit the table there.

One tick of the loop fills each of these messages once. A run log holds them on the topics `/armland/<message>`, all
messages of a tick at the same time. `n` is the number of the arm's joints; units are SI, quaternions scalar first.
"""

_TYPES = {"f8": "float64", "u8": "uint64", "i8": "int64"}


def records_markdown() -> str:
    """The page as Markdown."""
    sections = [_section(name, fields) for name, fields in MESSAGES.items()]
    return "\n".join([_HEAD, *sections, _flags()])


def _section(name: str, fields: tuple[Field, ...]) -> str:
    lines = [f"## {name}", "", "| field | type | unit | frame | meaning |", "|---|---|---|---|---|"]
    for f in fields:
        array = "".join(f"[{s}]" for s in f.shape)
        lines.append(f"| `{f.name}` | {_TYPES[f.type]}{array} | {f.unit} | {f.frame} | {f.meaning} |")
    return "\n".join(lines) + "\n"


def _flags() -> str:
    lines = ["## Bits of `health.flags`", "", "| bit | name | meaning |", "|---|---|---|"]
    # The meanings are the strings below the names, which Python does not keep.
    for name, value, meaning in re.findall(r'(\w+) = (\d+)\s+"""(.+?)"""', inspect.getsource(Flag)):
        lines.append(f"| {value} | `{name}` | {meaning} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(records_markdown(), end="")
