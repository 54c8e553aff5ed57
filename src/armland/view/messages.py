"""The page `docs/records.md`: all messages and their fields, from the tables that also make dtypes and schemas.

Written anew by `python -m armland.view.messages > docs/records.md`.
"""

import inspect
import re

from armland.mission.records import LANDING_TABLE, LIMIT_NAMES, Limit, UavMode
from armland.records import PAPER_TABLE, Field, Flag, MessageTable

_HEAD = """\
# Messages

Made from `armland.records` and `armland.mission.records` by `python -m armland.view.messages > docs/records.md`; edit the
tables there.

One tick of the loop fills each of these messages once. A run log holds them on the topics `/armland/<message>`, all
messages of a tick at the same time; the `kind` in its metadata says which table they are of. `n` is the number of the arm's
joints; units are SI, quaternions scalar first. `armland.runtime.log.read_log` reads a log into arrays.
"""

_PAPER = """\
## The paper's loop (kind `paper`)

Written by `armland paper` and `armland verify`, one log for each experiment.
"""

_LANDING = """\
## Landing and take-off (kind `landing`)

Written by `armland land` and `armland takeoff`. The metadata lists the names of the `phases` and of the `faults`, separated by
commas: `mission.phase` and `mission.fault` count in these lists, from 0.
"""

_TYPES = {"f8": "float64", "u8": "uint64", "i8": "int64"}


def records_markdown() -> str:
    """The page as Markdown."""
    return "\n".join(
        [
            _HEAD,
            _PAPER,
            *_sections(PAPER_TABLE),
            _numbers("Bits of `health.flags`", "bit", Flag),
            _LANDING,
            *_sections(LANDING_TABLE),
            _numbers("Values of `command.uav_mode`", "value", UavMode),
            _limits(),
        ]
    )


def _sections(table: MessageTable) -> list[str]:
    return [_section(name, fields) for name, fields in table.messages.items()]


def _section(name: str, fields: tuple[Field, ...]) -> str:
    lines = [f"### {name}", "", "| field | type | unit | frame | meaning |", "|---|---|---|---|---|"]
    for f in fields:
        array = "".join(f"[{s}]" for s in f.shape)
        lines.append(f"| `{f.name}` | {_TYPES[f.type]}{array} | {f.unit} | {f.frame} | {f.meaning} |")
    return "\n".join(lines) + "\n"


def _numbers(title: str, number: str, names: type) -> str:
    lines = [f"### {title}", "", f"| {number} | name | meaning |", "|---|---|---|"]
    # The meanings are the strings below the names, which Python does not keep.
    for name, value, meaning in re.findall(r'(\w+) = (\d+)\s+"""(.+?)"""', inspect.getsource(names)):
        lines.append(f"| {value} | `{name}` | {meaning} |")
    return "\n".join(lines) + "\n"


def _limits() -> str:
    lines = [
        "### Bits of `health.flags`: limits that the supervisor enforced",
        "",
        "| bit | name | limit |",
        "|---|---|---|",
    ]
    names = {value: name for name, value in vars(Limit).items() if name.isupper()}
    lines += [f"| {bit} | `{names[bit]}` | {meaning.replace('_', ' ')} |" for bit, meaning in LIMIT_NAMES.items()]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(records_markdown(), end="")
