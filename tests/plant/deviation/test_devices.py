"""Deviations of the devices: in the units of their rows, in the axes that they are about, refused where a device cannot hold them."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.plant.simulator import Simulator
from armland.rotations import from_rotation_vector, matrix

HOME = np.deg2rad([-4.72, -109.96, -7.94, -71.39, 11.82, 39.34, -7.2])
LIMITS = np.array([176.0, 176.0, 100.0, 100.0, 100.0, 38.0, 38.0])


@pytest.fixture
def told(landing):
    """What the devices are told of deviations that are just so: `device={entry: number}`."""

    def build(other=None, **devices):
        exact = {d: {e: [x, x] for e, x in entries.items()} for d, entries in devices.items()}
        return Simulator(landing(deviation=exact, **(other or {})), HOME, "air").world["told"]

    return build


def test_rotors_give_their_share_all_together_and_each(told):
    plain, other = told()["rotors"], told(uav={"thrust": -0.1, "rotor": 0.05, "lag": 0.5, "drag": -0.3})["rotors"]
    np.testing.assert_allclose(other["gain"], 0.9 * 1.05 * plain["gain"])
    np.testing.assert_allclose(other["drag"], 0.7 * plain["drag"])
    # α = 1 − e^(−Δt/T): half as long again makes the two thirds power of what is left.
    np.testing.assert_allclose(1.0 - other["lag"], (1.0 - plain["lag"]) ** (1.0 / 1.5))


def test_battery_loses_its_share_by_the_second(told):
    np.testing.assert_allclose(1000 * told(uav={"sag_per_s": 0.01})["rotors"]["sag"], 0.01)


def test_uav_gets_its_attitude_wrong_by_tilt_and_heading(told):
    """q_imu = b ⊗ q: the heading turns about the world's z, the tilt shows in the direction of the body's z axis."""
    bias = matrix(told(uav={"heading_deg": 90.0})["imu"]["bias"][0])
    np.testing.assert_allclose(bias @ [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], atol=1e-12)
    up = matrix(told(uav={"tilt_deg": 2.0})["imu"]["bias"][0])[:, 2]
    assert np.rad2deg(np.arccos(up[2])) == pytest.approx(2.0 * np.sqrt(2.0), rel=1e-3)
    imu = told(uav={"gyro_dps": 0.3, "drift_dps": -0.1})["imu"]
    np.testing.assert_allclose(np.rad2deg(imu["rate_bias"][0]), 0.3)
    np.testing.assert_allclose(np.rad2deg(imu["drift"]), -0.1)


def test_link_is_late_by_that_many_ticks_and_never_early(told):
    plain, other = (
        told()["link"],
        told(link={"up_ms": 10.0, "down_ms": -4.0, "jitter_ms": 7.0, "stamp_ms": -3.0})["link"],
    )
    assert other["up"] - plain["up"] == 10
    assert other["down"] - plain["down"] == -4
    assert other["jitter_up"] == other["jitter_down"] == 7
    assert other["stamp"] == -3
    for device, way in (("link", "up_ms"), ("link", "down_ms")):
        with pytest.raises(ConfigurationError, match=rf"deviation.{device}.{way}: .* before it was sent; at least -"):
            told(**{device: {way: -50.0}})


@pytest.mark.parametrize(
    ("other", "devices", "says"),
    [
        (
            {},
            {"link": {"up_ms": 1000.0}},
            "deviation.link: up 1025 ms with jitter; the link's delay line holds 1023 ms",
        ),
        ({}, {"link": {"jitter_ms": 1000.0}}, "deviation.link: up 1025 ms with jitter"),
        (
            {"camera": {"delay_ms": [50.0, 150.0]}},
            {"camera": {"delay_ms": 400.0}},
            "deviation.camera.delay_ms: images 550 ms late; 500 ms can be under way",
        ),
        (
            {"run": {"rate_hz": 2000}},
            {"arm": {"delay_ms": 20.0}},
            "deviation.arm.delay_ms: 40 ticks; a motor's delay line holds 31",
        ),
    ],
)
def test_delay_that_a_simulated_device_cannot_hold_is_refused(told, other, devices, says):
    with pytest.raises(ConfigurationError, match=says):
        told(other, **devices)


def test_longest_delays_that_a_range_allows_can_be_held_by_the_motors(told):
    assert told(arm={"delay_ms": 20.0})["motors"]["delay"] == 20


def test_camera_is_worse_by_its_shares(told):
    plain = told()["camera"]
    other = told(camera={"noise": 2.0, "exposure": 1.0, "delay_ms": 12.0, "stamp_ms": -4.0, "lose": 0.03})["camera"]
    np.testing.assert_allclose(other["honesty"], 3.0 * plain["honesty"])
    np.testing.assert_allclose(other["smear_scale"], 2.0 * plain["smear_scale"])
    assert other["delay_min"] - plain["delay_min"] == other["delay_max"] - plain["delay_max"] == 12
    assert other["stamp"] == -4
    np.testing.assert_allclose(other["lose"] - plain["lose"], 0.03)


def test_camera_sits_elsewhere_turned_and_with_another_lens(told):
    other, plain = (
        told(camera={"mount_m": 1e-3, "centre_px": 3.0, "focal": 0.01, "mount_deg": 1.0})["camera"],
        told()["camera"],
    )
    np.testing.assert_allclose(other["shift"] - plain["shift"], 1e-3)
    # A pixel of the centre is an angle of one over the focal length; a share of the focal length one of the depth.
    focal = 3.0 / (other["slope"] - plain["slope"])[0, :2]
    np.testing.assert_allclose(focal, focal[0])
    assert (other["slope"] - plain["slope"])[0, 2] == pytest.approx(0.01)
    np.testing.assert_allclose(other["turn"][0], from_rotation_vector(np.deg2rad([1.0, 1.0, 1.0])))
    assert other["askew"] == 1
    assert plain["askew"] == 0


def test_force_sensor_crosses_forces_with_forces_and_torques_with_torques(told):
    gain = told(wrench={"gain": 0.1, "cross": 0.02})["wrench"]["gain"][0]
    block = 0.1 * np.eye(3) + 0.02 * (1.0 - np.eye(3))
    np.testing.assert_allclose(gain - told()["wrench"]["gain"][0], np.kron(np.eye(2), block), atol=1e-15)
    drift = told(wrench={"drift_nps": 0.005, "drift_nmps": 2e-4})["wrench"]["drift"][0]
    np.testing.assert_allclose(drift, [0.005] * 3 + [2e-4] * 3)


def test_motors_err_by_shares_of_their_limits(told):
    motors = told(arm={"torque": 0.005, "torque_noise": 3e-4, "torque_gain": -0.02})["motors"]
    np.testing.assert_allclose(motors["offset"][0], 0.005 * LIMITS)
    np.testing.assert_allclose(motors["sigma"][0], 3e-4 * LIMITS)
    np.testing.assert_allclose(motors["gain"][0], 0.98)
    assert motors["odd"] == 1
    assert told(arm={"torque": 0.005})["motors"]["odd"] == 0


def test_weak_magnet_reports_what_its_current_promises(told):
    """A report that follows the current knows nothing of the force: rated × gain stays."""
    plain, weak = told()["magnet"], told(magnet={"force": -0.2})["magnet"]
    np.testing.assert_allclose(weak["rated"], 0.8 * plain["rated"])
    np.testing.assert_allclose(weak["rated"] * weak["report_gain"], plain["rated"] * plain["report_gain"])
    wrong = told(magnet={"force": -0.2, "report": 0.05})["magnet"]
    np.testing.assert_allclose(wrong["rated"] * wrong["report_gain"], 1.05 * plain["rated"] * plain["report_gain"])
    np.testing.assert_allclose(told(magnet={"residual_n": 0.5})["magnet"]["residual"] - plain["residual"], 0.5)


def test_wind_blows_horizontally_and_gusts_are_half_as_strong_upwards(told):
    air = told(air={"wind_mps": 2.0, "gust_mps": 0.4})["air"]
    assert np.linalg.norm(air["mean"][0, :2]) == pytest.approx(2.0)
    assert air["mean"][0, 2] == 0.0
    np.testing.assert_allclose(air["sigma"][0], [0.4, 0.4, 0.2])


@pytest.mark.parametrize("devices", [{}, {"air": {"downwash": 0.1}}, {"uav": {"mass": 0.1}}])
def test_still_air_is_not_moved(told, devices):
    assert told(**devices)["air"]["moves"] == 0


@pytest.mark.parametrize(("own", "shares"), [({}, [0.5, 0.5, 1.0]), ({"arm": {"compliance": [5e-5, 5e-5]}}, [1, 1, 1])])
def test_gear_of_a_strong_joint_winds_up_as_far_by_its_full_torque_as_the_lwrs(landing, own, shares):
    """Joints of 352 N·m, twice the strongest of the LWR's; what the user sets counts as it is."""

    def compliance(factor):
        limits = [factor * x for x in LIMITS]
        changes = {"deviation": {"level": "published", **own}, "arm": {"torque_limits_nm": limits}}
        return Simulator(landing(**changes), HOME, "air").world["told"]["encoders"]["compliance"][0]

    ratio = compliance(2.0) / compliance(1.0)
    np.testing.assert_allclose(ratio[[0, 1, 5]], shares)
