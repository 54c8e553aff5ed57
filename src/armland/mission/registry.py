"""The missions by name: a new one is a file in `missions/` and a row here."""

from armland.errors import ConfigurationError
from armland.mission.missions.experiments import E1, E2, E3, TRACK
from armland.mission.missions.landing import LANDING
from armland.mission.missions.takeoff import TAKEOFF
from armland.mission.missions.unaided import HEXAPOD, TETHER, UNASSISTED
from armland.mission.table.mission import Mission

MISSIONS: dict[str, Mission] = {m.name: m for m in (E1, E2, E3, TRACK, LANDING, TAKEOFF)}
"""Those of an arm."""

UNAIDED: dict[str, Mission] = {m.name: m for m in (UNASSISTED, HEXAPOD, TETHER)}
"""Those without one: other ways to land, see `mission.unaided`."""


def mission_named(name: str) -> Mission:
    """Look a mission up among those that can be flown.

    Raises:
        ConfigurationError: there is none; the message names those that are.
    """
    if name not in MISSIONS and name not in UNAIDED:
        raise ConfigurationError(f"mission {name!r} is unknown; known are {', '.join([*MISSIONS, *UNAIDED])}")
    return MISSIONS[name] if name in MISSIONS else UNAIDED[name]
