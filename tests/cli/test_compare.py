"""The command `compare`: from methods to a table and a figure, and what is refused with nothing written."""

import json

import pytest


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["arm"], "two or more different methods"),
        (["arm", "arm"], "two or more different methods"),
        (["arm", "parachute"], "method 'parachute' is unknown; known are arm, arm-paper, unassisted"),
        (["unassisted", "unassisted-untimed", "--sea", "9"], "sea states are 0"),
        (["unassisted", "unassisted-untimed", "--runs", "0"], "Invalid value for '--runs'"),
        (["unassisted", "unassisted-untimed", "--set", "pad.friction=9"], "pad.friction"),
    ],
)
def test_bad_input_is_one_message_and_nothing_is_written(armland, tmp_path, options, words):
    done = armland("compare", *options)
    assert done.code == 2
    assert words in done.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_two_methods_are_flown_and_flown_on(armland, tmp_path):
    methods = ("compare", "unassisted", "unassisted-untimed", "--jobs", "1", "--json")
    first = armland(*methods, "--runs", "2")
    assert first.code == 0, first.err
    data = json.loads(first.out)
    assert [m["success"]["of"] for m in data["methods"]] == [2, 2]
    out = tmp_path / "out" / "compare"
    assert {p.name for p in out.iterdir()} == {
        *("compare.json", "methods.pdf", "methods.png", "unassisted.sqlite", "unassisted-untimed.sqlite"),
    }
    again = armland(*methods, "--runs", "2")
    assert (again.code, "--resume goes on with it" in again.err) == (2, True)
    further = armland(*methods, "--runs", "3", "--resume")
    assert [m["success"]["of"] for m in json.loads(further.out)["methods"]] == [3, 3]
