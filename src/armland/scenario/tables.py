"""Nested tables as TOML gives them: checked for what no scenario needs, merged, walked by dotted path."""

import json
from typing import Any

from armland.errors import ConfigurationError

DEEPEST = 12
"""Levels of tables and lists; a scenario needs six."""

LARGEST_INTEGER = 2**63


def orderly(data: dict[str, Any], name: str) -> dict[str, Any]:
    """`data`, once it is sure that it can be walked, printed and written.

    Args:
        data: tables from outside.
        name: of their file, for the message.

    Raises:
        ConfigurationError: tables or lists that are nested too deeply, a name that is no text, an integer beyond 2⁶³,
            text that is no Unicode.
    """
    level: list[Any] = [data]
    for _ in range(DEEPEST):
        inner: list[Any] = []
        for value in level:
            if isinstance(value, dict):
                inner += [*value.keys(), *value.values()]
                if not all(isinstance(key, str) for key in value):
                    raise ConfigurationError(f"{name}: the names of keys must be text")
            elif isinstance(value, list | tuple):
                inner += value
            elif isinstance(value, int) and abs(value) > LARGEST_INTEGER:
                raise ConfigurationError(f"{name}: an integer of {value.bit_length()} bits; it may have 63")
            elif isinstance(value, str) and not value.isascii():
                _encodable(value, name)
        level = inner
        if not level:
            return data
    raise ConfigurationError(f"{name}: tables or lists are nested too deeply; a scenario needs six levels")


def _encodable(text: str, name: str) -> None:
    try:
        text.encode("utf-8")
    except UnicodeEncodeError as e:
        raise ConfigurationError(f"{name}: {text[:60]!a} is no Unicode text") from e


def as_json(data: Any) -> str:
    """JSON of nested tables; arrays become lists, and what JSON does not know becomes text."""
    return json.dumps(data, default=lambda value: value.tolist() if hasattr(value, "tolist") else str(value))


def update(data: dict[str, Any], extra: dict[str, Any]) -> None:
    """Replace values of the nested tables `data` by those of `extra`, in place."""
    for key, value in extra.items():
        if isinstance(value, dict) and isinstance(data.get(key), dict):
            update(data[key], value)
        else:
            data[key] = value


def leaves(data: dict[str, Any], head: str = "") -> list[str]:
    """Dotted paths of all values of nested tables; lists are values."""
    out: list[str] = []
    for key, value in data.items():
        if isinstance(value, dict) and value:
            out += leaves(value, f"{head}{key}.")
        else:
            out.append(f"{head}{key}")
    return out


def take(data: dict[str, Any], path: str) -> Any:
    """The value at a dotted path, taken out; tables that are empty then go too; None where there is none."""
    head, _, rest = path.partition(".")
    if not rest:
        return data.pop(head, None)
    inner = data.get(head)
    if not isinstance(inner, dict):
        return None
    value = take(inner, rest)
    if not inner:
        del data[head]
    return value


def put(data: dict[str, Any], path: str, value: Any) -> bool:
    """Set the value at a dotted path where nothing stands yet; false where something does."""
    head, _, rest = path.partition(".")
    if not rest:
        return data.setdefault(head, value) is value
    inner = data.setdefault(head, {})
    return isinstance(inner, dict) and put(inner, rest, value)
