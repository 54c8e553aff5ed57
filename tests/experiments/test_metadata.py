"""What a log says about its flight."""

import json

import numpy as np

from armland.experiments.metadata import metadata_of
from armland.mission.plan import plan
from armland.scenario import Scenario


def test_metadata_is_text_and_says_what_a_report_needs(landing_scenario):
    made = plan(landing_scenario, "landing")
    found = metadata_of(landing_scenario, made, np.array([0.68, 0.0, 0.701]))
    assert all(isinstance(value, str) for value in found.values())
    assert found["phases"].split(",")[: len(made.names)] == list(made.names)
    assert json.loads(found["limits"])["hinge_max"] == made.told["limit"]["hinge_max"][0]
    assert json.loads(found["put_down"]) == [0.68, 0.0, 0.701]
    assert Scenario.model_validate_json(found["scenario"]).model_dump() == landing_scenario.model_dump()
    assert (found["law"], found["experiment"], found["start"]) == ("exact", "", "air")


def test_limits_that_a_mission_does_not_have_are_left_out(paper_scenario):
    found = metadata_of(paper_scenario, plan(paper_scenario, "E2"), np.full(3, np.nan))
    assert "hinge_max" not in json.loads(found["limits"])
    assert json.loads(found["put_down"]) == [0.0, 0.0, 0.0]
    assert len(json.loads(found["legs"])) == 4
    assert found["experiment"] == "E2"
