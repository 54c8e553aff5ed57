"""The attitude loop on board: opposes tilt and rate, and finds the torque that disturbs it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

THETA, OMEGA = np.array([2e-3, -1e-3, 3e-3]), np.array([0.1, 0.2, -0.3])
WIDE = {"min_thrust_n": 0.0, "max_thrust_n": 50.0}


def torque(b, theta=THETA, omega=OMEGA, k=0):
    b.put("quat", Rotation.from_rotvec(theta).as_quat(scalar_first=True))
    b.put("gyro", omega)
    b.read(k)
    R = Rotation.from_rotvec(theta) * Rotation.from_rotvec(omega * 1e-3)
    return R.inv().apply(b.act(k)[3:])


@pytest.mark.parametrize("controller", ["quaternion_pd", "geometric"])
def test_it_opposes_tilt_and_rate_in_body_axes(bench, controller):
    """Small tilt θ about an axis: torque −k_p θ − k_d ω; the geometric one adds ω × Jω, which turns the UAV's axes."""
    gains = {"controller": controller, "kp_nm": [0.4, 0.5, 0.3], "kd_nms": [0.05, 0.06, 0.07]}
    found = torque(bench(onboard=gains, rotors=WIDE))
    expected = -np.array([0.4, 0.5, 0.3]) * THETA - np.array([0.05, 0.06, 0.07]) * OMEGA
    if controller == "geometric":
        expected += np.cross(OMEGA, np.diag([0.006, 0.007, 0.012]) @ OMEGA)
    np.testing.assert_allclose(found, expected, atol=1e-6)


def test_cascade_stands_on_the_same_gains_at_rest_and_leads_where_the_rate_changes(bench):
    gains = {"controller": "cascade", "kp_nm": [0.4, 0.5, 0.3], "kd_nms": [0.05, 0.06, 0.07], "lead_s": 0.05}
    b = bench(onboard=gains, rotors=WIDE)
    for k in range(200):
        found = torque(b, omega=np.zeros(3), k=k)
    np.testing.assert_allclose(found, -np.array([0.4, 0.5, 0.3]) * THETA, rtol=1e-6)
    # A jump of the rate: k_d + k_p T on the rate, and k_d T on its change, filtered over 10 ms and one sample.
    step, kp, kd, lead = (
        torque(b, omega=0.05 * OMEGA, k=200),
        np.array([0.4, 0.5, 0.3]),
        np.array([0.05, 0.06, 0.07]),
        0.05,
    )
    expected = -kp * THETA - (kd + kp * lead + kd * lead / 0.011) * 0.05 * OMEGA
    np.testing.assert_allclose(step, expected, atol=1e-6)


@pytest.mark.parametrize(("bandwidth", "cancelled"), [(8.0, True), (0.0, False)])
def test_observer_finds_a_constant_torque_and_cancels_it(bench, bandwidth, cancelled):
    """A UAV held still by a hidden torque of 10 mN·m: the rotors take it over; without observer it turns on."""
    b = bench(onboard={"observer_rad_s": bandwidth}, rotors=WIDE)
    inertia, omega, hidden = np.diag(b.told["onboard"]["inertia"][0]), np.zeros(3), np.array([0.01, 0.0, 0.0])
    for k in range(2000):
        given = torque(b, np.zeros(3), omega, k)
        omega = omega + 1e-3 * (given + hidden) / inertia
    assert (np.abs(omega).max() < 2e-3) == cancelled


def test_controller_knows_the_inertia_of_what_flies(bench):
    J = [[0.008, 0.0, 0.001], [0.0, 0.009, 0.0], [0.001, 0.0, 0.014]]
    np.testing.assert_allclose(bench().told["onboard"]["inertia"][0], np.diag([0.006, 0.007, 0.012]))
    np.testing.assert_allclose(bench(uav={"inertia_kgm2": J}).told["onboard"]["inertia"][0], J, atol=1e-12)
