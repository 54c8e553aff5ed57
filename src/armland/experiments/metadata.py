"""What a run log says about its flight: everything that the judge, a report or a figure needs beside the ticks."""

import json
from importlib.metadata import version
from typing import Any

import numpy as np

from armland.mission.plan import Plan
from armland.mission.supervisor.table import FAULTS
from armland.rotations import Array
from armland.scenario import Scenario

SOFTWARE = ("mujoco", "numba", "numpy")
"""Packages whose versions make a difference to the numbers."""

LIMITS = ("q_min", "q_max", "qd_max", "tau_max", "torque_rate", "sigma_min", "hinge_max")
"""Limits of the controller that the judge holds against what happened; infinite ones are none."""


def metadata_of(scenario: Scenario, plan: Plan, put_down: Array) -> dict[str, str]:
    """The metadata of a flight of `plan`; lists of names by commas, everything else that is no text as JSON.

    Args:
        scenario: what is flown.
        plan: of it.
        put_down: (3,) m, D: pivot of a UAV that stands in the cradle's middle; NaN where there is no cradle.
    """
    mission, place = plan.mission, scenario.place
    data: dict[str, Any] = {
        "limits": {name: plan.told["limit"][name][0] for name in LIMITS if np.isfinite(plan.told["limit"][name]).all()},
        "legs": [leg._asdict() for leg in plan.legs],
        "thresholds": plan.thresholds,
        "put_down": np.nan_to_num(put_down),
        "given": place.takeoff_velocity_mps if place.fly_on else (0.0, 0.0, 0.0),
        "criteria": [list(c) for c in mission.criteria],
        "timeouts": dict(mission.timeouts),
        "versions": {name: version(name) for name in SOFTWARE},
    }
    text = {
        "mission": mission.name,
        "title": scenario.title,
        "experiment": plan.experiment or "",
        "law": plan.law_name,
        "seed": str(scenario.run.seed),
        "start": mission.start,
        "judged_as": mission.judged_as,
        "praise": mission.praise,
        "phases": ",".join(plan.names),
        "finals": ",".join(p.name for p in plan.phases if p.final),
        "faults": ",".join(FAULTS),
        "scenario": scenario.model_dump_json(),
        "overrides": scenario.overrides,
    }
    return {**text, **{name: json.dumps(value, default=_plain) for name, value in data.items()}}


def _plain(value: Any) -> Any:
    return np.asarray(value).tolist()
