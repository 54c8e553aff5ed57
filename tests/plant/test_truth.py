"""Truth: every sensor arrives where it belongs, forces in world axes, and no noise in any of it."""

import numpy as np
from scipy.spatial.transform import Rotation

FIELDS = {"r": "r", "v": "v", "r_cm": "r_cm", "v_cm": "v_cm", "gyro": "omega", "ee_pos": "ee", "ee_vel": "ee_v"}


def test_every_sensor_arrives_where_it_belongs(bench_in_air):
    b = bench_in_air()
    for i, name in enumerate(FIELDS):
        b.put(name, np.arange(3) + 10.0 * i)
    for name in ("q", "tau"):
        b.put(name, np.arange(7) + ord(name[0]))
    b.put("cradle_force", [7.0, 8.0, 9.0])
    b.read(3)
    for i, field in enumerate(FIELDS.values()):
        np.testing.assert_array_equal(b.t[field][0], np.arange(3) + 10.0 * i)
    np.testing.assert_array_equal(b.t["q"][0], np.arange(7) + ord("q"))
    np.testing.assert_array_equal(b.t["tau"][0], np.arange(7) + ord("t"))
    np.testing.assert_array_equal(b.t["cradle_force"][0], [7.0, 8.0, 9.0])
    assert b.t["tick"] == 3


def test_hinge_force_is_recorded_in_world_axes_and_of_the_arm_on_the_uav(bench, bench_in_air):
    """On the hinge the sensor speaks of the UAV, in its axes; on a hanging plate of the plate, in the plate's."""
    turn = Rotation.from_rotvec([0.3, -0.5, 0.9])
    for b, quat, sign in ((bench(), "quat", 1.0), (bench_in_air(), "plate_quat", -1.0)):
        b.put(quat, turn.as_quat(scalar_first=True))
        b.put("hinge_force", [1.0, -2.0, 3.0])
        b.read(0)
        np.testing.assert_allclose(b.t["hinge_force"][0], sign * turn.apply([1.0, -2.0, 3.0]), atol=1e-14)


def test_foul_is_the_size_of_each_contact(bench_in_air):
    b = bench_in_air()
    for name, force in (("arm_cradle_force", [3, 0, 4]), ("arm_floor_force", [0, 0, 2]), ("arm_uav_force", [1, 2, 2])):
        b.put(name, force)
    b.put("plate_cradle_force", [0, 6, 8])
    b.put("ground_force", [2, 3, 6])
    b.read(0)
    np.testing.assert_allclose(b.t["foul"][0], [5.0, 2.0, 3.0, 10.0, 7.0])


def test_truth_carries_no_noise(bench):
    sigmas = ("joint_position_rad", "joint_velocity_rad_s", "force_n", "torque_nm", "attitude_rad", "rate_rad_s")
    b = bench(sensors=dict.fromkeys(sigmas, 1.0))
    b.put("r", [1.0, 2.0, 3.0])
    b.read(0)
    quiet = b.t.copy()
    b.read(0, noise=1.0)
    np.testing.assert_array_equal(b.t, quiet)
    assert np.abs(b.m["q"]).min() > 0.5
