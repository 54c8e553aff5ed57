"""The command `gains`."""

import json
from typing import Any

from armland.cli import options

GAINS_EPILOG = """**Examples**

`armland gains` shows the gains of the law that splits attitude control between board and ground.

`armland gains --attitude 12 --delay-ms 60` asks for less, behind a longer link.

`armland gains --attitude 39 --over-link --delay-ms 30` is about what the published gains ask for, and is refused.
"""


@options.taken(
    GAINS_EPILOG,
    position=options.option(float, "Bandwidth of the position, rad/s.", default=40.0),
    position_damping=options.option(float, "Its damping ratio.", default=1.0),
    attitude=options.option(float, "Bandwidth of the attitude, rad/s.", default=20.0),
    attitude_damping=options.option(float, "Its damping ratio.", default=0.7),
    on_board=options.option(bool, "Where the attitude feedback is closed.", "--on-board/--over-link", default=True),
    delay_ms=options.option(float | None, "Uplink delay, ms; the scenario's if absent."),
    scenario=options.option(str, "Scenario that says UAV, rotors and link.", default="compare"),
    as_json=options.AS_JSON,
)
def gains(**given: Any) -> None:
    """Gains by rule: from wanted bandwidth and damping, with the margins that the delay leaves; refuses what it does not allow."""
    from armland.mission.tuning import designed
    from armland.scenario import load_scenario
    from armland.scenario.control import Poles
    from armland.view.tables.gains import design_data, print_design

    delay_ms = given["delay_ms"]
    loaded = load_scenario(given["scenario"], {} if delay_ms is None else {"link": {"uplink_delay_ms": delay_ms}})
    # The rule itself refuses what is out of range, and says what would work.
    poles = Poles.model_construct(
        position_rad_s=given["position"],
        position_damping=given["position_damping"],
        attitude_rad_s=given["attitude"],
        attitude_damping=given["attitude_damping"],
    )
    design = designed(loaded.believed(), poles, given["on_board"])
    if given["as_json"]:
        print(json.dumps(design_data(design), indent=2))
    else:
        print_design(design)
