"""What the judge is told, from a log's metadata."""

import json

import numpy as np
import pytest

from armland.errors import LogError
from armland.experiments.judge.brief import brief_of, metadata_of
from armland.mission.plan import plan
from armland.plant.scene.composition import build_scene
from armland.scenario import Scenario


def test_brief_is_what_the_metadata_says(brief):
    assert (brief.mission, brief.start, brief.rate_hz, brief.judged_as) == ("landing", "air", 1000, "landing")
    assert brief.finals == {"done", "abort", "holding"}
    np.testing.assert_array_equal(brief.put_down, [0.68, 0.0, 0.701])
    assert brief.criteria[0].bound == 0.15
    assert brief.limits["q_max"].shape == (7,)


def test_legs_are_read_with_their_points(metadata):
    leg = '{"start_s": 1.0, "arrive_s": 2.0, "end_s": 3.0, "origin": [0.0, 0.0, 0.0], "target": [0.1, 0.0, 0.0]}'
    (found,) = brief_of({**metadata, "legs": f"[{leg}]"}).legs
    np.testing.assert_array_equal(found.target - found.origin, [0.1, 0.0, 0.0])


def test_metadata_that_says_too_little_or_nonsense_is_refused(metadata):
    with pytest.raises(LogError, match="damaged"):
        brief_of({**metadata, "limits": "[1"})
    del metadata["criteria"]
    with pytest.raises(LogError, match="no 'criteria'"):
        brief_of(metadata)


def test_metadata_is_text_and_says_what_a_report_needs(landing_scenario):
    made = plan(landing_scenario, "landing")
    found = metadata_of(landing_scenario, made, build_scene(landing_scenario, "free"))
    assert all(isinstance(value, str) for value in found.values())
    assert found["phases"].split(",")[: len(made.names)] == list(made.names)
    assert json.loads(found["limits"])["hinge_max"] == made.told["limit"]["hinge_max"][0]
    assert json.loads(found["put_down"]) == pytest.approx([0.68, 0.0, 0.701])
    assert json.loads(found["hold"]) == {"rating_n": 177.0, "shear_share": 0.2, "share": 0.6}
    assert found["on_cradle"] == "set_down,unload,release,withdraw,done,balancing,secured,braked_down"
    assert json.loads(found["screws"])["joint"] == list(range(7))
    assert float(found["gravity"]) == pytest.approx(9.81, abs=0.01)
    assert Scenario.model_validate_json(found["scenario"]).model_dump() == landing_scenario.model_dump()
    assert (found["law"], found["experiment"], found["start"]) == ("exact", "", "air")


def test_limits_that_a_mission_does_not_have_are_left_out(paper_scenario):
    found = metadata_of(paper_scenario, plan(paper_scenario, "E2"), build_scene(paper_scenario, "hinged"))
    assert "hinge_max" not in json.loads(found["limits"])
    assert json.loads(found["hold"]) is None
    assert json.loads(found["put_down"]) == [0.0, 0.0, 0.0]
    assert len(json.loads(found["legs"])) == 4
    assert found["experiment"] == "E2"
