"""A landing without an arm flown whole: the compiled loop and the Python loop, the same devices, the judge."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.experiments.episode import fly, fly_prepared, prepare
from armland.runtime import loops
from armland.runtime.recorder import Recorder
from armland.scenario import load_scenario

SEA = {"sea": {"state": "ss3", "hull_m": 4.0}, "deviation": {"level": "published"}}


@pytest.fixture(scope="module")
def landed():
    return fly(load_scenario("unassisted"), "unassisted", 3)


def test_it_lands_in_calm_air(landed):
    assert landed.result["state"] == "standing"
    assert landed.result["end"] == "done"
    assert landed.result["touchdown"]["speed_mps"] < 0.25
    assert landed.result["touchdown"]["offset_m"] < 0.1


def test_thrust_carries_the_weight_on_the_station_and_nothing_once_it_stands(landed):
    truth, phase = landed.ticks["truth"], landed.ticks["mission"]["phase"]
    weight = float(landed.metadata["weight"])
    late = np.flatnonzero(phase == 1)[-200:]
    assert truth["rotor_thrust"][late].sum(axis=1).mean() == pytest.approx(weight, rel=0.06)
    assert truth["rotor_thrust"][-1].sum() < 0.05
    # Then the pad carries it.
    assert truth["cradle_force"][-100:, 2].mean() == pytest.approx(weight, rel=0.03)


def test_energy_is_what_thrust_drag_and_weight_leave(landed):
    # Work of all forces along the path until the touchdown: of the rotors' thrust along body z, horizontal drag, weight.
    t = landed.ticks["truth"]
    before = int(np.argmax(t["cradle_force"][:, 2] > 0.1)) - 5
    q, v, m = t["quat"][:before], t["v_cm"][:before], float(landed.metadata["weight"]) / 9.81
    z = np.stack(
        [
            2 * (q[:, 1] * q[:, 3] + q[:, 0] * q[:, 2]),
            2 * (q[:, 2] * q[:, 3] - q[:, 0] * q[:, 1]),
            1 - 2 * (q[:, 1] ** 2 + q[:, 2] ** 2),
        ],
        axis=1,
    )
    force = t["rotor_thrust"][:before].sum(axis=1)[:, None] * z
    force[:, :2] -= 0.22 * v[:, :2]
    force[:, 2] -= m * 9.81
    # The swinging plate is a twentieth of the mass and takes part of it.
    work, kinetic = np.sum(force * v) * 1e-3, 0.5 * m * np.sum(v[-1] ** 2 - v[0] ** 2)
    assert work == pytest.approx(kinetic, abs=6e-3)


def test_same_seed_same_bytes_and_python_flies_the_same(landed):
    again = prepare(load_scenario("unassisted"), "unassisted", 3)
    plan, controller = again.plan, again.controller
    with Recorder(None, plan.joints, again.period_ns) as recorder:
        short = plan._replace(ticks=2500)
        loops.fly_in_python(again.simulator, controller, short, recorder)
    ticks = recorder.ticks
    assert ticks.tobytes() == landed.ticks[: len(ticks)].tobytes()


def test_start_and_sensors_are_those_of_the_arms_landing():
    own = prepare(load_scenario("unassisted", SEA), "unassisted", 11).simulator
    arms = prepare(load_scenario("landing", SEA), "landing", 11).simulator
    # Each begins as far from its own station: in waves the arm's catch stands higher above its cradle.
    begins, theirs = (s.drawn.position - np.array(s.scenario.place.catch_m) for s in (own, arms))
    np.testing.assert_allclose(begins, theirs, atol=1e-12)
    np.testing.assert_array_equal(own.timed_deck, arms.timed_deck)
    for device in ("imu", "link", "rotors", "reference"):
        assert own.world["told"][device].tobytes() == arms.world["told"][device].tobytes(), device
    differ = {
        name
        for name in own.world["told"]["camera"].dtype.names
        if own.world["told"]["camera"][name].tobytes() != arms.world["told"]["camera"][name].tobytes()
    }
    assert differ == set()


def test_ground_effect_is_the_pads():
    world = prepare(load_scenario("unassisted", SEA), "unassisted", 11).simulator.world
    assert float(world["told"]["air"]["rails"][0]) == pytest.approx(0.45)
    assert float(world["told"]["air"]["over"][0]) == 1.0


def test_a_uav_that_is_thrown_off_course_by_a_dead_rotor_is_no_success():
    broken = load_scenario("unassisted", {"faults": [{"kind": "rotor_loss", "rotor": 1, "after_s": 3.0}]})
    result = fly(broken, "unassisted", 3).result
    assert not result["success"]
    assert result["state"] != "flying"


def test_faults_of_an_arm_are_refused():
    for fault in ({"kind": "encoder_frozen"}, {"kind": "non_finite", "device": "wrench"}):
        with pytest.raises(ConfigurationError, match="flies without an arm"):
            prepare(load_scenario("unassisted", {"faults": [{**fault, "after_s": 1.0}]}), "unassisted", 3)


@pytest.mark.slow
def test_timing_comes_down_at_a_quieter_moment():
    quiet, hasty = [], []
    for timed, out in ((True, quiet), (False, hasty)):
        scenario = load_scenario("unassisted", {**SEA, "descent": {"timed": timed, "quiet": 0.6}})
        for seed in range(501, 509):
            flight = fly_prepared(prepare(scenario, "unassisted", seed))
            phase = flight.ticks["mission"]["phase"]
            begin = np.flatnonzero(phase == 3)
            if len(begin):
                out.append(float(flight.ticks["mission"]["progress"][begin[0]]))
    assert np.median(quiet) < 0.6
    assert np.median(quiet) < np.median(hasty)
