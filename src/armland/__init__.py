"""armland simulates, proves, flies and judges the landing of a VTOL UAV that a robot arm catches and puts down.

What a user of Python needs is here, and imported when it is first asked for:

| name | is |
|---|---|
| `load_scenario(path, overrides)` | a scenario from a file, or by the name of one that comes with armland |
| `fly(scenario, mission, seed)` | an episode: result, ticks, log |
| `read_log(path)` | a recorded run |
| `ArmModel` | kinematics and dynamics of a serial arm from URDF or MJCF |
| `laws` | the UAV's laws as functions |
"""

from importlib import import_module
from importlib.metadata import version
from typing import Any

from armland.compiled import drop_stale

__version__ = version("armland")

# Before anything compiled is imported.
drop_stale()

HOMES = {
    "load_scenario": "armland.scenario",
    "fly": "armland.experiments.episode",
    "read_log": "armland.runtime.log",
    "ArmModel": "armland.models.arm",
    "laws": "armland.laws",
}
"""Where each public name stands."""


def __getattr__(name: str) -> Any:
    if name not in HOMES:
        raise AttributeError(f"armland has no {name!r}; it has {', '.join(HOMES)}")
    home = import_module(HOMES[name])
    return home if name == "laws" else getattr(home, name)


def __dir__() -> list[str]:
    return sorted([*globals(), *HOMES])
