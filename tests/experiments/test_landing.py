"""Whole landings and take-offs without faults; those with them are in `test_landing_faults`."""

from functools import cache

import numpy as np
import pytest

from armland.experiments.landing import LandingOutcome, campaign, fly_landing, fly_takeoff
from armland.mission.landing_scenario import landing_scenario
from armland.mission.records import LANDING_MESSAGES
from armland.runtime.log import read_log

KEYS = {
    "success",
    "reason",
    "phases",
    "retries",
    "capture",
    "touchdown",
    "hinge_force_max_n",
    "joint_torque_max_ratio",
    "limits_violated",
    "real_time_factor",
}


@cache
def landed() -> LandingOutcome:
    return fly_landing(landing_scenario(), 1)


def test_lands():
    outcome = landed()
    assert outcome.success, outcome.reason
    assert outcome.state == "standing"
    assert outcome.touchdown["speed_mps"] <= 0.15
    assert outcome.touchdown["tilt_deg"] <= 3.0
    assert outcome.touchdown["offset_m"] <= 0.010
    assert outcome.hinge_force_max_n <= 0.6 * 177.0
    assert outcome.capture["offset_m"] < 0.007


def test_result_has_the_promised_keys():
    result = landed().result()
    assert set(result) >= KEYS
    assert set(result["capture"]) == {"offset_m", "relative_speed_mps", "tilt_deg"}
    assert set(result["touchdown"]) == {"speed_mps", "tilt_deg", "offset_m"}
    times = [(p["start_s"], p["end_s"]) for p in result["phases"]]
    assert [a for a, _ in times[1:]] == [b for _, b in times[:-1]]


def test_same_seed_lands_bit_for_bit_the_same_and_so_says_the_log(tmp_path):
    told = []
    again = fly_landing(landing_scenario(), 1, lambda *phase: told.append(phase), tmp_path / "run.mcap")
    assert again.records.tobytes() == landed().records.tobytes()
    log = read_log(tmp_path / "run.mcap")
    for name in LANDING_MESSAGES:
        assert log.messages[name].tobytes() == again.records[name].tobytes()
    assert [phase for phase, _ in told] == [p.name for p in again.phases]
    # The first tick of a phase is over when it is told of.
    np.testing.assert_allclose([t - 1e-3 for _, t in told], [p.start_s for p in again.phases], atol=1e-9)


def test_ideal_sensors_place_it_more_exactly():
    ideal = {
        "camera": False,
        "noise": False,
        "force_bias_n": 0.0,
        "torque_bias_nm": 0.0,
        "heading_error_deg": 0.0,
        "tilt_error_deg": 0.0,
        "thrust_error": 0.0,
        "hover_noise_m": 0.0,
    }
    outcome = fly_landing(landing_scenario("landing", {"imperfections": ideal}), 1)
    assert outcome.success, outcome.reason
    assert outcome.touchdown["offset_m"] < 5e-4


def test_takes_off():
    outcome = fly_takeoff(landing_scenario(), 1)
    assert outcome.success, outcome.reason
    assert outcome.state == "flying"
    assert outcome.release["hinge_force_n"] < 1.0
    assert outcome.release["drop_m"] < 0.02


@pytest.mark.slow
@pytest.mark.parametrize("mission", ["landing", "takeoff"])
def test_seeds_succeed(mission):
    outcomes = campaign(landing_scenario(), range(100, 112), mission)
    assert [(o.seed, o.reason) for o in outcomes if not o.success] == []
    assert len({round(o.phases[1].end_s, 3) for o in outcomes}) > 5 or mission == "takeoff"


def test_thrust_leaves_the_rotors_only_as_the_hinge_takes_over():
    records, names = landed().records, [p.name for p in landed().phases]
    phase = records["mission"]["phase"]
    over = records[phase == phase[np.flatnonzero(np.diff(phase))[names.index("carry") - 1]]]
    carried = over["truth"]["hinge_force"][:, 2] + over["truth"]["rotor_thrust"].sum(axis=1)
    assert carried.min() > 0.8 * 0.48 * 9.81
