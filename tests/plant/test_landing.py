"""The landing's plant behind the port: starts, sensors with their clocks, the UAV on board, and the port's refusals."""

import numpy as np
import pytest

from armland.errors import ConfigurationError, PlantError
from armland.mission.landing_scenario import landing_scenario
from armland.mission.landing_setup import set_up
from armland.mission.records import LandingTick, UavMode
from armland.plant.landing import LandingPlant, draw
from armland.rotations import angle, conjugate, multiply

CALM = {
    "force_bias_n": 0.0,
    "torque_bias_nm": 0.0,
    "heading_error_deg": 0.0,
    "tilt_error_deg": 0.0,
    "hover_noise_m": 0.0,
}
HOME = set_up(landing_scenario()).home


class Bench:
    def __init__(self, start="air", faults=(), **imperfections):
        overrides = {"imperfections": {**CALM, **imperfections}, "faults": list(faults)}
        self.scenario = landing_scenario("landing", overrides)
        self.plant, self.tick = LandingPlant(self.scenario, HOME, start), LandingTick(7)
        self.tick.command["uav_quat"][0, 0] = 1.0
        self.plant.connect()

    def run(self, ticks, mode=UavMode.AUTONOMOUS, thrust=0.0):
        s, d = self.plant.scene, self.plant.data
        for _ in range(ticks):
            self.plant.read(self.tick)
            c = self.tick.command
            c["tau"] = d.qfrc_bias[s.joint_dof] - 3000.0 * (d.qpos[s.joint_qpos] - HOME) - 60.0 * d.qvel[s.joint_dof]
            c["uav_mode"], c["thrust"] = mode, thrust
            self.plant.command(self.tick)
        return self.tick.measurement[0], self.tick.truth[0]


def test_uav_hovers_by_itself_where_it_was_met():
    bench = Bench()
    start = bench.run(1)[1]["r"].copy()
    _, truth = bench.run(4000)
    assert np.linalg.norm(truth["r"] - start) < 0.15
    assert np.linalg.norm(truth["v"]) < 0.05


def test_uav_that_only_gets_too_little_thrust_sinks():
    _, truth = Bench().run(250, UavMode.GUIDED, 3.0)
    assert truth["v"][2] < -0.5


@pytest.mark.parametrize(("mode", "rises"), [(UavMode.GUIDED, True), (UavMode.HELD, False)])
def test_uav_without_link_climbs_away_unless_it_is_held(mode, rises):
    bench = Bench(faults=[{"kind": "link_loss", "after_s": 0.2}])
    start = bench.run(1)[1]["r"][2]
    weight = bench.plant.scene.uav_mass * 9.81 / bench.plant._draw.thrust_factor
    _, truth = bench.run(4000, mode, weight)
    assert (truth["r"][2] - start > 0.25) == rises


def test_stands_on_the_cradle_with_its_rotors_stopped():
    _, truth = Bench("cradle").run(800, UavMode.OFF)
    np.testing.assert_allclose(truth["r"], [0.68, 0.0, 0.701], atol=5e-4)
    assert truth["cradle_force"][2] == pytest.approx(0.5277 * 9.81, abs=0.01)
    assert not truth["rotor_thrust"].any()


def test_clocks_say_how_old_a_sample_is():
    m, _ = Bench().run(500)
    assert m["tick"] == m["arm_tick"] == m["wrench_tick"] == 499
    assert 12 <= m["tick"] - m["uav_tick"] <= 17
    assert 50 <= m["tick"] - m["camera_capture"] <= 110


@pytest.mark.parametrize(
    ("kind", "clock"),
    [
        ("downlink_loss", "uav_tick"),
        ("arm_stale", "arm_tick"),
        ("wrench_frozen", "wrench_tick"),
        ("camera_lost", "camera_capture"),
    ],
)
def test_fault_stops_the_clock_of_its_device_alone(kind, clock):
    m, _ = Bench(faults=[{"kind": kind, "after_s": 0.3}]).run(1000)
    for name in ("uav_tick", "arm_tick", "wrench_tick", "camera_capture"):
        assert (m["tick"] - m[name] > 600) == (name == clock)


def test_frozen_camera_keeps_its_clock_and_repeats_its_image():
    bench = Bench(faults=[{"kind": "camera_frozen", "after_s": 0.5}])
    first = bench.run(900)[0]["camera_position"].copy()
    m, _ = bench.run(300)
    assert m["tick"] - m["camera_capture"] < 120
    np.testing.assert_array_equal(m["camera_position"], first)


def test_force_sensor_reads_tool_and_bias():
    m, _ = Bench(noise=False).run(400)
    np.testing.assert_allclose(m["wrench"][:3], [0.0, 0.0, 0.3 * 9.81], atol=0.02)
    biased = Bench(noise=False, force_bias_n=1.0)
    np.testing.assert_allclose(
        biased.run(400)[0]["wrench"][:3] - m["wrench"][:3], biased.plant._draw.wrench_bias[:3], atol=0.02
    )


def test_heading_error_shows_in_what_the_uav_reports():
    bench = Bench(noise=False, heading_error_deg=10.0)
    m, truth = bench.run(400)
    error = angle(multiply(m["uav_quat"], conjugate(truth["quat"])))
    assert error == pytest.approx(angle(bench.plant._draw.imu_bias), abs=5e-3)
    assert error > 0.01


def test_each_seed_draws_its_own_start_within_the_box():
    draws = [draw(landing_scenario("landing", {"seed": seed}), np.zeros(3)) for seed in range(30)]
    position = np.array([d.position for d in draws])
    assert (np.abs(position) <= [0.10, 0.10, 0.15]).all()
    assert len(np.unique(position)) == position.size
    np.testing.assert_array_equal(draw(landing_scenario("landing", {"seed": 7}), np.zeros(3)).position, position[7])


def test_connecting_again_starts_over():
    bench = Bench(faults=[{"kind": "magnet_coil", "after_s": 0.0}])
    first = bench.run(200)[1].copy()
    bench.plant.connect()
    second = bench.run(200)[1]
    assert first.tobytes() == second.tobytes()


def test_brake_holds_an_arm_without_torque():
    bench = Bench()
    bench.run(50)
    bench.tick.command["brake"] = 1
    for _ in range(300):
        bench.plant.read(bench.tick)
        bench.tick.command["tau"] = 0.0
        bench.plant.command(bench.tick)
    assert np.abs(bench.plant.data.qpos[bench.plant.scene.joint_qpos] - HOME).max() < 5e-3


@pytest.mark.parametrize("field", ["tau", "thrust", "uav_quat"])
def test_command_that_is_not_finite_is_refused(field):
    bench = Bench()
    bench.plant.read(bench.tick)
    bench.tick.command[field] = np.nan
    with pytest.raises(PlantError, match="not finite"):
        bench.plant.command(bench.tick)


def test_fault_in_an_unknown_phase_is_refused():
    with pytest.raises(ConfigurationError, match=r"no phase \['lunch'\]"):
        Bench(faults=[{"kind": "link_loss", "phase": "lunch"}])


@pytest.mark.parametrize(
    ("device", "field"),
    [
        ("encoders", "q"),
        ("encoders", "qd"),
        ("wrench", "wrench"),
        ("attitude", "uav_quat"),
        ("camera", "camera_position"),
    ],
)
def test_device_that_fails_sends_no_numbers(device, field):
    bench = Bench(faults=[{"kind": "non_finite", "device": device, "after_s": 0.1}])
    assert np.isfinite(bench.run(90)[0][field]).all()
    assert np.isnan(bench.run(20)[0][field]).all()


def test_encoder_that_is_off_shows_in_one_joint():
    m, _ = Bench(faults=[{"kind": "encoder_offset", "joint": 2, "size": 0.1, "after_s": 0.1}], noise=False).run(150)
    np.testing.assert_allclose(m["q"] - HOME, [0, 0.1, 0, 0, 0, 0, 0], atol=2e-3)


def test_reported_attitude_is_turned_once_and_the_uav_is_not():
    fault = {"kind": "attitude_offset", "size": 0.5, "direction": [1.0, 0.0, 0.0], "after_s": 0.1}
    m, truth = Bench(faults=[fault], noise=False).run(400)
    assert angle(multiply(m["uav_quat"], conjugate(truth["quat"]))) == pytest.approx(0.5, abs=0.02)
    assert abs(truth["quat"][0]) > 0.99


def test_push_on_the_tool_is_felt_and_on_the_elbow_is_not():
    def change(body):
        bench = Bench(faults=[{"kind": "push", "body": body, "size": 20.0, "after_s": 0.3}], noise=False)
        return bench.run(299)[0]["wrench"][2], bench.run(60)[0]["wrench"][2]

    before, after = change("tool")
    assert after - before == pytest.approx(-20.0, abs=2.0)
    before, after = change("elbow")
    assert abs(after - before) < 3.0


def test_push_ends_when_the_fault_does():
    bench = Bench(faults=[{"kind": "push", "body": "elbow", "size": 50.0, "after_s": 0.1, "lasts_s": 0.05}])
    bench.run(120)
    assert np.abs(bench.plant.data.xfrc_applied[bench.plant._bodies["elbow"]]).max() == 50.0
    bench.run(60)
    assert not bench.plant.data.xfrc_applied[bench.plant._bodies["elbow"]].any()


def test_twist_turns_the_uav():
    fault = {"kind": "twist", "size": 0.2, "direction": [0.0, 0.0, 1.0], "after_s": 0.1}
    assert Bench(faults=[fault]).run(200)[1]["omega"][2] > 0.3
    assert abs(Bench().run(200)[1]["omega"][2]) < 0.1


def test_uav_says_when_it_heard_the_newest_command():
    assert 20 <= Bench().run(500)[0]["uav_heard"].item() - 400 <= 99
    m, _ = Bench(faults=[{"kind": "uplink_loss", "after_s": 0.3}]).run(1000)
    assert 290 <= m["uav_heard"] <= 330
    assert m["tick"] - m["uav_tick"] < 20


def test_fault_of_a_joint_that_is_not_there_is_refused():
    with pytest.raises(ConfigurationError, match="joint 8 does not exist; the arm has joints 1 to 7"):
        Bench(faults=[{"kind": "encoder_offset", "joint": 8}])
