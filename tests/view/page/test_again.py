"""The command that does it again flies the same, byte for byte."""

import shlex
import tomllib

import pytest

from armland.experiments.episode import fly
from armland.runtime.log import read_log
from armland.scenario import load_scenario
from armland.view.page.again import again, own_scenario, study_again, toml

CASES = {
    "plain": ("land", "--seed", "3"),
    "levels": ("takeoff", "--deviation", "mild", "--set", "imperfections.hover_noise_m=0.005"),
    "faults": ("land", "--set", 'faults=[{kind="link_loss", phase="carry", after_s=0.5}]', "--law", "paper"),
    "nominal": ("run", "landing", "--set", "deviation.level='nominal'", "--set", "place.catch_m=[0.61, 0.0, 0.86]"),
    "sea": ("land", "--sea", "2", "--hull", "6", "--wind", "3"),
    "uav": ("land", "--uav", "x500", "--deviation", "nominal"),
    "row": ("run", "track", "compare", "--experiment", "observer"),
    "experiment": ("run", "E2", "--seed", "4"),
    "without an arm": ("run", "tether", "--seed", "5"),
}


SLOW = [pytest.param(case, marks=pytest.mark.slow if case not in ("faults",) else ()) for case in CASES]


@pytest.mark.parametrize("case", SLOW)
def test_command_sets_the_same(armland, tmp_path, case) -> None:
    """All that a log says about its flight, and its first second, is the same again."""
    short = ("--no-figures", "--set", "run.duration_s=1.0")
    armland(*CASES[case], *short, "--out", "one")
    (log,) = (tmp_path / "one").glob("*.mcap")
    one = read_log(log)
    words = shlex.split(again(one.metadata, one.attachments["scenario.toml"]).command)
    assert words[0] == "armland"
    assert " ".join(words).count("--seed") == 1
    armland(*words[1:], "--no-figures", "--out", "two")
    two = read_log(tmp_path / "two" / log.name)
    same = {k: v for k, v in one.metadata.items() if k != "overrides"}
    assert same == {k: v for k, v in two.metadata.items() if k != "overrides"}
    assert one.ticks.tobytes() == two.ticks.tobytes()


@pytest.mark.parametrize(
    ("mission", "hinged", "name"),
    [("landing", False, "landing"), ("E1", True, "paper"), ("tether", False, "tether"), ("hexapod", False, "hexapod")],
)
def test_scenario_of_a_mission_where_none_is_named(mission, hinged, name) -> None:
    assert own_scenario(mission, hinged) == name


def test_own_scenario_is_shown_to_be_saved(tmp_path) -> None:
    own = b'base = "landing"\n[run]\nseed = 9\n'
    (tmp_path / "mine.toml").write_bytes(own)
    episode = fly(load_scenario(tmp_path / "mine.toml", {"run": {"duration_s": 1.0}}), "landing")
    found = again(episode.metadata, own)
    assert found.command == "armland land scenario.toml --seed 9 --set run.duration_s=1.0"
    assert found.scenario == own.decode()


def test_studies_name_their_scenario_by_an_option() -> None:
    scenario = load_scenario("compare")
    metadata = {"mission": "x", "seed": "1", "overrides": ""}
    text = scenario.text.encode()
    assert study_again(metadata, text, "compare", ("--compare",)).command == "armland paper --compare --seed 1"
    assert study_again(metadata, text, "paper").command == "armland paper --scenario compare --seed 1"


@pytest.mark.parametrize("value", [True, 3, 0.25, 'a "b" ° \'', [1.0, [2.0, 3.0]], {"a": "x", "b": [1, 2]}])
def test_values_survive_toml(value) -> None:
    assert tomllib.loads(f"x = {toml(value)}")["x"] == value
