"""A campaign's file: what it means, and what is refused with its path."""

import json

import pytest

from armland.errors import ConfigurationError
from armland.experiments.campaign.description import changes, check_parameters, read_description
from armland.scenario import load_scenario

FILE = """
mission = "landing"
overrides.air.turbulence = "by_wind"

[parameters]
air.wind_mps = {uniform = [1.0, 9.0]}
uav.extra_mass_kg = {fixed = 0.01}
place.start_speed_mps = {sweep = [0.0, 0.2]}

[[points]]
sea.state = "calm"
sea.hull_m = 4.0

[[points]]
sea.state = "ss1"
sea.hull_m = 6.0
"""


def written(tmp_path, text):
    file = tmp_path / "study.toml"
    file.write_text(text)
    return read_description(file)


def test_points_are_all_combinations_with_what_is_fixed(tmp_path):
    found = written(tmp_path, FILE)
    assert list(found.drawn) == ["air.wind_mps"]
    assert [(p["sea.state"], p["sea.hull_m"], p["place.start_speed_mps"]) for p in found.grid] == [
        ("calm", 4.0, 0.0),
        ("calm", 4.0, 0.2),
        ("ss1", 6.0, 0.0),
        ("ss1", 6.0, 0.2),
    ]
    assert {p["uav.extra_mass_kg"] for p in found.grid} == {0.01}


VARIANTS = """
[parameters]
uav.extra_mass_kg = {uniform = [0.0, 0.02]}

[[variants]]
name = "z as it is"

[[variants]]
name = "a fast camera"
values.camera.rate_hz = 60

[[variants]]
name = "hard wind"
values.air.wind_mps = 9.0
values.air.turbulence = "by_wind"
"""


def test_variants_set_what_they_name_and_nothing_of_each_other(tmp_path):
    found = written(tmp_path, VARIANTS)
    assert found.named == ["z as it is", "a fast camera", "hard wind"]
    assert found.grid == [{}, {"camera.rate_hz": 60}, {"air.wind_mps": 9.0, "air.turbulence": "by_wind"}]
    # What is loaded is the scenario as it is: what the first sets is no other one's.
    assert found.settings() == {"uav": {"extra_mass_kg": 0.01}}
    check_parameters(found, load_scenario("landing", found.settings()))
    bad = written(tmp_path, VARIANTS.replace("= 60", "= 0"))
    with pytest.raises(ConfigurationError, match=r"variants\]\]: 1 problem\n.*camera.rate_hz"):
        check_parameters(bad, load_scenario("landing", found.settings()))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[[variants]]\nname = "a"\n[[variants]]\nname = "a"', "'a' is there twice"),
        ('[[variants]]\nname = "a"\n[[points]]\nair.wind_mps = 1.0', "points and variants: one of them"),
        (VARIANTS + "values.uav.extra_mass_kg = 0.01", "'hard wind' sets uav.extra_mass_kg, which a parameter sets"),
    ],
)
def test_variants_that_contradict_are_refused(tmp_path, text, words):
    with pytest.raises(ConfigurationError, match=words):
        written(tmp_path, text)


def test_scenario_beside_the_file_is_found_from_anywhere(tmp_path):
    (tmp_path / "calm.toml").write_text('base = "landing"\n')
    assert written(tmp_path, 'scenario = "calm.toml"').scenario == str(tmp_path / "calm.toml")
    assert written(tmp_path, 'scenario = "landing"').scenario == "landing"


def test_settings_hold_a_value_of_all_that_varies(tmp_path):
    settings = written(tmp_path, FILE).settings()
    assert settings["air"] == {"turbulence": "by_wind", "wind_mps": 5.0}
    assert load_scenario("landing", settings).air.wind_mps == 5.0
    # Without it the scenario would not load: turbulence by the wind, and no wind.
    with pytest.raises(ConfigurationError, match="none without wind"):
        load_scenario("landing", {"air": {"turbulence": "by_wind"}})


def test_changes_reach_into_lists():
    tables = json.loads(load_scenario("landing").model_dump_json())
    catch = tables["place"]["catch_m"]
    found = changes(tables, {"place.catch_m.2": 0.9, "place.catch_m.0": 0.6, "air.wind_mps": 3.0})
    assert found == {"place": {"catch_m": [0.6, catch[1], 0.9]}, "air": {"wind_mps": 3.0}}
    assert tables["place"]["catch_m"] == catch


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("air.wind", "known there: .*wind_mps"),
        ("airs.wind_mps", "known there: .*air"),
        ("place.catch_m.3", "has the places 0 to 2"),
        ("air.wind_mps.x", "single value"),
    ],
)
def test_paths_that_lead_nowhere_are_refused(path, words):
    tables = json.loads(load_scenario("landing").model_dump_json())
    with pytest.raises(ConfigurationError, match=words):
        changes(tables, {path: 1.0})


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "[parameters]\nair.wind_mps = {uniform = [5.0, 2.0]}",
            r"parameters.air.wind_mps: uniform = \[5.0, 2.0\] is an empty range",
        ),
        (
            "[parameters]\nair.wind_mps = {gamma = [5.0, 2.0]}",
            "air.wind_mps.gamma: unknown key; known here: choice, fixed",
        ),
        ("[parameters]\nair.wind_mps = 4.0", "air.wind_mps: unknown key; known here: choice"),
        ('design = "grid"', "design: .*'random', 'latin' or 'sobol'"),
        ("misson = 1", "misson: unknown key; known here: .*mission"),
        ("[parameters]\nair.wind_mps = {sweep = []}", "at least 1"),
        ("[parameters]\na.b = {sweep = [1]}\n[[points]]\na.b = 2", "points.0 sets a.b, which a parameter sets, too"),
        ("[[points]]\na.b = 2\n[[points]]\na.c = 2", "points.1 must set what points.0 sets: a.b"),
        ("mission = ", "not valid TOML"),
    ],
)
def test_bad_files_are_refused_in_one_message(tmp_path, text, words):
    with pytest.raises(ConfigurationError, match=words):
        written(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("air.wind_mps = {uniform = [1.0, 90.0]}", "air.wind_mps: 90.0 lies outside 0 to 40"),
        ("air.wind = {uniform = [1.0, 9.0]}", "air.wind is no value of the scenario"),
        ('air.wind_mps = {choice = [1.0, "strong"]}', "air.wind_mps"),
        ("run.seed = {choice = [1, 2]}", "the seed follows from first_seed"),
    ],
)
def test_parameters_that_the_scenario_cannot_take_are_refused_before_anything_flies(described, text, words):
    with pytest.raises(ConfigurationError, match=words):
        check_parameters(described(f"[parameters]\n{text}"), load_scenario("landing"))


def test_good_parameters_pass(described):
    scenario = load_scenario("landing", {"air": {"wind_mps": 5.0, "turbulence": "by_wind"}})
    check_parameters(described("[parameters]\nair.wind_mps = {uniform = [0.5, 9.0]}"), scenario)
