"""Refuses keys of a scenario that the mission does not use, and values that do not fit the arm."""

import numpy as np

from armland.errors import ConfigurationError
from armland.mission.table.mission import Mission
from armland.models.arm import ArmModel
from armland.rotations import Array
from armland.scenario import Scenario

SPEEDS = "arm.joint_speed_rad_s"


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


def joint_speeds(scenario: Scenario, own: frozenset[str], arm: ArmModel) -> Array:
    """Rated speed (n,), rad/s, of each joint; the default's values are repeated for an arm of another number of joints.

    Raises:
        ConfigurationError: the user gave another number of values.
    """
    speeds = scenario.arm.joint_speed_rad_s
    if len(speeds) != arm.joints and SPEEDS in own:
        raise ConfigurationError(
            f"{SPEEDS} has {len(speeds)} value{'s' * (len(speeds) != 1)}; the arm has {arm.joints} joints: "
            f"{', '.join(arm.joint_names)}"
        )
    return np.resize(np.array(speeds), arm.joints)
