"""The command `uav`."""

import json
from typing import TYPE_CHECKING, Any

from armland.cli import options

if TYPE_CHECKING:
    from rich.console import Console

    from armland.scenario import Scenario

UAV_EPILOG = """**Examples**

`armland uav x500` says what is known of a UAV that comes with armland: each value with unit and source, what it can do, what it needs.

`armland uav my_uav.toml` does so for a file of yours, `armland uav my_uav.xml` for an MJCF file with the sites cm, pivot, rotor_1 ...

`armland uav my_uav.toml --set uav.extra_mass_kg=0.4` asks the same of the UAV with a load.

`armland uav hexa10 --json | jq .survey.magnet` prints it as data.

`armland land --uav my_uav.toml` lands it.
"""


@options.taken(
    UAV_EPILOG,
    uav=options.argument(str, "TOML or MJCF file, or the name of a UAV that comes with armland.", "ardrone2"),
    settings=options.SETTINGS,
    as_json=options.AS_JSON,
)
def uav(**given: Any) -> None:
    """Say what is known of a UAV, from where each value comes, what it can do, what it needs, and what is suspicious."""
    from armland.models.airframe.sizing import sized
    from armland.models.airframe.survey import differs, survey, suspicious
    from armland.models.airframe.table import rows_of
    from armland.view.tables.uav import print_uav, uav_data

    scenario = sized(options.load("landing", given))
    rows, found = rows_of(scenario), survey(scenario)
    notes, odd = differs(scenario), suspicious(scenario, found)
    if given["as_json"]:
        print(json.dumps(uav_data(rows, found, notes, odd), indent=2))
    else:
        print_uav(rows, found, notes, odd)


def tell_uav(scenario: "Scenario", console: "Console") -> None:
    """Print what differs between a UAV and what is believed of it, and what of its numbers is suspicious."""
    from armland.models.airframe.sizing import sized
    from armland.models.airframe.survey import differs, survey, suspicious

    whole = sized(scenario)
    for line in (*differs(whole), *suspicious(whole, survey(whole))):
        console.print(f"uav: {line}", highlight=False, markup=False, soft_wrap=True)
