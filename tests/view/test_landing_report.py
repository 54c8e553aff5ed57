from dataclasses import replace

import numpy as np
import pytest

from armland.experiments.landing import LandingOutcome, fly_landing
from armland.experiments.landing_judge import PLACED_M, TOUCHDOWN_SPEED_MPS
from armland.mission.landing_scenario import landing_scenario
from armland.mission.records import Limit
from armland.view.landing_report import print_landing


@pytest.fixture(scope="module")
def landed() -> LandingOutcome:
    return fly_landing(landing_scenario("landing"), seed=1)


@pytest.fixture
def printed(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("COLUMNS", "200")

    def of(outcome: LandingOutcome) -> str:
        print_landing(outcome, tmp_path)
        return capsys.readouterr().out

    return of


def row(text: str, label: str) -> list[str]:
    (line,) = (line for line in text.splitlines() if line.strip("│ ").startswith(label))
    return [cell.strip() for cell in line.strip("│").split("│")][1:]


def test_verdict_comes_first_with_its_reason(landed, printed) -> None:
    assert printed(landed).startswith(f"success: {landed.reason}\n")
    failed = replace(landed, success=False, reason="stopped [in] carry")
    assert printed(failed).startswith("failure: stopped [in] carry\n")


def test_phases_with_begin_end_and_duration(landed, printed) -> None:
    text = printed(landed)
    for p in landed.phases:
        begin, end, duration = (float(cell) for cell in row(text, p.name + " "))
        assert (begin, end) == pytest.approx((p.start_s, p.end_s), abs=0.0051)
        assert duration == pytest.approx(p.end_s - p.start_s, abs=0.0051)


def test_figures_stand_in_their_units_beside_their_bounds(landed, printed) -> None:
    text = printed(landed)
    found, bound, verdict = row(text, "beside the middle [mm]")
    assert float(found) == pytest.approx(1e3 * landed.touchdown["offset_m"], abs=0.051)
    assert (bound, verdict) == (f"at most {1e3 * PLACED_M:g}", "holds")
    assert row(text, "speed [m/s]")[1] == f"at most {TOUCHDOWN_SPEED_MPS}"
    assert float(row(text, "offset [mm]")[0]) == pytest.approx(1e3 * landed.capture["offset_m"], abs=0.051)
    assert float(row(text, "hinge force max [N]")[0]) == pytest.approx(landed.hinge_force_max_n, abs=0.051)
    assert row(text, "joint torque over limit max")[1:] == ["at most 1", "holds"]
    assert f"{landed.real_time_factor:.1f} x real time" in text


@pytest.mark.parametrize(("speed", "found"), [(0.2, "0.200"), (None, "-"), (float("nan"), "nan")])
def test_missed_bound_fails(landed, printed, speed, found) -> None:
    text = printed(replace(landed, touchdown={**landed.touchdown, "speed_mps": speed}))
    assert row(text, "speed [m/s]") == [found, "at most 0.15", "fails"]


def test_takeoff_shows_its_release_alone(landed, printed) -> None:
    text = printed(replace(landed, release={"hinge_force_n": 0.3, "speed_mps": 0.012, "drop_m": 0.0003}))
    assert row(text, "hinge force [N]") == ["0.30", "-", ""]
    assert row(text, "drop [mm]") == ["0.3", "-", ""]
    assert "touchdown" not in text
    assert "beside the middle" not in text


def test_limits_violated_and_enforced(landed, printed) -> None:
    records = landed.records.copy()
    records["health"]["flags"] = 0
    calm = printed(replace(landed, records=records))
    assert "Limits violated: none" in calm
    assert "enforced a limit: none" in calm
    records["health"]["flags"][np.arange(7)] = Limit.SINGULAR | Limit.JOINT_SPEED
    text = printed(replace(landed, records=records, limits_violated=["singularity", "arm_touched_uav"]))
    assert "Limits violated: singularity, arm_touched_uav" in text
    assert "enforced a limit: joint_speed 7, singularity 7" in text


def test_outcome_of_a_campaign_has_no_records(landed, printed, tmp_path) -> None:
    text = printed(replace(landed, records=None))
    assert "enforced" not in text
    assert str(tmp_path) in text
