"""From a scenario to a plan: what the controller is told is what the scenario believes, and nothing of the plant."""

import numpy as np
import pytest

from armland.control.laws.table import LAWS, OWN
from armland.errors import ConfigurationError
from armland.mission.plan import plan
from armland.mission.registry import MISSIONS
from armland.models.parameters import plate_mass, uav_parameters
from armland.scenario import load_scenario


def told(overrides=None, mission="landing"):
    return plan(load_scenario("landing", overrides), mission).told


def test_controller_is_told_the_belief_and_not_the_plant():
    plain, believed = told(), told({"belief": {"uav": {"mass_kg": 0.6}}})
    wrong = told({"uav": {"mass_kg": 0.6}, "belief": {"uav": {"mass_kg": 0.48}}})
    assert believed["estimate"]["mass"][0] - plain["estimate"]["mass"][0] == pytest.approx(0.12)
    assert wrong.tobytes() == plain.tobytes()


def test_plant_alone_changes_nothing_that_is_told():
    plain = told()
    for spoilt in ({"imperfections": {"thrust_error": 0.2}}, {"disturbance": {"force_n": [1.0, 0.0, 0.0]}}):
        assert told(spoilt).tobytes() == plain.tobytes()


def test_masses_are_those_of_file_plate_and_load():
    scenario = load_scenario("landing", {"uav": {"extra_mass_kg": 0.05}})
    p = plan(scenario, "landing").told["estimate"]
    assert p["mass"][0] == pytest.approx(uav_parameters(scenario).mass + plate_mass(scenario))
    assert p["mass"][0] - p["body_mass"][0] == pytest.approx(plate_mass(scenario))
    assert p["weight"][0] == pytest.approx(9.81 * p["mass"][0])


def test_limits_of_the_supervisor_are_the_scenarios():
    t = told({"limits": {"torque_rate_nm_s": 777.0, "slip_m": 0.02, "unexplained_n": 4.0, "uav_age_ms": 111.0}})
    np.testing.assert_array_equal(t["limit"]["torque_rate"][0], [777.0] * 7)
    assert t["estimate"]["slip"][0] == 0.02
    assert t["decide"]["watch"]["unexplained"][0] == 4.0
    assert t["decide"]["watch"]["uav_age"][0] == t["limit"]["uav_age"][0] == 111


def test_uav_that_takes_off_flies_off_upwards(landing_plan, takeoff_plan):
    landing, takeoff = (p.told["act"]["uav"]["station"][0] for p in (landing_plan, takeoff_plan))
    np.testing.assert_allclose(takeoff - landing, [0.0, 0.0, landing_plan.scenario.place.start_above_m])
    assert (landing_plan.thrust_n, takeoff_plan.thrust_n) == (landing_plan.weight_n, 0.0)


def test_run_is_bounded_and_watched_as_long_as_the_scenario_says(landing_plan):
    run = landing_plan.scenario.run
    assert landing_plan.ticks == round(run.duration_s * run.rate_hz)
    assert landing_plan.watch == round(run.watch_s * run.rate_hz)


@pytest.mark.parametrize("name", ["E1", "E2", "E3"])
def test_experiment_lasts_as_long_as_its_path_and_limits_the_torque_alone(name):
    made = plan(load_scenario("paper"), name)
    assert made.ticks == len(made.path) == 14500
    p = made.told["limit"]
    assert np.isinf([*p["torque_rate"][0], p["speed_share"][0], p["hinge_max"][0], -p["joint_margin"][0]]).all()
    assert np.isfinite(p["tau_max"]).all()
    assert made.names == ("settle", "follow", "rest", "done", "resting")
    assert made.told["estimate"]["fused"][0] == 0


def test_rows_of_table_two_differ_as_the_scenario_says():
    e1, e3 = (plan(load_scenario("paper"), name).told["act"]["law"] for name in ("E1", "E3"))
    assert (e1["extra_torque"][0], e1["acceleration"][0], e1["support"][0]) == (0, 0, 0)
    assert (e3["extra_torque"][0], e3["acceleration"][0], e3["support"][0]) == (1, 1, 1)


def test_track_flies_any_row_with_its_own_onboard_controller():
    made = plan(load_scenario("compare"), "track", experiment="observer")
    assert made.experiment == "observer"
    assert made.told["estimate"]["observer"]["gain"][0] > 0.0
    onboard = made.scenario.onboard
    assert onboard.controller == "cascade"
    np.testing.assert_allclose(made.told["estimate"]["onboard_kp"][0], onboard.kp_nm)


@pytest.mark.parametrize(
    ("mission", "experiment", "words"),
    [
        ("track", None, "needs the name of an experiment; the scenario has: E1, E2, E3"),
        ("track", "E9", r"experiments\.E9: the scenario has no such experiment; it has: E1, E2, E3"),
        ("dance", None, "mission 'dance' is unknown; known are E1, E2, E3, track, landing, takeoff"),
    ],
)
def test_what_does_not_exist_is_refused(mission, experiment, words):
    with pytest.raises(ConfigurationError, match=words):
        plan(load_scenario("paper"), mission, experiment=experiment)


def test_law_is_the_asked_one_else_the_scenarios_else_the_missions(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(
        "def law(q, omega, r, v, reference, thrust, tau_att, uav, gains):\n    return q[1:] * 0.0, q[1:] * 0.0\n"
    )
    scenario = load_scenario("paper")
    assert plan(scenario, "E1").told["act"]["law"]["law"][0] == LAWS.index("paper")
    assert plan(scenario, "E1", law="exact").told["act"]["law"]["law"][0] == LAWS.index("exact")
    wished = load_scenario("paper", {"control": {"law": "classical"}})
    assert plan(wished, "E1").told["act"]["law"]["law"][0] == LAWS.index("classical")
    own = plan(scenario, "E1", law=f"{file}:law")
    assert own.told["act"]["law"]["law"][0] == OWN
    assert own.told["act"]["law"]["address"][0] != 0
    assert plan(load_scenario("landing"), "landing").told["act"]["law"]["law"][0] == LAWS.index("exact")


@pytest.mark.parametrize("name", MISSIONS)
def test_missions_say_what_they_are(name):
    mission = MISSIONS[name]
    assert mission.name == name
    assert len(mission.summary) > 10
    assert len(mission.doc) > 100
    assert all((mission.judged_as, mission.praise))
    assert len({c.name for c in mission.criteria}) == len(mission.criteria)


def test_table_that_contradicts_itself_is_refused_before_the_arm_is_asked():
    with pytest.raises(ConfigurationError, match=r"must be below lost_offset_m = 0\.003"):
        plan(load_scenario("landing", {"bounds": {"lost_offset_m": 0.003}}), "landing")
