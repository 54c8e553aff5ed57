"""Choices of a page: what is one, and the command that flies the same."""

import shlex
from pathlib import Path

import pytest

from armland.console.live.choices import Choices, chosen
from armland.errors import ConfigurationError


def test_what_is_empty_is_left_out() -> None:
    assert Choices().command() == "armland run landing landing --seed 1"
    given = Choices().given()
    assert {k for k, v in given.items() if v not in (None, [])} == {"scenario", "seed"}


def test_the_command_says_all_that_was_chosen() -> None:
    made = Choices(
        mission="takeoff",
        scenario="my calm.toml",
        arm="a.urdf",
        ee="tip",
        uav="x500",
        law="exact",
        sea="2",
        wind=4.0,
        seed=7,
    )
    words = shlex.split(made.command(Path("out/c 1.mcap"), ["run.duration_s=9.0"]))
    assert words[:4] == ["armland", "run", "takeoff", "my calm.toml"]
    pairs = dict(zip(words[4::2], words[5::2], strict=True))
    assert pairs == {
        "--seed": "7",
        "--arm": "a.urdf",
        "--ee": "tip",
        "--uav": "x500",
        "--law": "exact",
        "--sea": "2",
        "--wind": "4",
        "--set": "run.duration_s=9.0",
        "--operator": "out/c 1.mcap",
    }
    assert made.given(["a=1"]) == {
        "scenario": "my calm.toml",
        "arm": "a.urdf",
        "ee": "tip",
        "uav": "x500",
        "law": "exact",
        "sea": "2",
        "wind": 4.0,
        "seed": 7,
        "settings": ["a=1"],
    }


@pytest.mark.parametrize(
    ("data", "complaint"),
    [
        ({"seed": -1}, "seed"),
        ({"seed": 1.5}, "seed"),
        ({"wind": 41.0}, "wind: 41.0 lies outside 0 to 40"),
        ({"wind": float("nan")}, "wind"),
        ({"mission": "m" * 501}, "mission"),
        ({"mission": 3}, "mission"),
        ({"rocket": "v2"}, "rocket: unknown key"),
    ],
)
def test_nonsense_is_refused_with_its_path(data: dict, complaint: str) -> None:
    with pytest.raises(ConfigurationError, match=complaint):
        chosen(data)
