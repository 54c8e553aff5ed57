"""A foreign arm for which the scenario's places do not work moves them; the arm they are made for, and a user's own, do not."""

import numpy as np
import pytest

from armland.errors import ConfigurationError, WorkspaceError
from armland.experiments import placing
from armland.experiments.episode import fly_prepared, prepare
from armland.experiments.placing import mounted_further, placed
from armland.mission.feasibility import placing as feasibility
from armland.mission.registry import MISSIONS
from armland.models.description import resolve
from armland.scenario import load_scenario

LANDING = MISSIONS["landing"]
TOO_FAR = WorkspaceError("too far")


@pytest.fixture(scope="module")
def six_axis(pytestconfig):
    file = str(pytestconfig.rootpath / "examples" / "six_axis.urdf")
    other = {"file": file, "ee": None, "elbow_joint": None, "home_rad": None}
    return load_scenario("landing", {"arm": other, "place": {"home_deg": None}})


def test_places_of_the_arm_that_they_are_made_for_stay():
    flight = prepare(load_scenario("landing"), "landing")
    assert flight.moved == ""
    assert flight.scenario.place.catch_m == (0.62, 0.0, 0.86)
    with pytest.raises(WorkspaceError, match=r"out of reach .* This arm could catch at place\.catch_m"):
        prepare(load_scenario("landing", {"place": {"catch_m": [0.62, 0.0, 0.95]}}), "landing")


@pytest.fixture(scope="module")
def moved(six_axis):
    return prepare(six_axis, "landing")


@pytest.mark.slow
def test_foreign_arm_lands_where_it_can_and_says_why(moved):
    place = moved.scenario.place
    assert moved.moved.startswith(f"place.catch_m = {list(place.catch_m)} with place.put_down_m = ")
    assert "chosen, because the arm cannot" in moved.moved
    assert moved.plan.scenario.place == place
    assert not np.allclose(place.catch_m, (0.62, 0.0, 0.86))


@pytest.mark.slow
@pytest.mark.slow
def test_what_was_found_is_flown(moved):
    assert fly_prepared(moved).result["success"]


@pytest.mark.slow
def test_two_places_that_the_user_set_are_refused_with_others(six_axis):
    wanted = {"place": {"catch_m": [0.62, 0.0, 0.86], "put_down_m": [0.68, 0.0, 0.701]}}
    his = load_scenario("landing", {"arm": six_axis.arm.model_dump(), "place": {**wanted["place"], "home_deg": None}})
    with pytest.raises(WorkspaceError, match=r"could catch at place\.catch_m = \["):
        prepare(his, "landing")


@pytest.mark.slow
def test_places_at_which_the_plant_objects_are_passed_over(six_axis):
    tried = []

    def make(one):
        tried.append(one.place.catch_m)
        if len(tried) < 2:
            raise ConfigurationError("the UAV would start inside the arm")
        return one

    one, line = placed(six_axis, LANDING, TOO_FAR, make)
    assert one.place.catch_m == tried[1] != tried[0]
    assert line.endswith("chosen, because too far")


NOWHERE = WorkspaceError("no place was found")


def made_at(asked, works):
    """A maker that refuses all end effectors but one, and notes what it is asked for."""

    def make(one):
        asked.append(one.arm.ee)
        if one.arm.ee != works:
            raise WorkspaceError("nor there")
        return one

    return make


@pytest.fixture
def inside(six_axis, tmp_path):
    """The arm with its `tool0` 27 mm inside of the frame that it is mounted on otherwise."""
    text = (resolve(six_axis.arm.file)).read_text("utf-8")
    joint = '<joint name="o" type="fixed"><parent link="link_6"/><child link="outer"/><origin xyz="0 0.09 0" rpy="-1.57 0 0"/></joint>'
    last = f'<link name="outer"/>{joint}</robot>'
    path = tmp_path / "inside.urdf"
    path.write_text(text.replace('xyz="0 0.09 0"', 'xyz="0 0.063 0"').replace("</robot>", last), encoding="utf-8")
    return six_axis.replaced({"arm": {"file": str(path)}})


def test_tool_that_nobody_placed_is_mounted_further_out_where_there_is_no_place_else(inside):
    asked = []
    made, said = mounted_further(inside, NOWHERE, made_at(asked, "outer"))
    assert (made.arm.ee, asked) == ("outer", ["outer"])
    assert said == "arm.ee = 'outer' chosen, 27 mm further out than 'tool0', because no place was found"


@pytest.mark.parametrize(("ee", "works", "asked"), [("tool0", "outer", []), (None, "tool0", ["outer"])])
def test_frame_that_a_user_chose_stays_and_one_that_does_not_help_is_not_told(inside, ee, works, asked):
    tried = []
    with pytest.raises(WorkspaceError, match="no place was found"):
        mounted_further(inside.replaced({"arm": {"ee": ee}}), NOWHERE, made_at(tried, works))
    assert tried == asked


def test_arm_whose_frame_is_the_outermost_is_refused_as_it_was(six_axis):
    with pytest.raises(WorkspaceError, match="no place was found"):
        mounted_further(six_axis, NOWHERE, made_at([], "tool0"))


def searches(monkeypatch, there):
    """Replace the search for places by one that looks at `there`; returns the nearness of each search."""
    asked = []

    def alternatives(scenario, mission, keep, nearness, seen=None):
        asked.append(nearness)
        if seen is not None:
            seen += there
        return iter(())

    for module in (placing, feasibility):
        monkeypatch.setattr(module, "alternatives", alternatives)
        monkeypatch.setattr(module, "nowhere", lambda scenario, mission: "No place was found for this arm.")
    return asked


@pytest.mark.parametrize(("there", "keep", "searched"), [([], "", 1), ([object()], "", 2), ([], "catch", 2)])
def test_what_was_looked_for_everywhere_is_not_looked_for_again(six_axis, monkeypatch, there, keep, searched):
    """Near the wanted place there is none if there is none at all; where the user keeps one, others may do."""
    asked = searches(monkeypatch, there)
    monkeypatch.setattr(placing, "kept", lambda scenario: frozenset(keep.split()))
    with pytest.raises(WorkspaceError, match=r"too far\. No place was found"):
        placed(six_axis, LANDING, TOO_FAR, lambda one: one)
    assert len(asked) == searched
