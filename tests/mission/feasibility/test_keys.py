"""Keys without effect, speeds of another arm, and values that cannot work: refused by path or with the bound."""

import pytest

from armland.errors import ConfigurationError
from armland.mission.belief import flyer
from armland.mission.feasibility.keys import check_by_hand, check_keys
from armland.mission.plan import plan
from armland.mission.registry import MISSIONS
from armland.scenario import load_scenario


def test_keys_that_a_landing_does_not_use_are_refused_with_what_it_does_use(tmp_path):
    file = tmp_path / "ignored.toml"
    file.write_text('base = "landing"\n[control]\nk3 = 30.0\n[place]\nfly_on = true\n')
    with pytest.raises(ConfigurationError) as refusal:
        plan(load_scenario(file), "landing")
    text = str(refusal.value)
    assert "control.k3: not used by the mission 'landing'" in text
    assert "place.fly_on" in text
    assert "position_rad_s" in text


def test_former_names_of_unused_keys_are_refused_by_their_present_path(tmp_path):
    file = tmp_path / "former.toml"
    file.write_text('base = "paper"\n[place]\ncatch_m = [0.62, 0.0, 0.86]\n[demonstrator.control]\nk3 = 30.0\n')
    with pytest.raises(ConfigurationError, match=r"control\.k3: not used"):
        plan(load_scenario(file), "landing")


def test_belief_is_used_where_its_subject_is():
    check_keys(frozenset({"belief.uav.mass_kg"}), MISSIONS["landing"])
    with pytest.raises(ConfigurationError, match=r"belief\.wings"):
        check_keys(frozenset({"belief.wings.span_m"}), MISSIONS["landing"])


@pytest.mark.parametrize("name", MISSIONS)
def test_scenarios_that_come_with_armland_are_used_in_all_they_say(name):
    for file in ("paper", "compare") if MISSIONS[name].start == "hinged" else ("landing",):
        own = load_scenario(file).own
        assert own
        # One key more, and that one alone is refused.
        with pytest.raises(ConfigurationError) as refusal:
            check_keys(own | {"wings.span_m"}, MISSIONS[name])
        refused = str(refusal.value).splitlines()[1:]
        assert [line.partition(":")[0].strip() for line in refused] == ["wings.span_m"]


def test_prefix_of_a_key_is_a_whole_table_and_no_part_of_a_word():
    with pytest.raises(ConfigurationError, match="runner"):
        check_keys(frozenset({"runner"}), MISSIONS["landing"])
    check_keys(frozenset({"run.seed"}), MISSIONS["landing"])


def check(**onboard):
    scenario = load_scenario("landing", {"onboard": onboard})
    check_by_hand(scenario, flyer(scenario))


@pytest.mark.parametrize(
    ("good", "bad", "words"),
    [
        (
            {"hover": {"thrust_max_n": 5.46}},
            {"hover": {"thrust_max_n": 5.4}},
            r"thrust_max_n = 5.4 N lets a UAV of 5.18 N sink",
        ),
        (
            {"hover": {"lift_min_n": 4.39}},
            {"hover": {"lift_min_n": 4.5}},
            r"lift_min_n = 4.5 N lets a UAV of 5.18 N rise",
        ),
        ({"kp_nm": [0.29, 0.29, 0.1]}, {"kp_nm": [0.28, 0.29, 0.1]}, r"0.28 N·m/rad in roll .* above m g l = 0.283"),
    ],
)
def test_bounds(good, bad, words):
    check(**good)
    with pytest.raises(ConfigurationError, match=words):
        check(**bad)
