"""What camera and link say of the UAV: attitude, plate on the magnet, and what else is known to move it."""

import numpy as np
import pytest

from armland.mission.reference.moves import HOLD, LAUNCH, LEAVE
from armland.mission.sight import estimate_plate, known_push, lift_of, look_at_grip, quaternion_of, take_attitude
from armland.mission.table.phases import MAGNET, UAV
from armland.rotations import conjugate, from_rotation_vector, matrix, multiply

LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


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
    known = bench.kept["estimate"]["filter"]
    known["align"]["quat"], known["quat"][0, 77], known["camera_quat"][0, 77] = [1.0, 0.0, 0.0, 0.0], uav, arm


@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.0), (0.012, 0.0, 0.0), (0.004, -0.006, 0.003)])
def test_offset_on_the_magnet_depends_on_nothing_but_the_plates_place(bench, offset):
    rng, s = np.random.default_rng(3), bench.kept["estimate"]
    for _ in range(5):
        arm, uav = from_rotation_vector(rng.normal(0, 0.5, 3)), from_rotation_vector(rng.normal(0, 0.3, 3))
        see(bench, np.array(offset), arm, uav)
        # It has been there for long: images are smoothed.
        s["grip"][0] = matrix(arm).T @ np.array(offset)
        look_at_grip(bench.m[0], bench.told["estimate"][0], s[0])
        assert s["grip_offset"][0] == pytest.approx(np.linalg.norm(offset), abs=1e-12)
        assert s["grip_tick"][0] == 77
    assert s["grip_far"][0] == (5 if np.linalg.norm(offset) > bench.plan.scenario.limits.slip_m else 0)


def test_tilt_that_the_camera_makes_of_the_marker_moves_no_plate_on_the_magnet(bench):
    """It is by the fused attitude: the marker's own tilt is what a camera sees worst."""
    s = bench.kept["estimate"]
    see(bench, np.array([0.004, 0.0, 0.0]), LEVEL, LEVEL)
    s["grip"][0] = [0.004, 0.0, 0.0]
    for tilt in (0.0, 0.3):
        bench.m["camera_quat"] = multiply(
            bench.m["camera_quat"][0].copy(), from_rotation_vector(np.array([tilt, 0.0, 0.0]))
        )
        look_at_grip(bench.m[0], bench.told["estimate"][0], s[0])
        assert s["grip_offset"][0] == pytest.approx(0.004, abs=1e-12)
    # The alignment between the UAV's idea of the world and the deck counts.
    lever = bench.told["estimate"]["lever"][0] - bench.told["estimate"]["filter"]["marker_offset"][0]
    s["filter"]["align"]["quat"] = from_rotation_vector(np.array([0.0, 0.1, 0.0]))
    moved = np.array([0.004, 0.0, 0.0]) + matrix(from_rotation_vector(np.array([0.0, 0.1, 0.0]))) @ lever - lever
    s["grip"][0] = moved
    look_at_grip(bench.m[0], bench.told["estimate"][0], s[0])
    assert s["grip_offset"][0] == pytest.approx(np.linalg.norm(moved), abs=1e-12)


@pytest.mark.parametrize(("noise", "sigmas", "far"), [(1.0, 2.9, 0), (1.0, 3.1, 1), (9.0, 8.9, 0), (9.0, 9.1, 1)])
def test_plate_is_far_off_only_beyond_what_the_cameras_noise_explains(bench, noise, sigmas, far):
    """Three standard deviations of what the noise really is, learnt in flight, beyond the slip."""
    s, sigma = bench.kept["estimate"], 5e-4
    bench.m["camera_sigma"][0, :3], s["filter"]["noise"] = sigma, noise
    offset = bench.plan.scenario.limits.slip_m + sigmas * np.sqrt(3.0) * sigma
    see(bench, np.array([offset, 0.0, 0.0]), LEVEL, LEVEL)
    s["grip"][0] = [offset, 0.0, 0.0]
    look_at_grip(bench.m[0], bench.told["estimate"][0], s[0])
    assert s["grip_far"][0] == far


@pytest.mark.parametrize(
    ("offsets", "slides"),
    [
        ([15.0, 30.0], 2),
        ([15.0, 30.0, 50.0], 3),
        ([30.0, 15.0], 1),  # one that comes back
        ([15.0, -30.0], 1),  # scatter has no direction
        ([15.0, 30.0, 2.0], 0),
        ([2.0, 4.0, 8.0], 0),  # not yet off
    ],
)
def test_images_that_show_a_plate_ever_further_the_same_way_are_counted(bench, offsets, slides):
    """Each by itself: what is smoothed lags by more than a plate that is shoved off stays in view."""
    s = bench.kept["estimate"]
    bench.m["camera_sigma"][0, :3], s["filter"]["noise"] = 5e-4, 1.0
    for offset in offsets:
        see(bench, np.array([1e-3 * offset, 0.0, 0.0]), LEVEL, LEVEL)
        look_at_grip(bench.m[0], bench.told["estimate"][0], s[0])
    assert s["grip_slides"][0] == slides


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


@pytest.mark.parametrize(
    ("uav", "magnet", "flies"),
    [
        ("autonomous", "on", True),
        ("station", "off", True),
        ("cruise", "on", True),
        ("level", "off", True),
        ("level", "on", False),
        ("ramp", "off", False),
        ("off", "off", False),
        ("balance", "on", False),
    ],
)
def test_who_flies_is_lifted_by_its_own_thrust_and_who_is_carried_by_as_much_as_it_weighs(bench, uav, magnet, flies):
    row, weight = bench.enter("guide"), bench.told["estimate"]["weight"][0]
    row["uav"], row["magnet"] = UAV.index(uav), MAGNET.index(magnet)
    bench.kept["act"]["hover"], bench.e["thrust"] = 4.0, 1.0
    lift = lift_of(row, bench.kept["act"][0], bench.told["estimate"][0], bench.e[0])
    assert lift == pytest.approx(0.25 * weight if flies else weight)


def test_thrust_whose_weight_is_not_known_yet_lifts_by_a_finite_force(bench):
    bench.kept["act"]["hover"], bench.e["thrust"] = 0.0, 0.0
    assert lift_of(bench.enter("guide"), bench.kept["act"][0], bench.told["estimate"][0], bench.e[0]) == 0.0


class Flight:
    """A UAV above the arm, seen by the camera every 33 ms without error; the arm leans, and so do UAV and camera."""

    def __init__(self, bench, velocity=(0.0, 0.0, 0.0)):
        self.bench, self.velocity = bench, np.array(velocity)
        self.arm, self.uav = (
            from_rotation_vector(np.array([0.1, -0.05, 0.3])),
            from_rotation_vector(np.array([0.0, 0.0, 0.4])),
        )
        state = bench.board["arm"]
        state["rotation"], state["position"] = matrix(self.arm), [0.6, 0.1, 0.5]
        self.at, self.tick = np.array([0.65, 0.05, 0.9]), 1000

    def fly(self, ticks, push=(0.0, 0.0, 0.0), seen=True, acceleration=(0.0, 0.0, 0.0)):
        bench, push = self.bench, np.array(push, float)
        weight = bench.told["estimate"]["weight"][0]
        for _ in range(ticks):
            bench.m["tick"] = bench.m["uav_tick"] = self.tick
            bench.m["uav_quat"][0], bench.m["camera_fresh"] = self.uav, 0
            if seen and self.tick % 33 == 0:
                see(bench, self.at - bench.board["arm"]["position"][0], self.arm, self.uav)
                # A camera is never free of noise: its digits tell a frozen image.
                bench.m["camera_position"][0, 2] += 1e-9 * (self.tick % 7)
                bench.m["camera_capture"], bench.m["camera_sigma"] = self.tick, 1e-3
            estimate_plate(weight, push, bench.b)
            self.velocity = self.velocity + 1e-3 * np.array(acceleration)
            self.at, self.tick = self.at + 1e-3 * self.velocity, self.tick + 1


def test_plate_is_where_the_camera_of_a_leaning_arm_sees_it(bench):
    """In deck axes, with the attitude of the UAV; nobody vouches for it before it is seen, nor long after."""
    flight = Flight(bench)
    flight.fly(10, seen=False)
    assert bench.e["plate_valid"][0] == 0
    flight.fly(300)
    np.testing.assert_allclose(bench.e["plate"][0], [0.65, 0.05, 0.9], atol=1e-4)
    np.testing.assert_allclose(bench.e["plate_v"][0], 0.0, atol=2e-3)
    np.testing.assert_allclose(bench.e["quat"][0], flight.uav, atol=1e-5)
    assert bench.e["plate_valid"][0] == 1
    assert bench.e["plate_age"][0] < 0.034
    flight.fly(600, seen=False)
    assert bench.e["plate_valid"][0] == 0
    assert bench.e["plate_age"][0] > 0.5


def test_push_that_is_known_moves_the_plate_at_once(bench):
    """Half a second of 0.5 m/s² that no image could tell of in time; without being told, the plate stays behind."""
    errors = {}
    for told in (True, False):
        flight = Flight(type(bench)(bench.plan))
        flight.fly(300)
        still = flight.at.copy()
        flight.fly(100, push=[0.5, 0.0, 0.0] if told else [0.0] * 3, seen=False, acceleration=[0.5, 0.0, 0.0])
        estimate = flight.bench.e
        errors[told] = np.linalg.norm(estimate["plate"][0] - flight.at)
        assert flight.at[0] - still[0] == pytest.approx(0.5 * 0.5 * 0.1**2, rel=0.02)
        assert estimate["plate_a"][0, 0] == pytest.approx(0.5 if told else 0.0, abs=0.02)
        assert estimate["plate_v"][0, 0] == pytest.approx(0.05 if told else 0.0, abs=3e-3)
    assert errors[True] < 3e-4 < 1.5e-3 < errors[False]


def test_plate_that_moves_is_known_with_its_speed_and_turns_with_the_gyros(bench):
    flight = Flight(bench, velocity=(0.05, -0.08, 0.02))
    bench.m["uav_rate"] = 0.0
    flight.fly(1000)
    np.testing.assert_allclose(bench.e["plate"][0], flight.at - 1e-3 * flight.velocity, atol=1e-3)
    np.testing.assert_allclose(bench.e["plate_v"][0], flight.velocity, atol=6e-3)
    np.testing.assert_array_equal(bench.e["omega"], 0.0)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_drag_brakes_along_the_deck_and_not_upwards(bench, axis):
    p, s, speed = bench.told["estimate"], bench.kept["refer"], np.eye(3)[axis]
    s["a"], s["v"], p["launch"] = 0.0, 0.4 * speed, 0.5 * speed
    rate = p["drag"][0] / p["mass"][0] if axis < 2 else 0.0
    np.testing.assert_allclose(push(bench, LAUNCH, True), -rate * 0.4 * speed)
    np.testing.assert_allclose(push(bench, LAUNCH, False), -rate * 0.5 * speed)


def test_images_that_show_the_plate_in_its_place_end_the_row_of_those_that_do_not(bench):
    """Images are smoothed: a single one that is far off starts no row, a plate that stays far off does."""
    s, found = bench.kept["estimate"], []
    for away in (0.02, 0.0, 0.0, 0.02, 0.02, 0.02, 0.02, 0.0, 0.0):
        see(bench, np.array([away, 0.0, 0.0]), LEVEL, LEVEL)
        look_at_grip(bench.m[0], bench.told["estimate"][0], s[0])
        found.append(int(s["grip_far"][0]))
    # 0.4 of the first, then towards 20 mm: 8, 5, 3, 10, 14, 16, 18, 11, 6 mm.
    assert found == [0, 0, 0, 0, 1, 2, 3, 4, 0]


@pytest.mark.parametrize(("phase", "stays"), [("carry", True), ("unload", True), ("guide", False)])
def test_uav_that_arm_or_cradle_carry_goes_along_with_the_deck(bench, phase, stays):
    """A hull that surges with 0.6 m/s²: for 0.2 s without an image a UAV that flies is left behind, a carried one not."""
    flight = Flight(bench)
    flight.fly(300)
    before = bench.e["plate"][0].copy()
    bench.board["environment"]["moves"], bench.board["environment"]["base_a"] = 1, [0.6, 0.0, 0.0]
    bench.enter(phase)
    flight.fly(200, seen=False)
    left = bench.e["plate"][0] - before
    np.testing.assert_allclose(left, [0.0 if stays else -0.5 * 0.6 * 0.2**2, 0.0, 0.0], atol=1e-3)
