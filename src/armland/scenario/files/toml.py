"""A TOML file as tables, with the errors of somebody else's file as messages."""

import re
import tomllib
from pathlib import Path
from typing import Any

from armland.errors import ConfigurationError
from armland.scenario.tables import orderly

LARGEST = 1_000_000
"""Bytes of a scenario file; a larger one is not one."""

DEEP = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){32}""")
"""A dotted key of more parts than any scenario has tables: the parser's memory grows with the square of them."""


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file.

    Raises:
        ConfigurationError: it cannot be read, is too large, or is not TOML.
    """
    too_deep = ConfigurationError(f"{path.name}: tables or lists are nested too deeply; a scenario needs six levels")
    try:
        text = text_of(path)
        if DEEP.search(text):
            raise too_deep
        return orderly(tomllib.loads(text), path.name)
    except RecursionError as e:
        raise too_deep from e
    except ValueError as e:
        # Besides errors of TOML and of UTF-8, an integer of thousands of digits.
        raise ConfigurationError(f"{path.name} is not valid TOML: {e}") from e


def text_of(path: Path) -> str:
    """The text of a file.

    Raises:
        ConfigurationError: it cannot be read, or is too large.
    """
    try:
        size = path.stat().st_size
        if size > LARGEST:
            raise ConfigurationError(f"{path.name} has {size} bytes; a scenario has at most {LARGEST}")
        return path.read_text(encoding="utf-8-sig")
    except OSError as e:
        raise ConfigurationError(f"{path.name} cannot be read: {e.strerror}") from e
