"""The command `arm`, and the options that say more about an arm."""

import json
from pathlib import Path

import pytest

from armland.cli.options import arm_settings
from armland.errors import ConfigurationError

ARMS = Path(__file__).parents[1] / "data" / "arms"


def test_table_says_values_sources_and_what_is_suspicious(armland):
    done = armland("arm", str(ARMS / "weak.urdf"))
    assert done.code == 0
    for words in (
        "10 f",
        "±2.9 f",
        "0.1 r",
        "payload",
        "0.00 kg in any pose",
        "Suspicious:",
        "less than",
        "'tool0', chosen",
    ):
        assert words in " ".join(done.out.split())


def test_data_are_the_same(armland):
    data = json.loads(armland("arm", str(ARMS / "no_effort.urdf"), "--json").out)
    assert data["ee"] == "tool0"
    assert data["joints"][0]["torque"] == {"number": 200.0, "source": "rule", "unit": "N·m"}
    assert data["payload_kg"]["anywhere"] > 1.0
    assert any("no torque in the file" in line for line in data["notes"])
    assert data["reach_m"] == pytest.approx(1.05, abs=0.03)


def test_options_count(armland):
    given = ("--torque-limits", "9,9,9,9,9,9,9", "--ee", "tool0:z", "--lock", "rail=0.3", "--json")
    data = json.loads(armland("arm", str(ARMS / "rail.urdf"), *given).out)
    assert {j["torque"]["source"] for j in data["joints"]} == {"option"}
    assert any("locked as asked: rail = 0.3 m" in line for line in data["notes"])


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("xacro.urdf",), "xacro FILE.xacro"),
        (("no_inertial_link3.urdf",), "'l3'"),
        (("nowhere.urdf",), "there is no such file"),
        (("ok.urdf", "--ee", "nobody"), "its frames are: base"),
        (("ok.urdf", "--torque-limits", "1,2"), "arm.torque_limits_nm has 2 values; the arm has 7 joints"),
        (("ok.urdf", "--torque-limits", "much"), "expected numbers by commas"),
        (("ok.urdf", "--lock", "j1"), "expected NAME=VALUE"),
        (("ok.urdf", "--lock", "nobody=1"), "arm.lock: the arm has no joint 'nobody'"),
    ],
)
def test_refusal_is_one_message_and_exit_code_2(armland, given, words):
    done = armland("arm", str(ARMS / given[0]), *given[1:])
    assert done.code == 2
    assert words in done.err
    assert "Traceback" not in done.err


def test_own_arm_is_shown_where_none_is_named(armland):
    data = json.loads(armland("arm", "--json").out)
    assert [j["joint"] for j in data["joints"]] == ["A1", "A2", "E1", "A3", "A4", "A5", "A6"]
    assert (data["notes"], data["suspicious"]) == ([], [])


def test_settings_of_the_options():
    found = arm_settings({"ee": "tool0", "lock": ["a=b=0.5", "rail = 1"], "torque_limits": "1, 2 3"})
    assert found == {"ee": "tool0", "lock": {"a=b": 0.5, "rail": 1.0}, "torque_limits_nm": [1.0, 2.0, 3.0]}
    assert arm_settings({}) == {}
    with pytest.raises(ConfigurationError, match="--lock '=1'"):
        arm_settings({"lock": ["=1"]})
