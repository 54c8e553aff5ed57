"""UAVs as files of their own: where their values lie, measured thrust, and what is refused."""

from pathlib import Path

import pytest

from armland.errors import ConfigurationError
from armland.models.airframe.sizing import sized
from armland.models.airframe.survey import survey, suspicious
from armland.models.parameters import rotor_set
from armland.scenario import load_scenario
from armland.scenario.files.airframe import known, measured, read_airframe, sources

EXAMPLES = Path(__file__).parents[3] / "examples"

BODY = """[uav]
mass_kg = 1.2
inertia_kgm2 = [[0.02, 0.0, 0.0], [0.0, 0.02, 0.0], [0.0, 0.0, 0.04]]
lever_m = [0.0, 0.0, -0.05]
[rotors]
place_m = [[0.2, 0.2, 0.0], [-0.2, 0.2, 0.0], [-0.2, -0.2, 0.0], [0.2, -0.2, 0.0]]
"""


@pytest.fixture
def made(tmp_path):
    def make(text, name="mine.toml"):
        (tmp_path / name).write_text(text, encoding="utf-8")
        return tmp_path / name

    return make


@pytest.mark.parametrize("name", known())
def test_those_that_come_with_armland_say_where_each_value_is_from(name):
    scenario = load_scenario("landing", {"airframe": name})
    told = sources(__import__("pathlib").Path(scenario.airframe))
    given = {k for k in scenario.asked if k.startswith(("uav.", "rotors.")) and k != "uav.file"}
    assert given <= set(told) or name == "ardrone2"


def test_example_to_copy_can_be_used_as_it_is():
    scenario = load_scenario("landing", {"airframe": str(EXAMPLES / "hexarotor.toml")})
    assert rotor_set(scenario).number == 6
    assert suspicious(sized(scenario), survey(sized(scenario))) == []


def test_inertia_that_no_body_has_is_refused_with_the_most_that_one_can(made):
    flat = made(BODY.replace("0.04]", "0.0401]"))
    with pytest.raises(ConfigurationError, match=r"0\.02, 0\.02, 0\.0401 kg·m².*can be 0\.04 at most"):
        load_scenario("landing", {"airframe": str(flat)})


def test_values_lie_between_armlands_and_the_users(made):
    """landing.toml sets the attitude gains; a UAV's file lies above that, the user's scenario above both."""
    uav = made(BODY + "[onboard]\nkp_nm = [7.0, 7.0, 4.0]\nkd_nms = [0.6, 0.6, 0.7]\n")
    assert load_scenario("landing", {"airframe": str(uav)}).onboard.kp_nm == (7.0, 7.0, 4.0)
    own = made(f'base = "landing"\nairframe = "{uav.name}"\n[onboard]\nkp_nm = [8.0, 8.0, 5.0]\n', "own.toml")
    scenario = load_scenario(own)
    assert scenario.onboard.kp_nm == (8.0, 8.0, 5.0)
    assert scenario.onboard.kd_nms == (0.6, 0.6, 0.7)
    assert scenario.uav.mass_kg == 1.2
    assert load_scenario(own, {"uav": {"mass_kg": 1.3}}).uav.mass_kg == 1.3


def test_measured_thrust_gives_the_limits(made):
    made("command,thrust_n\n1.0,6.5\n0.1,0.2\n0.5,3.0\n", "bench.csv")
    uav = made(BODY + 'thrust_csv = "bench.csv"\n')
    assert read_airframe(uav)["rotors"]["max_thrust_n"] == 6.5
    assert read_airframe(uav)["rotors"]["min_thrust_n"] == 0.2
    with pytest.raises(ConfigurationError, match=r"falls from 3 to 2 N"):
        measured(made("command,thrust_n\n0.1,0.2\n0.5,3.0\n0.6,2.0\n", "bad.csv"))
    with pytest.raises(ConfigurationError, match="command and thrust_n"):
        measured(made("a,b\n1,2\n", "other.csv"))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[uav]\nmass_kg = 1.0\n", "lacks uav.inertia_kgm2, uav.lever_m, rotors.place_m; or uav.file"),
        (BODY + "[place]\ncatch_m = [0.6, 0.0, 0.8]\n", "place: a UAV's file holds uav, rotors"),
        ("uav = 3\n", "uav: should be a table"),
    ],
)
def test_what_is_no_uav_is_refused(made, text, words):
    with pytest.raises(ConfigurationError, match=words.replace("(", r"\(")):
        read_airframe(made(text))


def test_unknown_name_is_refused_with_those_that_there_are():
    with pytest.raises(
        ConfigurationError,
        match="there is no such file; UAVs that come with armland are ardrone2, ardrone2_bench, crazyflie",
    ):
        load_scenario("landing", {"airframe": "x5000"})
