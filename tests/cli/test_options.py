import pytest

from armland.cli.options import parse_settings
from armland.errors import ConfigurationError


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
