"""Refuses keys of a scenario that the mission does not use."""

from armland.errors import ConfigurationError
from armland.mission.table.mission import Mission


def check_keys(own: frozenset[str], mission: Mission) -> None:
    """Refuse keys that the mission does not use.

    Args:
        own: dotted paths of the keys that the user set.
        mission: whose `uses` says what it uses.

    Raises:
        ConfigurationError: all of them, by path, and what of their table the mission does use.
    """
    unused = sorted(path for path in own if not _used(path.removeprefix("belief."), mission.uses))
    if unused:
        lines = [f"{path}: not used by the mission {mission.name!r}{_instead(path, mission.uses)}" for path in unused]
        raise ConfigurationError("\n  ".join(["keys without effect:", *lines]))


def _used(path: str, uses: tuple[str, ...]) -> bool:
    return any(path == u or path.startswith(f"{u}.") for u in uses)


def _instead(path: str, uses: tuple[str, ...]) -> str:
    table = path.removeprefix("belief.").partition(".")[0]
    near = sorted(u for u in uses if u.startswith(f"{table}."))
    return f"; of [{table}] it uses {', '.join(u.removeprefix(f'{table}.') for u in near)}" if near else ""
