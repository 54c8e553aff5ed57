"""The path of an experiment: a home from which the arm can follow it, or a refusal that names the place."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.feasibility.path import survey_path
from armland.models.parameters import arm_model
from armland.scenario import load_scenario


def surveyed(overrides):
    scenario = load_scenario("paper", overrides)
    return survey_path(arm_model(scenario), scenario)


def test_path_begins_where_the_home_pose_has_the_end_effector_upright():
    work, arm = surveyed({}), arm_model(load_scenario("paper"))
    arm.update(work.home, np.zeros(7))
    np.testing.assert_allclose(arm.position, work.path[0, :3], atol=1e-4)
    np.testing.assert_allclose(work.R_d[:, 2], [0.0, 0.0, 1.0], atol=1e-12)
    np.testing.assert_allclose(arm.rotation, work.R_d, atol=2e-3)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        ({"trajectory": {"start_m": [1.3, 0.0, 0.74]}}, "cannot hold its end effector upright"),
        ({"arm": {"home_rad": [0.0, 1.0]}}, "home_rad has 2 values; the arm has 7 joints"),
        ({"arm": {"elbow_joint": "knee"}}, "the arm has no joint 'knee'"),
    ],
)
def test_refusals(overrides, words):
    with pytest.raises(ConfigurationError, match=words):
        surveyed(overrides)


def test_scenario_without_a_path_is_refused():
    scenario = load_scenario("landing").model_copy(update={"trajectory": None})
    with pytest.raises(ConfigurationError, match="the scenario has none"):
        survey_path(arm_model(scenario), scenario)
