"""Keys of `[sea]`: which go together, and what of them is refused."""

import pytest

from armland.errors import ConfigurationError
from armland.scenario import load_scenario
from armland.scenario.environment import Sea


def sea(**keys):
    return load_scenario("landing", {"sea": keys}).sea


@pytest.mark.parametrize(
    ("keys", "moves", "waves"),
    [
        ({}, False, False),
        ({"state": "ss1"}, True, True),
        ({"state": "tank"}, True, False),
        ({"state": "usv"}, True, False),
        ({"height_m": 0.2, "period_s": 3.0}, True, True),
        ({"state": "ss4", "height_m": 1.5}, True, True),
        ({"trace": "deck.csv"}, True, False),
        ({"spectrum_file": "s.csv"}, True, True),
    ],
)
def test_what_moves_the_deck(keys, moves, waves):
    assert (sea(**keys).moves, sea(**keys).waves) == (moves, waves)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"hull_m": 2.0}, "hull_m has no effect on a calm sea; say state = 'ss2'"),
        ({"height_m": 0.3}, "height_m has no effect on a calm sea"),
        ({"state": "tank", "hull_m": 2.0}, "hull_m has no effect without waves"),
        ({"trace": "deck.csv", "state": "ss2"}, "leave out state = 'ss2'"),
        ({"state": "ss2", "peak": 2.0}, "peak has no effect without spectrum = 'jonswap'"),
        ({"state": "ss2", "response_file": "r.csv", "beam_m": 1.0}, "beam_m has no effect beside response_file"),
        ({"spectrum_file": "s.csv", "state": "ss2"}, "leave out state = 'ss2'"),
        ({"spectrum_file": "s.csv", "height_m": 1.0}, "height_m has no effect beside spectrum_file"),
        ({"state": "ss9"}, "sea.state"),
        ({"state": "ss2", "hull_m": 0.1}, "sea.hull_m"),
    ],
)
def test_key_without_effect_is_refused(keys, message):
    with pytest.raises(ConfigurationError, match=message):
        sea(**keys)


def test_controller_never_sees_the_sea():
    assert load_scenario("landing", {"sea": {"state": "ss3"}}).believed().sea == Sea()


def test_files_are_found_beside_the_scenario(tmp_path):
    (tmp_path / "deck.csv").write_text("")
    (tmp_path / "own.toml").write_text('base = "landing"\n[sea]\ntrace = "deck.csv"\n')
    assert load_scenario(str(tmp_path / "own.toml")).sea.trace == str(tmp_path / "deck.csv")
