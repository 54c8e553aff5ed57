"""The command `gains`."""

import json
from typing import Annotated

import typer

from armland.cli import options

GAINS_EPILOG = """**Examples**

`armland gains` shows the gains of the law that splits attitude control between board and ground.

`armland gains --attitude 12 --delay-ms 60` asks for less, behind a longer link.

`armland gains --attitude 39 --over-link --delay-ms 30` is about what the published gains ask for, and is refused.
"""


def gains(
    position: Annotated[float, typer.Option(help="Bandwidth of the position, rad/s.")] = 40.0,
    position_damping: Annotated[float, typer.Option(help="Its damping ratio.")] = 1.0,
    attitude: Annotated[float, typer.Option(help="Bandwidth of the attitude, rad/s.")] = 20.0,
    attitude_damping: Annotated[float, typer.Option(help="Its damping ratio.")] = 0.7,
    on_board: Annotated[
        bool, typer.Option("--on-board/--over-link", help="Where the attitude feedback is closed.")
    ] = True,
    delay_ms: Annotated[float | None, typer.Option(help="Uplink delay, ms; the scenario's if absent.")] = None,
    scenario: Annotated[str, typer.Option(help="Scenario that says UAV, rotors and link.")] = "compare",
    as_json: options.AsJson = False,
) -> None:
    """Gains by rule: from wanted bandwidth and damping, with the margins that the delay leaves; refuses what it does not allow."""
    from armland.mission.tuning import designed
    from armland.scenario import load_scenario
    from armland.scenario.control import Poles
    from armland.view.tables.gains import design_data, print_design

    loaded = load_scenario(scenario, {} if delay_ms is None else {"link": {"uplink_delay_ms": delay_ms}})
    # The rule itself refuses what is out of range, and says what would work.
    poles = Poles.model_construct(
        position_rad_s=position,
        position_damping=position_damping,
        attitude_rad_s=attitude,
        attitude_damping=attitude_damping,
    )
    design = designed(loaded.believed(), poles, on_board)
    if as_json:
        print(json.dumps(design_data(design), indent=2))
    else:
        print_design(design)
