"""The command `arm`."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from armland.cli import options

if TYPE_CHECKING:
    from rich.console import Console

    from armland.scenario import Scenario

ARM_EPILOG = """**Examples**

`armland arm my_arm.urdf` says what is read from a file: each joint's limits with their source, reach, payload, what is suspicious.

`armland arm my_arm.urdf --ee flange:x` mounts the tool along the flange's x axis.

`armland arm my_arm.urdf --torque-limits 87,87,87,87,12,12,12 --lock rail=0.2` says what the file does not.

`armland arm panda_mj_description --picture` takes an arm of the package robot_descriptions and draws it, in out/arm/arm.png.

`armland arm my_arm.xml --json | jq .payload_kg` prints the same as data.
"""


@options.taken(
    ARM_EPILOG,
    arm=options.argument(
        str, "URDF or MJCF file, or a name that mujoco-menagerie or robot_descriptions has.", "lwr4.xml"
    ),
    **options.OF_ARM,
    picture=options.option(bool, "Draw the arm in a pose that points upwards, arm.png.", "--picture", default=False),
    out=options.option(Path, "Folder for the picture.", default=Path("out") / "arm"),
    as_json=options.AS_JSON,
)
def arm(**given: Any) -> None:
    """Say what is read from an arm's file, from where each value comes, what the arm can carry, and what is suspicious."""
    from armland.control.laws.realisation import elbow_of
    from armland.models.arm_file.checks import suspicious
    from armland.models.arm_file.survey import survey
    from armland.models.arm_file.words import lines
    from armland.models.parameters import arm_file, arm_model
    from armland.view.tables.arm import arm_data, print_arm

    own = given["arm"] == "lwr4.xml"
    scenario = options.load("landing", {**given, "arm": None if own else given["arm"]})
    file, model = arm_file(scenario), arm_model(scenario)
    found = survey(model, elbow_of(scenario, model))
    notes, odd = lines(file), suspicious(file, found.held)
    if given["as_json"]:
        print(json.dumps(arm_data(file, found, notes, odd), indent=2))
    else:
        print_arm(file, found, notes, odd)
    if given["picture"]:
        _draw(scenario, found.pose, given["out"])


def tell_arm(scenario: "Scenario", console: "Console") -> None:
    """Print what was made of the file of an arm that does not come with armland."""
    from armland.models.arm_file.checks import suspicious
    from armland.models.arm_file.strength import held
    from armland.models.arm_file.words import lines
    from armland.models.description import ASSETS, resolve
    from armland.models.parameters import arm_file, arm_model

    if resolve(scenario.arm.file).parent == ASSETS:
        return
    file = arm_file(scenario)
    for line in (*lines(file), *suspicious(file, held(arm_model(scenario).model))):
        console.print(f"arm: {line}", highlight=False, markup=False, soft_wrap=True)


def joints_of(scenario: "Scenario") -> int:
    """Number of joints of the arm, for which code is compiled."""
    from armland.models.parameters import arm_model

    return arm_model(scenario).joints


def _draw(scenario: "Scenario", pose: Any, out: Path) -> None:
    from armland.cli.exits import attempted, say
    from armland.models.description import compile_spec
    from armland.models.parameters import arm_spec
    from armland.plant.scene.surroundings import add_surroundings
    from armland.vision.picture import render

    spec = arm_spec(scenario)
    add_surroundings(spec)
    with attempted("picture"):
        say(f"picture: {render(compile_spec(spec, 'the arm'), pose, out / 'arm.png')}")
