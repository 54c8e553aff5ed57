"""What camera and link say of the UAV: attitude, plate on the magnet, and what else is known to move it."""

import numpy as np
import pytest

from armland.mission.reference.moves import HOLD, LAUNCH, LEAVE
from armland.mission.sight import known_push, lift_of, look_at_grip, quaternion_of, take_attitude
from armland.rotations import conjugate, from_rotation_vector, matrix, multiply


@pytest.mark.parametrize("turn", [[0.1, -0.2, 0.3], [3.0, 0.2, 0.0], [0.0, 3.1, 0.1], [0.0, 0.1, 3.1]])
def test_quaternion_of_a_rotation(turn):
    R = matrix(from_rotation_vector(np.array(turn)))
    np.testing.assert_allclose(matrix(quaternion_of(R)), R, atol=1e-12)


def see(bench, plate, arm, uav):
    """Let the camera see a UAV (attitude `uav`) whose pivot is `plate` from the end effector, deck axes."""
    p, m = bench.told["estimate"], bench.m
    R_e, R_b = matrix(arm), matrix(uav)
    marker = plate - R_b @ p["lever"][0] + R_b @ p["filter"]["marker_offset"][0]
    m["camera_fresh"], m["camera_capture"] = 1, 77
    m["camera_position"] = R_e.T @ marker - p["camera"][0]
    m["camera_quat"] = multiply(conjugate(arm), multiply(uav, p["filter"]["marker_quat"][0].copy()))


@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.0), (0.012, 0.0, 0.0), (0.004, -0.006, 0.003)])
def test_offset_on_the_magnet_depends_on_nothing_but_the_plates_place(bench, offset):
    rng, s = np.random.default_rng(3), bench.kept["estimate"]
    for _ in range(5):
        arm, uav = from_rotation_vector(rng.normal(0, 0.5, 3)), from_rotation_vector(rng.normal(0, 0.3, 3))
        see(bench, np.array(offset), arm, uav)
        look_at_grip(bench.m[0], bench.told["estimate"][0], s[0])
        assert s["grip_offset"][0] == pytest.approx(np.linalg.norm(offset), abs=1e-12)
        assert s["grip_tick"][0] == 77
    assert s["grip_far"][0] == (5 if np.linalg.norm(offset) > bench.plan.scenario.limits.slip_m else 0)


def test_tick_without_an_image_says_nothing_of_the_grip(bench):
    s = bench.kept["estimate"]
    s["grip_offset"], s["grip_tick"] = 0.002, 5
    look_at_grip(bench.m[0], bench.told["estimate"][0], s[0])
    assert (s["grip_offset"][0], s["grip_tick"][0]) == (0.002, 5)


def test_on_the_hinge_plate_and_arm_are_one_and_the_attitude_is_as_received(bench):
    bench.e["r"], bench.e["v"], bench.m["uav_rate"] = [0.6, 0.0, 0.8], 0.1, 0.2
    bench.m["uav_quat"][0] = from_rotation_vector(np.array([0.1, 0.0, 0.0]))
    take_attitude(bench.m[0], bench.e[0])
    np.testing.assert_array_equal(bench.e["plate"], bench.e["r"])
    np.testing.assert_array_equal(bench.e["plate_v"], bench.e["v"])
    np.testing.assert_array_equal(bench.e["quat"], bench.m["uav_quat"])
    np.testing.assert_array_equal(bench.e["omega"], bench.m["uav_rate"])
    assert bench.e["plate_valid"][0] == 1


def push(bench, mode, held):
    return known_push(mode, held, bench.kept["refer"][0], bench.told["estimate"][0])


def test_uav_that_the_arm_accelerates_is_known_to_be_pushed_less_its_drag(bench):
    p, s = bench.told["estimate"], bench.kept["refer"]
    s["a"], s["v"], p["launch"] = [1.0, 2.0, 3.0], [0.4, 0.0, 0.2], [0.5, 0.0, 0.1]
    rate = p["drag"][0] / p["mass"][0]
    np.testing.assert_allclose(push(bench, LAUNCH, True), [1.0 - rate * 0.4, 2.0, 3.0])
    # Let go it is braked by the air at the speed that it was given, and no longer by the arm.
    np.testing.assert_allclose(push(bench, LEAVE, False), [-rate * 0.5, 0.0, 0.0])
    # Anywhere else nothing is known.
    np.testing.assert_array_equal(push(bench, HOLD, True), 0.0)


@pytest.mark.parametrize(
    ("phase", "flies"), [("guide", True), ("self_test", True), ("carry", False), ("unload", False)]
)
def test_rotors_lift_a_uav_that_flies_and_all_together_one_that_is_carried(bench, phase, flies):
    weight = bench.told["estimate"]["weight"][0]
    # The command that carries the weight is 4 N here: thrust is less than it claims.
    bench.kept["act"]["hover"], bench.e["thrust"] = 4.0, 2.0
    lift = lift_of(bench.enter(phase), bench.kept["act"][0], bench.told["estimate"][0], bench.e[0])
    assert lift == pytest.approx(0.5 * weight if flies else weight)
