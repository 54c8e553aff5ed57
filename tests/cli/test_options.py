from pathlib import Path

import pytest

from armland.cli.options import load, parse_settings
from armland.errors import ConfigurationError
from armland.scenario.environment import Sea


def test_values_are_toml_and_keys_are_dotted():
    found = parse_settings(["seed=3", "place.catch_m = [0.6, 0.0, 0.86]", 'place.note="a=b"', "eye.on=true"])
    assert found == {"seed": 3, "place": {"catch_m": [0.6, 0.0, 0.86], "note": "a=b"}, "eye": {"on": True}}


def test_later_setting_replaces_an_earlier_one_and_keeps_its_neighbours():
    assert parse_settings(["a.b=1", "a.c=2", "a.b=3"]) == {"a": {"b": 3, "c": 2}}


def test_list_of_tables():
    text = 'faults=[{kind="link_loss", phase="carry"}, {kind="camera_lost"}]'
    assert parse_settings([text])["faults"][1] == {"kind": "camera_lost"}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("seed", "expected KEY=VALUE"),
        ("=3", "expected KEY=VALUE"),
        ("title=calm", "quotes of its own"),
        ("a b=1", "no dotted key"),
        ("a=", "is not a value of TOML"),
        ("a=1\nb=2", "one key and one value"),
    ],
)
def test_what_is_no_setting_is_refused(text, words):
    with pytest.raises(ConfigurationError, match=words):
        parse_settings([text])


def test_all_problems_are_named_at_once():
    with pytest.raises(ConfigurationError) as refusal:
        parse_settings(["title=calm", "seed=2", "place"])
    assert "'title=calm'" in str(refusal.value)
    assert "'place'" in str(refusal.value)


def test_wind_is_mean_and_turbulence_and_none_of_both_where_it_is_still():
    windy, still = (load("landing", {"wind": speed}).air for speed in (8.0, 0.0))
    assert (windy.wind_mps, windy.turbulence, windy.reference_m) == (8.0, "by_wind", 6.096)
    assert not still.blows


def test_recorded_wind_is_found_where_the_command_is_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wind.csv").write_text("time_s,x,y,z\n")
    assert load("landing", {"wind_trace": Path("wind.csv")}).air.trace == str(tmp_path / "wind.csv")
    with pytest.raises(ConfigurationError, match="leave out wind_mps and turbulence"):
        load("landing", {"wind_trace": Path("wind.csv"), "wind": 8.0})


@pytest.mark.parametrize(
    ("given", "sea"),
    [
        ({"sea": "3", "hull": 2.0}, {"state": "ss3", "hull_m": 2.0}),
        ({"sea": "ss2"}, {"state": "ss2"}),
        ({"sea": "tank"}, {"state": "tank"}),
        ({"sea": "usv"}, {"state": "usv"}),
        ({"sea": "0"}, {}),
        ({"sea_trace": Path("deck.csv")}, {"trace": str(Path("deck.csv").resolve())}),
    ],
)
def test_sea_is_that_of_the_options(given, sea):
    assert load("landing", given).sea == Sea(**sea)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"sea": "7"}, "--sea '7': sea states are 0 \\(calm\\) to 4 or ss1 to ss4, or tank and usv"),
        ({"hull": 4.5}, "hull_m has no effect on a calm sea"),
        ({"sea": "2", "sea_trace": Path("deck.csv")}, "leave out state = 'ss2'"),
    ],
)
def test_sea_that_is_none_is_refused(given, message):
    with pytest.raises(ConfigurationError, match=message):
        load("landing", given)
