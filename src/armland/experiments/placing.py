"""Where an arm lands if the scenario's places do not work for it.

They move where the user left them to armland; where he set them, he is told which would work.
"""

from collections.abc import Callable
from typing import TypeVar

from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.feasibility.placing import BEST, MOST, alternatives, kept, refused, told_places
from armland.mission.table.mission import Mission
from armland.models.description import ASSETS, resolve
from armland.scenario import Scenario

Made = TypeVar("Made")


def placed(
    scenario: Scenario, mission: Mission, refusal: WorkspaceError, make: Callable[[Scenario], Made]
) -> tuple[Made, str]:
    """What `make` makes of the scenario with places at which its arm can land, and a line that says which and why.

    Args:
        scenario: whose places were refused.
        mission: one with way points.
        refusal: why.
        make: prepares a flight, or refuses it.

    Raises:
        WorkspaceError: the refusal with the nearest place that works, where nothing may move: the arm is the one for which the places
            are made, or the user set both; or with the word that there is none.
    """
    keep = kept(scenario)
    if resolve(scenario.arm.file).parent != ASSETS and len(keep) < 2:
        for tried, one in enumerate(alternatives(scenario, mission, keep, BEST)):
            try:
                return make(one), f"{told_places(one, scenario)} chosen, because {refusal}"
            except ConfigurationError:
                if tried + 1 >= MOST:
                    break
    raise refused(scenario, mission, refusal, make) from refusal
