"""What an operator did, as text: a line of JSON for each message, as it stands in a log and in files."""

import json
from collections.abc import Iterable, Mapping
from itertools import pairwise
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from armland.errors import LogError
from armland.experiments.operator.message import Message
from armland.records import Records
from armland.scenario.refusal import problems

SCRIPT_NAME = "operator.jsonl"
"""Name of a log's attachment that holds the messages."""

MOST_MESSAGES = 10_000

LARGEST = 1 << 22
"""Bytes of a script."""


def text_of(messages: Iterable[Message]) -> str:
    """The messages as text."""
    return "".join(f"{m.model_dump_json(exclude_defaults=False)}\n" for m in messages)


def messages_of(text: str, where: str) -> tuple[Message, ...]:
    """The messages of a text, in the order in which they act.

    Raises:
        LogError: a line that is no message, or more than there may be; with its number and what is wrong.
    """
    lines = [line for line in text.splitlines() if line.strip()]
    if len(lines) > MOST_MESSAGES or len(text) > LARGEST:
        raise LogError(f"{where}: {len(lines)} messages; an operator gives {MOST_MESSAGES} at most")
    found = []
    for number, line in enumerate(lines, start=1):
        try:
            found.append(Message.model_validate_json(line))
        except ValidationError as e:
            raise LogError(f"{where}: line {number}: {'; '.join(problems(e, Message))}") from e
    for earlier, later in pairwise(found):
        if later.tick < earlier.tick:
            raise LogError(f"{where}: tick {later.tick} comes after tick {earlier.tick}; messages stand in their order")
    return tuple(found)


def script_of(attachments: Mapping[str, bytes]) -> tuple[Message, ...]:
    """The messages of a log that was read; none where nobody steered.

    Raises:
        LogError: they are damaged.
    """
    data = attachments.get(SCRIPT_NAME, b"")
    try:
        return messages_of(data.decode(), SCRIPT_NAME)
    except UnicodeDecodeError as e:
        raise LogError(f"{SCRIPT_NAME}: no text: {e}") from e


def first_difference(ticks: Records, other: Records) -> int | None:
    """The first tick in which two records (k,) of `records.tick_layout` differ in a bit or in length; None where they are the same."""
    if ticks.dtype != other.dtype:
        return 0
    count = min(len(ticks), len(other))
    rows, others = (a[:count].view(np.uint8).reshape(count, -1) for a in (ticks, other))
    differs = np.flatnonzero((rows != others).any(axis=1))
    if len(differs):
        return int(differs[0])
    return None if len(ticks) == len(other) else count


def read_script(file: Path) -> tuple[Message, ...]:
    """The messages of a file: a run log (MCAP), or text with a line of JSON for each.

    Raises:
        LogError: it cannot be read, or holds something else.
    """
    from armland.runtime.log import read_log

    if file.suffix == ".mcap" or file.name.endswith(".mcap.part"):
        return script_of(read_log(file).attachments)
    try:
        if file.stat().st_size > LARGEST:
            raise LogError(f"{file}: {file.stat().st_size} bytes are no script of an operator")
        return messages_of(file.read_text("utf-8"), str(file))
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as e:
        why = e.strerror if isinstance(e, OSError) else str(e)
        raise LogError(f"cannot read the operator's script {file}: {why}") from e
