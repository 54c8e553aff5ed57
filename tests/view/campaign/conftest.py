"""A report of rows that are made up: two points, two drawn parameters, failures in strong wind."""

import json

import numpy as np
import pytest

from armland.experiments.campaign.answers.report import report
from armland.experiments.campaign.description import Description
from armland.experiments.campaign.design import Schedule
from armland.experiments.campaign.engine import Campaign
from armland.experiments.campaign.rows import Job, Row
from armland.experiments.campaign.store import Store
from armland.experiments.campaign.versions import versions

DESCRIBED = {
    "title": "Wind & <load>",
    "parameters": {
        "air.wind_mps": {"uniform": [0.0, 12.0]},
        "uav.extra_mass_kg": {"uniform": [0.0, 0.1]},
        "sea.state": {"sweep": ["calm", "ss2"]},
    },
}


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """Store, report and table."""
    file = tmp_path_factory.mktemp("made") / "study.sqlite"
    campaign = Campaign(
        Description.model_validate_json(json.dumps(DESCRIBED)),
        Job('{"values": {}}', "landing"),
        120,
        {"hinge_force_max_n": 40.0},
    )
    rng = np.random.default_rng(0)
    with Store(file, write=True) as store:
        store.describe(campaign.about())
        for task in Schedule(campaign.description, campaign.runs).tasks():
            wind = task.values["air.wind_mps"]
            success = wind + 3.0 * (task.values["sea.state"] == "ss2") + rng.normal() < 10.0
            result = {
                "seed": task.seed,
                "success": bool(success),
                "reason": "landed" if success else f"lost at {wind:.1f} m/s (gust), then more",
                "phases": [{"name": "done", "start_s": 0.0, "end_s": 15.0 + wind}],
                "hinge_force_max_n": 20.0 + 2.0 * wind,
                "touchdown": {"speed_mps": 0.03, "tilt_deg": 1.0, "offset_m": 0.004} if success else {},
            }
            row = Row(*task, success=bool(success), outcome="done", result=result, digest="ab", cpu_s=0.5)
            store.add(
                row if task.run != 7 else Row(*task, success=False, outcome="refused", error="no place"),
                json.dumps(versions()),
            )
        return (file, *report(store))
