"""`--set KEY=VALUE`: single values of a scenario from the command line, in the language of the scenario's file."""

import tomllib
from typing import Any

from armland.errors import ConfigurationError
from armland.scenario.tables import update


def parse_settings(settings: list[str]) -> dict[str, Any]:
    """Nested values of settings such as `place.catch_m=[0.6, 0.0, 0.86]`; a later one replaces an earlier one.

    Raises:
        ConfigurationError: no key, or a value that is not TOML; all of them.
    """
    data: dict[str, Any] = {}
    problems = []
    for text in settings:
        try:
            update(data, _parse(text))
        except ConfigurationError as e:
            problems.append(str(e))
    if problems:
        raise ConfigurationError("\n  ".join(problems))
    return data


def _parse(text: str) -> dict[str, Any]:
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise ConfigurationError(f"--set {text!r}: expected KEY=VALUE, e.g. place.catch_m='[0.6, 0.0, 0.86]'")
    try:
        found = tomllib.loads(f"{key} = {value}")
    except tomllib.TOMLDecodeError as e:
        raise ConfigurationError(
            f"--set {text!r}: {value.strip()!r} is not a value of TOML, or {key.strip()!r} no dotted key ({e}); text needs "
            f"quotes of its own, e.g. title='\"calm\"'"
        ) from e
    if len(found) != 1:
        raise ConfigurationError(f"--set {text!r}: one key and one value; repeat --set for more")
    return found
