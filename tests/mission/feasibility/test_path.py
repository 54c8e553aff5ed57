"""The path of an experiment: a home from which the arm can follow it, or a refusal; the box in which the arm follows the plate."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.feasibility.path import room, survey_path
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


def landing(**sections):
    return load_scenario("landing", sections)


def half_width(scenario):
    """Of the corridor, m: half of what the arm leaves of the slot, less the clearance."""
    return 0.5 * (scenario.cradle.gap_m - scenario.arm.width_m) - scenario.control.approach.clearance_m


def beside(scenario, corner):
    """How far (m) a place lies beside the middle of the slot."""
    angle = np.deg2rad(scenario.cradle.heading_deg)
    across = np.array([-np.sin(angle), np.cos(angle)])
    return abs(across @ (corner[:2] - np.array(scenario.place.put_down_m)[:2]))


def turned(heading):
    """The landing with its slot turned, the catch a little along it."""
    place, angle = landing().place, np.deg2rad(heading)
    x, y, _ = place.put_down_m
    catch = [x + 0.03 * np.cos(angle), y + 0.03 * np.sin(angle), place.catch_m[2]]
    return landing(cradle={"heading_deg": heading}, place={"catch_m": catch})


def corners(box):
    return np.stack(np.meshgrid(*box.T), axis=-1).reshape(-1, 3)


@pytest.mark.parametrize("heading", [0.0, 90.0, 180.0, -90.0])
def test_arm_anywhere_in_the_room_stays_clear_of_the_rails(heading):
    scenario = turned(heading)
    box, catch = room(scenario, "air"), np.array(scenario.place.catch_m)
    assert (box[0] <= catch).all()
    assert (catch <= box[1]).all()
    assert max(beside(scenario, c) for c in corners(box)) <= half_width(scenario) + 1e-12
    # Along the slot and upwards it is as wide as the UAV may err.
    reach = scenario.bounds.uav_error_m
    along = round(heading / 90.0) % 2
    np.testing.assert_allclose(box[:, along], [catch[along] - reach, catch[along] + reach])
    assert box[1, 2] == pytest.approx(catch[2] + reach)
    assert box[0, 2] == pytest.approx(catch[2] - reach - scenario.place.standoff_m)


@pytest.mark.parametrize("heading", [5.0, -10.0, 45.0, 100.0])
def test_askew_slot_is_kept_clear_of_as_well_or_leaves_the_catch_alone(heading):
    """The box takes what is inside for all of it; where nothing is, it shrinks to the catch."""
    scenario = turned(heading)
    box, catch = room(scenario, "air"), np.array(scenario.place.catch_m)
    assert (box[0] <= catch).all()
    assert (catch <= box[1]).all()
    reach = [beside(scenario, c) <= half_width(scenario) + 1e-12 for c in corners(box)]
    collapsed = np.isclose(box[0, :2], catch[:2]) & np.isclose(box[1, :2], catch[:2])
    assert all(reach) or collapsed.any()


def test_wider_slot_leaves_more_room():
    narrow, wide = (room(landing(cradle={"gap_m": gap}), "air") for gap in (0.23, 0.25))
    np.testing.assert_allclose(np.ptp(wide, axis=0)[1] - np.ptp(narrow, axis=0)[1], 0.02, atol=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_catch_beside_the_corridor_is_refused_with_its_width(side):
    plain = landing()
    x, y, z = plain.place.catch_m
    half = half_width(plain)
    inside = landing(place={"catch_m": [x, y + side * 0.9 * half, z]})
    assert max(beside(inside, c) for c in corners(room(inside, "air"))) <= half + 1e-12
    with pytest.raises(ConfigurationError) as e:
        room(landing(place={"catch_m": [x, y + side * (half + 0.01), z]}), "air")
    for word in (f"{1e3 * (half + 0.01):.0f} mm beside", "corridor", f"{1e3 * half:.0f} mm wide", "cradle.gap_m"):
        assert word in str(e.value)


def test_room_of_a_take_off_is_about_the_cradles_middle():
    """Wherever the catch is: the arm that grips a UAV on the cradle has nothing to do there."""
    scenario = landing(place={"catch_m": [0.62, 0.2, 0.86]})
    box, middle, reach = room(scenario, "cradle"), np.array(scenario.place.put_down_m), scenario.bounds.uav_error_m
    np.testing.assert_allclose(box[:, 0], [middle[0] - reach, middle[0] + reach])
    assert max(beside(scenario, c) for c in corners(box)) <= half_width(scenario) + 1e-12
    np.testing.assert_allclose(box[:, 2], [middle[2] - reach - scenario.place.standoff_m, middle[2] + reach])
