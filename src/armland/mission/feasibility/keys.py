"""Refuses keys of a scenario that the mission does not use, and values that the user has set and that cannot work for this UAV.

Those left out `models.airframe.sizing` makes.
"""

from armland.errors import ConfigurationError
from armland.mission.belief import Flyer
from armland.mission.table.mission import Mission
from armland.scenario import Scenario

ROOM = 1.05
"""Thrust over weight that a UAV which hovers by itself must be allowed, to come to rest from sinking and to climb."""

LEAST = 0.85
"""Share of the weight that it must be allowed to go down to."""


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


def check_by_hand(scenario: Scenario, flyer: Flyer) -> None:
    """Refuse limits of the UAV's own hover that its weight does not lie between, and an attitude loop that cannot stand on the hinge.

    Args:
        scenario: believed.
        flyer: what flies.

    Raises:
        ConfigurationError: all of them, with value and bound.
    """
    hover, onboard, weight = scenario.onboard.hover, scenario.onboard, flyer.weight
    problems = []
    if hover.thrust_max_n < ROOM * weight:
        problems.append(
            f"onboard.hover.thrust_max_n = {hover.thrust_max_n:g} N lets a UAV of {weight:.3g} N sink; it must be above "
            f"{ROOM * weight:.3g} N, and left out it follows the weight"
        )
    if hover.lift_min_n > LEAST * weight:
        problems.append(
            f"onboard.hover.lift_min_n = {hover.lift_min_n:g} N lets a UAV of {weight:.3g} N rise; it must be below "
            f"{LEAST * weight:.3g} N, and left out it follows the weight"
        )
    fall = flyer.body.mass * flyer.gravity * max(-float(flyer.body.lever[2]), 0.0)
    for axis, kp in zip(("roll", "pitch"), onboard.kp_nm[:2], strict=True):
        if kp <= fall:
            problems.append(
                f"onboard.kp_nm: {kp:g} N·m/rad in {axis} cannot hold the UAV upright on its hinge; it must be above m g l = "
                f"{fall:.3g} N·m/rad, and left out it follows inertia and rotor lag"
            )
    if problems:
        raise ConfigurationError("\n  ".join(problems))


def _used(path: str, uses: tuple[str, ...]) -> bool:
    return any(path == u or path.startswith(f"{u}.") for u in uses)


def _instead(path: str, uses: tuple[str, ...]) -> str:
    table = path.removeprefix("belief.").partition(".")[0]
    near = sorted(u for u in uses if u.startswith(f"{table}."))
    return f"; of [{table}] it uses {', '.join(u.removeprefix(f'{table}.') for u in near)}" if near else ""
