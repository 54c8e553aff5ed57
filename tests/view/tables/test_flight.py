"""What a flight looks like on the terminal, from its result and its log."""

import numpy as np
import pytest

from armland.records import Limit
from armland.view.tables.flight import print_flight


@pytest.fixture
def result(landing) -> dict:
    return landing.result


@pytest.fixture
def printed(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("COLUMNS", "200")

    def of(result, run=None) -> str:
        print_flight(result, run, tmp_path)
        return capsys.readouterr().out

    return of


def row(text: str, label: str) -> list[str]:
    (line,) = (line for line in text.splitlines() if line.strip("│ ").startswith(label))
    return [cell.strip() for cell in line.strip("│").split("│")][1:]


def test_verdict_comes_first_with_its_reason(result, printed) -> None:
    assert printed(result).startswith(f"success: {result['reason']}\n")
    failed = {**result, "success": False, "reason": "stopped [in] carry"}
    assert printed(failed).startswith("failure: stopped [in] carry\n")


def test_phases_with_begin_end_and_duration(result, printed) -> None:
    text = printed(result)
    for p in result["phases"]:
        begin, end, duration = (float(cell) for cell in row(text, p["name"] + " "))
        assert (begin, end) == pytest.approx((p["start_s"], p["end_s"]), abs=0.0051)
        assert duration == pytest.approx(p["end_s"] - p["start_s"], abs=0.0051)


def test_figures_stand_in_their_units_beside_their_bounds(result, landed, printed) -> None:
    text = printed(result, landed)
    found, bound, verdict = row(text, "beside the middle [mm]")
    assert float(found) == pytest.approx(1e3 * result["touchdown"]["offset_m"], abs=0.051)
    assert (bound, verdict) == ("at most 15", "holds")
    assert row(text, "speed [m/s]")[1] == "at most 0.15"
    assert float(row(text, "offset [mm]")[0]) == pytest.approx(1e3 * result["capture"]["offset_m"], abs=0.051)
    assert float(row(text, "hinge force max [N]")[0]) == pytest.approx(result["hinge_force_max_n"], abs=0.051)
    assert row(text, "joint torque over limit max")[1:] == ["at most 1", "holds"]
    assert f"{result['real_time_factor']:.1f} x real time" in text


@pytest.mark.parametrize(("speed", "found"), [(0.2, "0.200"), (None, "-"), (float("nan"), "nan")])
def test_missed_bound_fails(result, landed, printed, speed, found) -> None:
    text = printed({**result, "touchdown": {**result["touchdown"], "speed_mps": speed}}, landed)
    assert row(text, "speed [m/s]") == [found, "at most 0.15", "fails"]


def test_only_groups_that_the_mission_has_are_shown(result, printed) -> None:
    flown = {k: v for k, v in result.items() if k not in ("capture", "touchdown")}
    text = printed({**flown, "release": {"hinge_force_n": 0.3, "speed_mps": 0.012, "drop_m": 0.0003}})
    assert row(text, "hinge force [N]") == ["0.30", "-", ""]
    assert row(text, "drop [mm]") == ["0.3", "-", ""]
    assert "touchdown" not in text


def test_limits_violated_and_enforced(result, landed, printed) -> None:
    ticks = landed.ticks.copy()
    ticks["health"]["flags"] = 0
    calm = printed(result, landed._replace(ticks=ticks))
    assert "Limits violated: none" in calm
    assert "a limit was enforced: none" in calm
    ticks["health"]["flags"][np.arange(7)] = Limit.SINGULAR | Limit.JOINT_SPEED
    violated = {**result, "limits_violated": ["singularity", "arm_touched_uav"]}
    text = printed(violated, landed._replace(ticks=ticks))
    assert "Limits violated: singularity, arm_touched_uav" in text
    assert "a limit was enforced: joint_speed 7, singularity 7" in text


def test_result_without_its_log_and_faults_that_never_acted(result, printed, tmp_path) -> None:
    text = printed({**result, "never_acted": ["link_loss (0.5 s after carry)"]})
    assert "enforced" not in text
    assert "Faults that never acted: link_loss (0.5 s after carry)." in text
    assert str(tmp_path) in text
