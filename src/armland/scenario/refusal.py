"""What pydantic finds wrong, as one readable message that lists every error with its path, the value and the bound."""

from collections.abc import Iterable
from functools import cache
from typing import Any

from pydantic import BaseModel, ValidationError

from armland.errors import ConfigurationError

MOST_LINES = 30
"""Problems that a message lists; it counts the others."""

BOUNDS = ("greater_than_equal", "less_than_equal", "finite_number")
WORDS = {
    "Value error, ": "",
    "should be an object": "should be a table",
    "should be a valid dictionary": "should be a table",
    "should be a valid tuple": "should be a list",
    "should be a valid array": "should be a list",
    "Tuple should": "list should",
    " after validation": "",
    "Field required": "is missing",
}
"""Words of pydantic -> words of TOML."""


def refusal(error: ValidationError, model: type[BaseModel], head: str) -> ConfigurationError:
    """All of `error`'s problems with a table of kind `model`, below the line `head`."""
    return refused(head, problems(error, model))


def refused(head: str, lines: list[str]) -> ConfigurationError:
    """The error that lists the problems `lines` below the line `head`."""
    shown = lines[:MOST_LINES]
    if len(lines) > MOST_LINES:
        shown.append(f"and {len(lines) - MOST_LINES} more")
    return ConfigurationError("\n  ".join([f"{head}: {len(lines)} problem{'s' * (len(lines) != 1)}", *shown]))


def problems(error: ValidationError, model: type[BaseModel], head: str = "") -> list[str]:
    """Each of pydantic's errors about `model` in one line that begins with `head` and the path."""
    return [line for e in error.errors(include_url=False) if not _empty(e) for line in _lines(e, model, head)]


def _empty(error: Any) -> bool:
    # Pydantic calls a list whose items are wrong too short as well, whatever its length.
    return error["type"] == "too_short" and len(error["input"]) >= error["ctx"]["min_length"]


def _lines(error: Any, model: type[BaseModel], head: str) -> Iterable[str]:
    location = tuple(step for step in error["loc"] if step != "[key]")
    where = ".".join(map(str, location))
    message = error["msg"]
    for words, plain in WORDS.items():
        message = message.replace(words, plain)
    if error["type"] == "extra_forbidden":
        message = f"unknown key; known here: {', '.join(sorted(_node(model, location[:-1]).get('properties', {})))}"
    elif error["type"] in BOUNDS and "maximum" in (node := _node(model, location)):
        message = f"{_short(error['input'])} lies outside {node['minimum']:g} to {node['maximum']:g}"
    elif error["type"] not in ("missing", "value_error"):
        message += f" (got {_short(error['input'])})"
    elif location == ("link",):
        message += ", and no `base` has it: base = 'landing' or 'paper'"
    # A check of a whole table has a line for each of its problems.
    return (": ".join(part for part in (head, where, line) if part) for line in message.split("\n"))


def _short(value: Any) -> str:
    text = repr(value) if not isinstance(value, dict) else "a table"
    return text if len(text) <= 60 else text[:57] + "..."


@cache
def _schema(model: type[BaseModel]) -> dict[str, Any]:
    return model.model_json_schema()


def _node(model: type[BaseModel], location: tuple[Any, ...]) -> dict[str, Any]:
    # Walks the schema along the error's path: table names by property, list items and mapping values by their type.
    root = _schema(model)
    node = root
    for step in location:
        items = node.get("prefixItems")
        if step in node.get("properties", {}):
            node = node["properties"][step]
        elif items and isinstance(step, int) and step < len(items):
            node = items[step]
        else:
            node = node.get("items") or node.get("additionalProperties") or {}
        node = _resolved(root, node if isinstance(node, dict) else {})
    return node


def _resolved(root: dict[str, Any], node: dict[str, Any]) -> dict[str, Any]:
    for one in node.get("anyOf", ()):
        if one.get("type") != "null":
            node = one
    if "$ref" in node:
        return root["$defs"][node["$ref"].rsplit("/", 1)[1]]
    return node
