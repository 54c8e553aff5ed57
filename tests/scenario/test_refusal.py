"""What a message says: path, value, bound, in words of TOML."""

import json

import pytest
from pydantic import ValidationError

from armland.errors import ConfigurationError
from armland.scenario import Scenario
from armland.scenario.refusal import MOST_LINES, problems, refusal, refused

LINK = {
    "uplink_delay_ms": 1.0,
    "downlink_delay_ms": 1.0,
    "torque_effectiveness": 1.0,
    "torque_limit_nm": [1.0, 1.0, 1.0],
}


def error(**tables) -> ValidationError:
    with pytest.raises(ValidationError) as e:
        Scenario.model_validate_json(json.dumps({"link": LINK, **tables}))
    return e.value


@pytest.mark.parametrize(
    ("tables", "says"),
    [
        ({"uav": {"mass_kg": -1.0}}, "uav.mass_kg: -1.0 lies outside 0.0001 to 1000"),
        ({"uav": {"lever_m": [0.0, 200.0, 0.0]}}, "uav.lever_m.1: 200.0 lies outside -100 to 100"),
        ({"uav": {"inertia_kgm2": [[1e9] * 3] * 3}}, "uav.inertia_kgm2.0.0: 1000000000.0 lies outside -10000 to 10000"),
        ({"arm": {"joint_speed_rad_s": [1.0, 0.0]}}, "arm.joint_speed_rad_s.1: 0.0 lies outside 1e-06 to 100"),
        (
            {"experiments": {"E1": {"rule": {"position_rad_s": 0}}}},
            "experiments.E1.rule.position_rad_s: 0 lies outside 0.001 to 10000",
        ),
        ({"faults": [{"kind": "push"}, {}]}, "faults.1.kind: is missing"),
        ({"place": {"catch_m": 3}}, "place.catch_m: Input should be a list (got 3)"),
        ({"place": 3}, "place: Input should be a table (got 3)"),
        (
            {"place": {"catch_m": [1.0, 1.0, 1.0, 1.0]}},
            "place.catch_m: list should have at most 3 items, not 4 (got [1.0, 1.0, 1.0, 1.0])",
        ),
        (
            {"experiments": {"E1": {"lawn": 1}}},
            "experiments.E1.lawn: unknown key; known here: acceleration, extra_torque, law",
        ),
        ({"faults": [{"kind": "push", "angle": 1}]}, "faults.0.angle: unknown key; known here: after_s, body"),
        ({"title": "x" * 300}, "title: String should have at most 200 characters (got '" + "x" * 56 + "...)"),
        ({"experiments": 3}, "experiments: Input should be a table (got 3)"),
    ],
)
def test_line_says_path_value_and_what_would_have_worked(tables, says) -> None:
    lines = problems(error(**tables), Scenario)
    assert any(line.startswith(says) for line in lines), lines


def test_line_begins_with_its_head() -> None:
    assert problems(error(run={"seed": -1}), Scenario, "x.toml") == [
        "x.toml: run.seed: -1 lies outside 0 to 4.61169e+18"
    ]


def test_list_with_a_wrong_item_is_not_called_too_short() -> None:
    assert problems(error(arm={"joint_speed_rad_s": ["x"]}), Scenario) == [
        "arm.joint_speed_rad_s.0: Input should be a valid number (got 'x')"
    ]


def test_check_of_a_whole_table_has_a_line_for_each_problem() -> None:
    fault = {"kind": "push", "direction": [0.0, 0.0, 0.0], "rotor": 2}
    assert [line.split(": ")[0] for line in problems(error(faults=[fault]), Scenario)] == ["faults.0", "faults.0"]


def test_message_counts_all_and_lists_the_first() -> None:
    assert str(refused("x", ["a"])) == "x: 1 problem\n  a"
    assert str(refused("x", ["a", "b"])) == "x: 2 problems\n  a\n  b"
    long = str(refused("x", [str(i) for i in range(100)])).splitlines()
    assert (long[0], long[-1], len(long)) == ("x: 100 problems", f"  and {100 - MOST_LINES} more", MOST_LINES + 2)
    assert isinstance(refusal(error(run=3), Scenario, "x"), ConfigurationError)
