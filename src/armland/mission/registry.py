"""The missions by name: a new one is a file in `missions/` and a row here."""

from armland.errors import ConfigurationError
from armland.mission.missions.experiments import E1, E2, E3, TRACK
from armland.mission.missions.landing import LANDING
from armland.mission.missions.takeoff import TAKEOFF
from armland.mission.table.mission import Mission

MISSIONS: dict[str, Mission] = {m.name: m for m in (E1, E2, E3, TRACK, LANDING, TAKEOFF)}


def mission_named(name: str) -> Mission:
    """Look a mission up among those that can be flown.

    Raises:
        ConfigurationError: there is none; the message names those that are.
    """
    if name not in MISSIONS:
        raise ConfigurationError(f"mission {name!r} is unknown; known are {', '.join(MISSIONS)}")
    return MISSIONS[name]
