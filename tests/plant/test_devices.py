"""The demonstrator's devices one by one, with numbers fed to them by hand: filter, noise, link, limits, rotors."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.models.uav import mixer
from armland.plant.devices import ADDRESSES, PARAMETERS, STATE, actuate, sense
from armland.records import Tick

JOINTS = 7
POSITION = np.array([[0.127, 0.127, 0.02], [-0.127, 0.127, 0.02], [-0.127, -0.127, 0.02], [0.127, -0.127, 0.02]])
SENSORS = (("q", 7), ("qd", 7), ("tau", 7), ("force", 6), ("quat", 4), ("gyro", 3), ("r", 3), ("v", 3), ("v_cm", 3))
LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


@pytest.fixture
def bench():
    """Parameters without noise, delay, lag or periods, and a state at rest; `sense` and `act` for a tick."""
    p, s, adr = np.zeros(1, PARAMETERS), np.zeros(1, STATE), np.zeros(1, ADDRESSES)
    p["link_period"] = p["onboard_period"] = 1
    p["effectiveness"], p["torque_limit"] = 1.0, 1.0
    p["mixer"] = mixer(POSITION, 0.02)
    p["mixer_inverse"] = np.linalg.inv(p["mixer"][0])
    p["rotor_min"], p["rotor_max"], p["rotor_gain"] = 0.09, 1.86, 1.0
    p["filter_gain"], p["tick_s"], p["idle_thrust"] = 1.0, 1e-3, 2.0
    at = 0
    for name, size in (*SENSORS, ("hinge", 3)):
        adr[name] = at
        at += size
    data = np.zeros(at)
    tick = Tick(JOINTS)
    ctrl, applied = np.zeros(JOINTS), np.zeros(6)

    def put(name, values):
        start = int(adr[name][0])
        data[start : start + len(values)] = values

    def read(k, noise=0.0):
        rows = (np.full(2 * JOINTS, noise), np.full(6, noise), np.full(6, noise))
        sense(k, data, adr, p, s, *rows, tick.measurement, tick.truth)
        return tick

    def act(k, tau=0.0, delta_tau=0.0, thrust=2.0, tau_max=100.0):
        tick.command["tau"], tick.command["delta_tau"], tick.command["thrust"] = tau, delta_tau, thrust
        actuate(k, tick.command, tick.truth, np.full(JOINTS, tau_max), p, s, ctrl, applied)
        return applied

    put("quat", LEVEL)
    tick.truth["quat"] = LEVEL
    return SimpleNamespace(p=p, s=s, tick=tick, put=put, read=read, act=act, ctrl=ctrl)


def test_every_sensor_arrives_where_it_belongs(bench):
    values = {name: np.arange(size) + 10.0 * i for i, (name, size) in enumerate(SENSORS, 1) if name != "quat"}
    for name, numbers in values.items():
        bench.put(name, numbers)
    tick = bench.read(3)
    assert (tick.measurement["tick"][0], tick.truth["tick"][0]) == (3, 3)
    for record, field, name in (
        (tick.measurement, "q", "q"),
        (tick.measurement, "qd", "qd"),
        (tick.measurement, "wrench", "force"),
        (tick.measurement, "uav_rate", "gyro"),
        (tick.truth, "tau", "tau"),
        (tick.truth, "omega", "gyro"),
        (tick.truth, "r", "r"),
        (tick.truth, "v", "v"),
        (tick.truth, "v_cm", "v_cm"),
    ):
        np.testing.assert_array_equal(record[field][0], values[name])


def test_hinge_force_is_recorded_in_world_axes(bench):
    turn = Rotation.from_rotvec([0.3, -0.5, 0.9])
    bench.put("quat", turn.as_quat(scalar_first=True))
    bench.put("hinge", [1.0, -2.0, 3.0])
    np.testing.assert_allclose(bench.read(0).truth["hinge_force"][0], turn.apply([1.0, -2.0, 3.0]), atol=1e-14)


def test_rotor_thrusts_are_recorded_with_the_torque_they_make(bench):
    thrusts = np.array([0.4, 0.5, 0.7, 0.6])
    bench.s["rotor"] = thrusts
    tick = bench.read(0)
    up, spin = np.array([0.0, 0.0, 1.0]), np.array([1, -1, 1, -1])
    torque = sum(np.cross(p, t * up) + 0.02 * c * t * up for p, t, c in zip(POSITION, thrusts, spin, strict=True))
    np.testing.assert_array_equal(tick.truth["rotor_thrust"][0], thrusts)
    np.testing.assert_allclose(tick.truth["tau_uav"][0], torque, atol=1e-15)


def set_filter(bench, hz, rate=1000.0):
    bench.p["filter_gain"] = 1.0 - np.exp(-2.0 * np.pi * hz / rate)


def test_force_torque_filter_answers_a_step_like_a_first_order_low_pass(bench):
    """1 − e^(−2π f t) at 20 Hz; the first sample starts the filter where the sensor is."""
    set_filter(bench, 20.0)
    bench.put("force", [5.0] * 6)
    np.testing.assert_array_equal(bench.read(0).measurement["wrench"][0], 5.0)
    bench.put("force", [6.0] * 6)
    answer = np.array([bench.read(k).measurement["wrench"][0, 2] for k in range(1, 51)]) - 5.0
    np.testing.assert_allclose(answer, 1.0 - np.exp(-2.0 * np.pi * 20.0 * 1e-3 * np.arange(1, 51)), atol=1e-12)


def test_force_torque_filter_halves_the_power_at_its_cut_off(bench):
    set_filter(bench, 20.0)
    out = []
    for k in range(1000):
        bench.put("force", [np.sin(2.0 * np.pi * 20.0 * k * 1e-3)] * 6)
        out.append(bench.read(k).measurement["wrench"][0, 0])
    assert np.ptp(out[500:]) / 2.0 == pytest.approx(np.sqrt(0.5), rel=0.02)


def test_noise_has_the_size_of_its_sensor_and_bias_sits_on_the_force_alone(bench):
    sigmas = {"sigma_q": 1.0, "sigma_qd": 2.0, "sigma_force": 3.0, "sigma_torque": 4.0, "sigma_rate": 5.0}
    for name, value in sigmas.items():
        bench.p[name] = value
    bench.p["force_bias"] = [0.1, 0.2, 0.3]
    m = bench.read(0, noise=1.0).measurement
    np.testing.assert_array_equal(m["q"], 1.0)
    np.testing.assert_array_equal(m["qd"], 2.0)
    np.testing.assert_allclose(m["wrench"][0], [3.1, 3.2, 3.3, 4.0, 4.0, 4.0])
    np.testing.assert_array_equal(m["uav_rate"], 5.0)


def test_attitude_noise_is_a_rotation_of_its_size(bench):
    bench.p["sigma_attitude"] = 2e-3
    turn = Rotation.from_rotvec([0.3, -0.5, 0.9])
    bench.put("quat", turn.as_quat(scalar_first=True))
    measured = bench.read(0, noise=1.0).measurement["uav_quat"][0]
    assert np.linalg.norm(measured) == pytest.approx(1.0, abs=1e-12)
    error = turn.inv() * Rotation.from_quat(measured, scalar_first=True)
    np.testing.assert_allclose(error.as_rotvec(), 2e-3, rtol=1e-9)


def test_truth_carries_no_noise(bench):
    for name in ("sigma_q", "sigma_qd", "sigma_force", "sigma_torque", "sigma_attitude", "sigma_rate"):
        bench.p[name] = 1.0
    bench.put("r", [1.0, 2.0, 3.0])
    quiet = bench.read(0).truth.copy()
    np.testing.assert_array_equal(bench.read(0, noise=1.0).truth, quiet)


@pytest.mark.parametrize("delay", [0, 1, 12, 1023])
def test_downlink_brings_the_sample_of_exactly_that_many_ticks_ago(bench, delay):
    bench.p["downlink"] = delay
    for k in range(1300):
        bench.put("gyro", [float(k)] * 3)
        m = bench.read(k).measurement
        if k >= delay:
            assert m["uav_rate"][0, 0] == k - delay
            assert m["uav_tick"][0] == k - delay


@pytest.mark.parametrize("delay", [0, 1, 25, 1023])
def test_uplink_acts_exactly_that_many_ticks_later(bench, delay):
    """The thrust of tick k is 2 N + k mN; before anything has arrived the rotors idle as they did."""
    bench.p["uplink"] = delay
    for k in range(1300):
        lift = bench.act(k, thrust=2.0 + 1e-3 * k)[2]
        assert lift == pytest.approx(2.0 + 1e-3 * max(k - delay, 0), abs=1e-9)


def test_onboard_controller_runs_at_its_own_rate(bench):
    bench.p["onboard_period"] = 5
    lifts = [bench.act(k, thrust=2.0 + 0.01 * k)[2] for k in range(20)]
    np.testing.assert_allclose(lifts, 2.0 + 0.05 * (np.arange(20) // 5), atol=1e-12)


def test_extra_torque_arrives_limited_and_then_weakened(bench):
    """The UAV accepts at most 0.03 N·m per axis and its rotors make 0.65 of what it accepts."""
    bench.p["torque_limit"], bench.p["effectiveness"] = [0.03, 0.03, 0.02], 0.65
    for asked, acts in (
        ([0.01, -0.02, 0.005], [0.0065, -0.013, 0.00325]),
        ([5.0, -0.02, -5.0], [0.0195, -0.013, -0.013]),
    ):
        wrench = bench.act(0, delta_tau=asked)
        np.testing.assert_allclose(wrench, [0.0, 0.0, 2.0, *acts], atol=1e-12)


def test_onboard_attitude_controller_opposes_tilt_and_rate_in_body_axes(bench):
    """Small tilt θ about an axis: torque −k_p θ − k_d ω, here turned into the world by a heading of 90°."""
    bench.p["kp"], bench.p["kd"] = [0.4, 0.5, 0.3], [0.05, 0.06, 0.07]
    bench.p["rotor_min"], bench.p["rotor_max"] = -10.0, 10.0
    theta = np.array([2e-3, -1e-3, 3e-3])
    bench.put("quat", Rotation.from_rotvec(theta).as_quat(scalar_first=True))
    bench.put("gyro", [0.1, 0.2, -0.3])
    bench.read(0)
    wrench = bench.act(0)
    R = Rotation.from_rotvec(theta) * Rotation.from_rotvec(np.array([0.1, 0.2, -0.3]) * 1e-3)
    body = R.inv().apply(wrench[3:])
    expected = -np.array([0.4, 0.5, 0.3]) * theta - np.array([0.05, 0.06, 0.07]) * [0.1, 0.2, -0.3]
    np.testing.assert_allclose(body, expected, atol=1e-7)
    np.testing.assert_allclose(wrench[:3], R.apply([0.0, 0.0, 2.0]), atol=1e-12)


def test_rotors_reach_a_share_of_their_set_point_each_tick(bench):
    bench.p["rotor_gain"] = 1.0 - np.exp(-1e-3 / 0.05)
    bench.s["rotor"] = bench.s["rotor_asked"] = 0.5
    lifts = np.array([bench.act(k, thrust=3.0)[2] for k in range(200)])
    np.testing.assert_allclose(lifts, 3.0 - np.exp(-1e-3 * np.arange(1, 201) / 0.05), atol=1e-9)


def test_joint_torques_stay_within_the_motors_limits(bench):
    bench.act(0, tau=[50.0, -50.0, 150.0, -150.0, 0.0, 100.0, -100.0])
    np.testing.assert_array_equal(bench.ctrl, [50.0, -50.0, 100.0, -100.0, 0.0, 100.0, -100.0])


def test_state_that_is_not_finite_is_noticed(bench):
    limits, applied = np.full(JOINTS, 1.0), np.zeros(6)
    arguments = (bench.tick.command, bench.tick.truth, limits, bench.p, bench.s, bench.ctrl, applied)
    assert actuate(0, *arguments)
    bench.tick.truth["omega"][0, 1] = np.nan
    assert not actuate(1, *arguments)
