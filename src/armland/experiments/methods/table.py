"""The methods that can be compared, by name: each a mission with the scenario that holds its own best settings."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from armland.errors import ConfigurationError


class Method(NamedTuple):
    """A way to land."""

    mission: str
    scenario: str
    """That comes with armland."""
    summary: str
    overrides: Mapping[str, Any] = MappingProxyType({})
    """What differs from that scenario."""
    law: str | None = None


METHODS: dict[str, Method] = {
    "arm": Method("landing", "landing", "caught in the air and put down by the arm"),
    "arm-paper": Method(
        "landing", "arm-paper", "the arm by the published laws, without observers and feed-forward", law="paper"
    ),
    "unassisted": Method("unassisted", "unassisted", "lands by itself, waits for a quiet moment"),
    "unassisted-untimed": Method(
        "unassisted", "unassisted", "lands by itself as soon as it can", {"descent": {"timed": False}}
    ),
    "hexapod": Method("hexapod", "hexapod", "lands by itself on a pad that six legs hold still"),
    "tether": Method("tether", "tether", "is pulled down by a winch, thrusting against its rope"),
}
"""By name, in the order in which they are shown."""


def method_named(name: str) -> Method:
    """The method of that name.

    Raises:
        ConfigurationError: there is none; the message names those that are.
    """
    if name not in METHODS:
        raise ConfigurationError(f"method {name!r} is unknown; known are {', '.join(METHODS)}")
    return METHODS[name]
