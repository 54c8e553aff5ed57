"""Whole landings and take-offs without faults; those with them are in `faults`."""

import json

import pytest

from armland.errors import ConfigurationError
from armland.experiments.episode import attempt, fly, never_acted, quiet, result_of_log
from armland.experiments.judge.brief import brief_of
from armland.experiments.judge.judgement import judge
from armland.plant.draw import draw
from armland.records import MESSAGES
from armland.runtime.log import read_log
from armland.scenario import Scenario

KEYS = {
    "mission",
    "experiment",
    "law",
    "seed",
    "success",
    "reason",
    "phases",
    "retries",
    "capture",
    "touchdown",
    "hinge_force_max_n",
    "joint_torque_max_ratio",
    "limits_violated",
    "never_acted",
    "real_time_factor",
}


def test_lands(landed):
    result = landed.result
    assert result["success"], result["reason"]
    assert result["state"] == "standing"
    assert result["touchdown"]["speed_mps"] <= 0.15
    assert result["touchdown"]["tilt_deg"] <= 3.0
    assert result["touchdown"]["offset_m"] <= 0.010
    assert result["hinge_force_max_n"] <= 0.6 * 177.0
    assert result["capture"]["offset_m"] < 0.007


def test_takes_off(taken_off):
    result = taken_off.result
    assert result["success"], result["reason"]
    assert result["state"] == "flying"
    assert result["release"]["hinge_force_n"] < 1.0
    assert result["release"]["drop_m"] < 0.02


def test_result_has_the_promised_keys_and_is_plain_data(landed):
    result = json.loads(json.dumps(landed.result, allow_nan=False))
    assert set(result) >= KEYS
    assert set(result["capture"]) == {"offset_m", "relative_speed_mps", "tilt_deg"}
    assert set(result["touchdown"]) == {"speed_mps", "tilt_deg", "offset_m"}
    times = [(p["start_s"], p["end_s"]) for p in result["phases"]]
    assert [a for a, _ in times[1:]] == [b for _, b in times[:-1]]


def test_log_holds_the_ticks_and_all_that_judging_needs(flown):
    for episode, told in flown.values():
        log = read_log(episode.log)
        for name in MESSAGES:
            assert log.messages[name].tobytes() == episode.ticks[name].tobytes()
        assert judge(log.messages, brief_of(log.metadata)) == episode.judgement
        unknown = {"law_failure", "never_acted", "log_cut_short", "simulated_s", "wall_s", "real_time_factor"}
        assert result_of_log(log) == {k: v for k, v in episode.result.items() if k not in unknown}
        assert [phase for phase, _ in told] == [p.name for p in episode.judgement.phases]
        assert Scenario.model_validate_json(log.metadata["scenario"]).run.seed == 1
        assert set(json.loads(log.metadata["versions"])) == {"mujoco", "numba", "numpy"}


def test_same_seed_flies_byte_for_byte_the_same(landed, landing_scenario):
    assert fly(landing_scenario, "landing", 1).ticks.tobytes() == landed.ticks.tobytes()


def test_ideal_sensors_place_it_more_exactly(landing_scenario):
    result = fly(quiet(landing_scenario), "landing").result
    assert result["success"], result["reason"]
    assert result["touchdown"]["offset_m"] < 5e-4


def test_thrust_leaves_the_rotors_only_as_the_hinge_takes_over(landed):
    names, phase = landed.metadata["phases"].split(","), landed.ticks["mission"]["phase"]
    over = landed.ticks["truth"][phase == names.index("hand_over")]
    carried = over["hinge_force"][:, 2] + over["rotor_thrust"].sum(axis=1)
    assert carried.min() > 0.8 * 0.48 * 9.81


def test_what_is_refused_is_refused_before_anything_is_written(landing_scenario, tmp_path):
    heavy = landing_scenario.replaced({"uav": {"extra_mass_kg": 1.0}})
    with pytest.raises(ConfigurationError, match="rotors"):
        fly(heavy, "landing", log=tmp_path / "run.mcap")
    assert list(tmp_path.iterdir()) == []


def test_an_attempt_that_breaks_is_a_row(landing_scenario):
    row = attempt(landing_scenario, "landing", 1, law="no_such_law")
    assert (row["success"], row["seed"], row["mission"]) == (False, 1, "landing")
    assert "no_such_law" in row["reason"]


def test_faults_that_never_acted_are_named(landing_scenario):
    faults = [{"kind": "link_loss", "phase": "miss", "after_s": 0.5}, {"kind": "wrench_frozen"}]
    flawed = landing_scenario.replaced({"faults": faults})
    assert never_acted(flawed, (False, True)) == ["link_loss (0.5 s after miss)"]
    assert never_acted(flawed, (True, False)) == ["wrench_frozen (0 s after the start)"]


def test_nothing_is_drawn_and_nothing_fails(landing_scenario):
    flawed = landing_scenario.replaced({"faults": [{"kind": "link_loss"}]})
    still = quiet(flawed)
    assert still.faults == ()
    assert not still.imperfections.noise
    assert not still.imperfections.camera
    assert quiet(flawed, camera=True).imperfections.camera
    one, other = (draw(still.with_seed(seed), "air") for seed in (1, 2))
    assert all((a == b).all() if hasattr(a, "all") else a == b for a, b in zip(one, other, strict=True))
    assert (one.wrench_bias == 0.0).all()
    assert one.thrust_factor == 1.0
