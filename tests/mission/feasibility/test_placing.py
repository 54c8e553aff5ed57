"""Other places where the wanted ones do not work: what the user set stays, and a refusal names the nearest that works."""

import numpy as np
import pytest

from armland.errors import WorkspaceError
from armland.mission.feasibility import placing
from armland.mission.feasibility.placing import NOWHERE, alternatives, kept, refused, told_places
from armland.mission.plan import plan
from armland.mission.registry import MISSIONS
from armland.scenario import load_scenario

LANDING = MISSIONS["landing"]


def test_only_what_the_user_set_is_kept(tmp_path):
    assert kept(load_scenario("landing")) == frozenset()
    assert kept(load_scenario("landing", {"place": {"catch_m": [0.6, 0.0, 0.8]}})) == {"catch"}
    base, mine = tmp_path / "base.toml", tmp_path / "mine.toml"
    base.write_text('base = "landing"\n[place]\nput_down_m = [0.6, 0.0, 0.7]\n')
    mine.write_text('base = "base.toml"\n[run]\nseed = 3\n')
    # His own base is his, too; the scenario that comes with armland is not.
    assert kept(load_scenario(mine)) == {"put_down"}
    assert kept(load_scenario(mine).with_seed(4)) == {"put_down"}


def planned(one):
    return plan(one, "landing")


@pytest.fixture(scope="module")
def too_high():
    return load_scenario("landing", {"place": {"catch_m": [0.62, 0.0, 0.92], "put_down_m": [0.68, 0.0, 0.761]}})


def test_refusal_names_the_nearest_place_and_it_works(too_high):
    """What the message says is set, and the landing is planned."""
    with pytest.raises(WorkspaceError) as refusal:
        plan(too_high, "landing")
    told = str(refused(too_high, LANDING, refusal.value, planned))
    assert told.startswith(str(refusal.value))
    words = told.partition("This arm could catch at ")[2]
    catch, put, home = (
        [float(x) for x in part.partition("[")[2].partition("]")[0].split(",")] for part in words.split("place.")[1:]
    )
    assert np.linalg.norm(np.array(catch) - too_high.place.catch_m) < 0.2
    works = too_high.replaced({"place": {"catch_m": catch, "put_down_m": put, "home_deg": home}})
    assert plan(works, "landing").mission.name == "landing"


@pytest.mark.slow
def test_refusal_of_an_arm_that_can_land_nowhere_says_so():
    weak = load_scenario("landing", {"arm": {"torque_limits_nm": [2.0] * 7}})
    told = str(refused(weak, LANDING, WorkspaceError("joint A2 is too weak"), planned))
    assert told.startswith("joint A2 is too weak. No place was found for this arm. Of ")
    assert "none takes up to 0.9 of the joints' torques for arm and UAV; at least" in told


def test_where_no_single_condition_stands_in_the_way_the_refusal_names_them_all(monkeypatch):
    monkeypatch.setattr(placing, "alternatives", lambda *_: iter(()))
    assert str(refused(load_scenario("landing"), LANDING, WorkspaceError("no"), planned)) == f"no. {NOWHERE}"


def test_slot_is_told_where_it_is_another(too_high):
    other = too_high.replaced({"cradle": {"heading_deg": 180.0, "gap_m": 0.29}, "arm": {"width_m": 0.2}})
    told = told_places(other, too_high)
    assert told.endswith("cradle.heading_deg = 180, cradle.gap_m = 0.29, arm.width_m = 0.2")
    assert "cradle" not in told_places(too_high, too_high)


def test_a_slot_that_the_user_set_stays(too_high):
    narrow = load_scenario("landing", {"cradle": {"gap_m": 0.2}, "arm": {"width_m": 0.17}})
    for one in alternatives(narrow, LANDING, frozenset(), 0.5):
        assert (one.cradle.gap_m, one.arm.width_m) == (0.2, 0.17)
        break


def test_no_place_is_named_that_is_refused_when_it_is_tried(too_high):
    def never(one):
        raise WorkspaceError("a joint is damped too much")

    told = str(refused(too_high, LANDING, WorkspaceError("too high"), never))
    assert "could catch" not in told
    assert told.endswith("a joint is damped too much")
