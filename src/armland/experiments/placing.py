"""Where an arm lands if the scenario's places do not work for it.

They move where the user left them to armland; where he set them, he is told which would work.
"""

from collections.abc import Callable
from typing import TypeVar

from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.feasibility.places import Place
from armland.mission.feasibility.placing import BEST, MOST, alternatives, kept, nowhere, refused, told_places
from armland.mission.table.mission import Mission
from armland.models.arm_file.reading import read_tree
from armland.models.arm_file.tip import further_out
from armland.models.description import ASSETS, resolve
from armland.models.parameters import arm_file
from armland.scenario import Scenario

Made = TypeVar("Made")


def mounted_further(scenario: Scenario, nowhere: WorkspaceError, make: Callable[[Scenario], Made]) -> tuple[Made, str]:
    """What `make` makes of the scenario with the tool at the next frame further out, and a line that says which and why.

    Args:
        scenario: for whose arm no place was found.
        nowhere: that refusal.
        make: prepares a flight, or refuses it.

    Raises:
        WorkspaceError: `nowhere`, where the user chose the frame, none is further out, or that one does not help either.
    """
    end = arm_file(scenario).chain.tip
    found = further_out(read_tree(resolve(scenario.arm.file)), end) if scenario.arm.ee is None else None
    if found is None:
        raise nowhere
    name, gain = found
    try:
        made = make(scenario.replaced({"arm": {"ee": name}}))
    except ConfigurationError as e:
        raise nowhere from e
    return made, f"arm.ee = {name!r} chosen, {1e3 * gain:.0f} mm further out than {end.label!r}, because {nowhere}"


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
    keep, seen = kept(scenario), list[Place]()
    if resolve(scenario.arm.file).parent != ASSETS and len(keep) < 2:
        for tried, one in enumerate(alternatives(scenario, mission, keep, BEST, seen)):
            try:
                return make(one), f"{told_places(one, scenario)} chosen, because {refusal}"
            except ConfigurationError:
                if tried + 1 >= MOST:
                    break
        if not keep and not seen:
            # A search takes a minute: the nearest of none need not be looked for.
            raise WorkspaceError(f"{refusal}. {nowhere(scenario, mission)}") from refusal
    raise refused(scenario, mission, refusal, make) from refusal
