"""Station keeping in closed loop with a rigid body, lagging rotors and late positions, written apart from the package's models."""

from typing import NamedTuple

import numpy as np
import pytest
from numba import njit
from scipy.spatial.transform import Rotation

from armland.control.laws.attitude import QuaternionPdGains, initial_memory, quaternion_pd
from armland.control.laws.station_keeping import StationGains, StationReference, attitude_of, keep_station

MASS, GRAVITY, H = 0.480, 9.81, 1e-3
INERTIA = np.array([0.006, 0.007, 0.012])
ONBOARD = QuaternionPdGains(np.array([0.40, 0.40, 0.30]), np.array([0.056, 0.056, 0.060]))
GAINS = StationGains()
PERIOD = round(GAINS.period / H)
ARM = 0.127  # m, rotor to axis


class World(NamedTuple):
    latency: int = 50  # ticks
    rotor_time: float = 0.05  # s
    sigma_position: float = 0.0  # m
    sigma_velocity: float = 0.0  # m/s
    sigma_attitude: float = 0.0  # rad
    winds_up: bool = False  # integrate whatever the limits say


@njit
def derivative(x, thrust, torque, wind):
    # x: r 0:3, v 3:6, q 6:10, ω 10:13
    w, a, b, c = x[6], x[7], x[8], x[9]
    p, q, r = x[10], x[11], x[12]
    dx = np.empty(13)
    dx[:3] = x[3:6]
    dx[3] = (2.0 * (a * c + w * b) * thrust + wind[0]) / MASS
    dx[4] = (2.0 * (b * c - w * a) * thrust + wind[1]) / MASS
    dx[5] = ((1.0 - 2.0 * (a * a + b * b)) * thrust + wind[2]) / MASS - GRAVITY
    dx[6] = 0.5 * (-a * p - b * q - c * r)
    dx[7] = 0.5 * (w * p + b * r - c * q)
    dx[8] = 0.5 * (w * q + c * p - a * r)
    dx[9] = 0.5 * (w * r + a * q - b * p)
    dx[10] = (torque[0] - (INERTIA[2] - INERTIA[1]) * q * r) / INERTIA[0]
    dx[11] = (torque[1] - (INERTIA[0] - INERTIA[2]) * r * p) / INERTIA[1]
    dx[12] = (torque[2] - (INERTIA[1] - INERTIA[0]) * p * q) / INERTIA[2]
    return dx


@njit
def flight(x, goal, heading, wind, known, gains, world, noise):
    """Path (ticks, 13), wanted tilt and thrust (ticks, 2); `goal` (ticks, 3), `wind` (ticks, 3) N, `known` (3,) m/s²."""
    ticks = len(goal)
    path, asked = np.empty((ticks, 13)), np.empty((ticks, 2))
    still, integral = np.zeros(3), np.zeros(3)
    thrust, torque, rotor = MASS * GRAVITY, np.zeros(3), np.array([MASS * GRAVITY, 0.0, 0.0, 0.0])
    q_d = np.array([1.0, 0.0, 0.0, 0.0])
    for k in range(ticks):
        path[k] = x
        n = noise[k]
        q = x[6:10].copy()
        q[1:] += 0.5 * world.sigma_attitude * n[6:9]
        if k % PERIOD == 0:
            late = path[max(k - world.latency, 0)]
            r, v = late[:3] + world.sigma_position * n[:3], late[3:6] + world.sigma_velocity * n[3:6]
            reference = StationReference(goal[k], still, still, heading)
            before = integral
            thrust, q_d, integral = keep_station(r, v, q, reference, known, gains, integral)
            if world.winds_up:
                wanted = gains.k_position * (goal[k] - r)
                wanted *= min(1.0, gains.speed_max / np.sqrt(np.sum(wanted**2) + 1e-12))
                integral = before + gains.k_integral * gains.period * (wanted - v)
            torque, _ = quaternion_pd(q, x[10:13].copy(), q_d, still, still, ONBOARD, initial_memory(still))
        asked[k, 0] = np.arccos(1.0 - 2.0 * (q_d[1] ** 2 + q_d[2] ** 2))
        asked[k, 1] = thrust
        gain = H / (world.rotor_time + H)
        rotor[0] += gain * (thrust - rotor[0])
        for i in range(3):
            # What all four rotors can give about hover.
            limit = 0.34 if i < 2 else 0.05
            rotor[1 + i] += gain * (min(max(torque[i], -limit), limit) - rotor[1 + i])
        middle = x + 0.5 * H * derivative(x, rotor[0], rotor[1:], wind[k])
        x = x + H * derivative(middle, rotor[0], rotor[1:], wind[k])
        x[6:10] /= np.sqrt(np.sum(x[6:10] ** 2))
    return path, asked


def fly(
    seconds,
    start=(0.0, 0.0, 0.0),
    goal=(0.0, 0.0, 0.0),
    wind=(0.0, 0.0, 0.0),
    heading=0.0,
    known=(0.0, 0.0, 0.0),
    **changes,
):
    """`goal` and `wind` (3,) or (ticks, 3)."""
    ticks = round(seconds / H)
    world = World(**{k: v for k, v in changes.items() if k in World._fields})
    gains = GAINS._replace(**{k: v for k, v in changes.items() if k in StationGains._fields})
    x = np.zeros(13)
    x[:3], x[6] = start, 1.0
    spread = [np.broadcast_to(np.asarray(a, float), (ticks, 3)).copy() for a in (goal, wind)]
    noise = np.random.default_rng(5).normal(size=(ticks, 9))
    return flight(x, spread[0], heading, spread[1], np.array(known, float), gains, world, noise)


def tilt_of(path):
    return np.arccos(np.clip(Rotation.from_quat(path[:, 6:10], scalar_first=True).as_matrix()[:, 2, 2], -1.0, 1.0))


def sample(force_direction=None, **kinds):
    """One call from rest at the origin."""
    values = {"position": np.zeros(3), "velocity": np.zeros(3), "q": np.array([1.0, 0.0, 0.0, 0.0])} | kinds
    return keep_station(
        values["position"],
        values["velocity"],
        values["q"],
        values.get("reference", StationReference(np.zeros(3), np.zeros(3), np.zeros(3), 0.0)),
        values.get("disturbance", np.zeros(3)),
        values.get("gains", GAINS),
        values.get("integral", np.zeros(3)),
    )


def test_attitude_turns_the_thrust_into_the_force_with_the_heading_asked_for():
    rng = np.random.default_rng(0)
    for _ in range(50):
        force, heading = rng.normal(size=3) + [0.0, 0.0, 1.0], rng.uniform(-3.0, 3.0)
        R = Rotation.from_quat(attitude_of(force, heading), scalar_first=True)
        np.testing.assert_allclose(R.apply([0.0, 0.0, 1.0]), force / np.linalg.norm(force), atol=1e-12)
        # Taking the shortest turn from the vertical back leaves the heading alone.
        axis = np.cross([0.0, 0.0, 1.0], force)
        angle = np.arctan2(np.linalg.norm(axis), force[2])
        back = Rotation.from_rotvec(-angle * axis / np.linalg.norm(axis))
        np.testing.assert_allclose((back * R).as_rotvec(), [0.0, 0.0, heading], atol=1e-9)


def test_at_rest_on_the_reference_the_thrust_is_the_weight():
    thrust, q_d, integral = sample()
    assert thrust == pytest.approx(MASS * GRAVITY)
    np.testing.assert_array_equal(q_d, [1.0, 0.0, 0.0, 0.0])
    np.testing.assert_array_equal(integral, np.zeros(3))


def test_a_tilted_uav_gets_the_thrust_that_keeps_its_height():
    q = Rotation.from_rotvec([0.3, -0.2, 0.5]).as_quat(scalar_first=True)
    thrust, _, _ = sample(q=q)
    lifted = thrust * Rotation.from_quat(q, scalar_first=True).apply([0.0, 0.0, 1.0])
    assert lifted[2] == pytest.approx(MASS * GRAVITY)


def test_limits_hold_for_whatever_comes_in():
    rng = np.random.default_rng(1)
    for scale in (0.1, 1.0, 10.0, 1e3):
        for _ in range(200):
            reference = StationReference(*(scale * rng.normal(size=(3, 3))), rng.uniform(-3, 3))
            q = Rotation.random(rng=rng).as_quat(scalar_first=True)
            thrust, q_d, integral = sample(
                position=scale * rng.normal(size=3),
                velocity=scale * rng.normal(size=3),
                q=q,
                reference=reference,
                integral=scale * rng.normal(size=3),
            )
            down = Rotation.from_quat(q_d, scalar_first=True).as_matrix()[2, 2]
            assert np.arccos(min(down, 1.0)) <= GAINS.tilt_max + 1e-9
            assert GAINS.lift_min <= thrust <= GAINS.thrust_max
            assert np.linalg.norm(integral[:2]) <= GAINS.integral_max + 1e-9
            # The thrust for this direction of the force is within the limit without being cut.
            wanted = thrust * max(1.0 - 2.0 * (q[1] ** 2 + q[2] ** 2), np.cos(GAINS.tilt_max))
            assert wanted / down <= GAINS.thrust_max + 1e-9


def test_whole_tilt_is_left_in_the_hardest_climb():
    reference = StationReference(np.array([100.0, 0.0, 100.0]), np.zeros(3), np.array([50.0, 0.0, 50.0]), 0.0)
    _, q_d, _ = sample(reference=reference)
    assert 2.0 * np.arcsin(np.linalg.norm(q_d[1:3])) == pytest.approx(GAINS.tilt_max)


def test_step_arrives_without_overshoot_worth_mentioning():
    goal = np.array([1.0, -0.5, 0.4])
    path, asked = fly(8.0, goal=goal)
    gone = path[:, :3] / goal
    assert (np.abs(gone[5000:] - 1.0) * np.abs(goal) < 0.05).all()
    assert gone.max() < 1.03
    assert asked[:, 0].max() <= GAINS.tilt_max
    assert np.linalg.norm(path[:, 3:6], axis=1).max() < 1.2 * GAINS.speed_max


def test_heading_is_free():
    one, _ = fly(6.0, goal=(0.3, 0.2, 0.1))
    other, _ = fly(6.0, goal=(0.3, 0.2, 0.1), heading=2.0)
    assert np.abs(other[-1, :3] - one[-1, :3]).max() < 0.02
    turned = Rotation.from_quat(other[-1, 6:10], scalar_first=True).as_euler("zyx")
    np.testing.assert_allclose(turned, [2.0, 0.0, 0.0], atol=0.02)


@pytest.mark.parametrize(
    ("changes", "calm"),
    [
        ({}, True),
        ({"latency": 150}, True),
        ({"latency": 400}, False),
        ({"k_velocity": 6.0}, False),
        ({"rotor_time": 0.15}, False),
    ],
)
def test_margin_against_latency_and_gain(changes, calm):
    path, _ = fly(20.0, goal=(0.2, 0.0, 0.0), **changes)
    swing = np.abs(path[-4000:, 0] - 0.2).max()
    assert swing < 0.005 if calm else swing > 0.05


@pytest.mark.parametrize("integrates", [True, False])
def test_side_wind_of_two_newtons_is_held(integrates):
    wind = np.zeros((24000, 3))
    wind[1000:, 0] = 2.0
    path, asked = fly(24.0, wind=wind, **({} if integrates else {"k_integral": 0.0}))
    assert asked[:, 0].max() <= GAINS.tilt_max
    assert tilt_of(path)[-1] == pytest.approx(np.arctan2(2.0, MASS * GRAVITY), abs=0.01) or not integrates
    assert np.abs(path[:, 2]).max() < 0.05
    if integrates:
        assert np.abs(path[-1, :3]).max() < 0.01
        assert np.abs(path[:, 0]).max() < 1.7
    else:
        # What is left is the spring of the position loop.
        assert path[-1, 0] > 0.9 * 2.0 / MASS / (GAINS.k_velocity * GAINS.k_position)


def test_wind_that_an_observer_knows_moves_the_uav_little():
    wind = (2.0, 0.0, 0.0)
    known, _ = fly(8.0, wind=wind, known=(2.0 / MASS, 0.0, 0.0))
    unknown, _ = fly(8.0, wind=wind)
    assert np.abs(known[:, 0]).max() < 0.35 < 1.2 < np.abs(unknown[:, 0]).max()


def test_anti_windup_spares_the_overshoot():
    """Two seconds of a gust that the tilt limit cannot hold."""
    wind = np.zeros((16000, 3))
    wind[1000:3000, 0] = 4.0
    beyond = {}
    for winds_up in (False, True):
        path, asked = fly(16.0, wind=wind, winds_up=winds_up)
        assert asked[:, 0].max() == pytest.approx(GAINS.tilt_max)
        # The attitude overshoots a jump of its set-point: this much with the demonstrator's onboard gains.
        assert tilt_of(path).max() < 1.25 * GAINS.tilt_max
        beyond[winds_up] = -path[:, 0].min()
    assert beyond[True] > 1.0 > 0.1 > beyond[False]


@pytest.mark.parametrize("sigma_velocity", [0.02, 0.4])
def test_hover_under_noise(sigma_velocity):
    path, _ = fly(30.0, sigma_position=0.002, sigma_velocity=sigma_velocity, sigma_attitude=2e-3)
    spread = np.sqrt(np.mean(path[5000:, :6] ** 2, axis=0))
    good = spread[:3].max() < 0.004 and spread[3:].max() < 0.006
    assert good == (sigma_velocity < 0.1)


LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


def kept_at(
    away=(0.0, 0.0, 0.0), v=(0.0, 0.0, 0.0), q=LEVEL, v_d=(0.0, 0.0, 0.0), a_d=(0.0, 0.0, 0.0), d=(0.0, 0.0, 0.0),
    integral=(0.0, 0.0, 0.0), **gains,
):  # fmt: skip
    """Force (3,), N, that thrust and attitude set-point mean, and the new integral; `away` from the reference, m."""
    here = np.array([0.3, -0.2, 1.0])
    vectors = [np.array(x, float) for x in (v, v_d, a_d, d, integral)]
    reference = StationReference(here, vectors[1], vectors[2], 0.4)
    thrust, q_d, new = keep_station(
        here + away, vectors[0], q, reference, vectors[3], GAINS._replace(**gains), vectors[4]
    )
    axis = Rotation.from_quat(q_d, scalar_first=True).apply([0.0, 0.0, 1.0])
    # On a level UAV the thrust is the force's vertical part.
    return thrust / axis[2] * axis, new


def test_k1_force_is_the_mass_times_what_is_wanted_by_hand():
    """At 0.1 m along x, v_w = v_d − 0.08 m/s; a_w = a_d + 2.2 (v_w − v) + i − d; on land γ is 9.81 m/s² downwards."""
    force, new = kept_at(
        (0.1, 0.0, -0.05),
        (0.02, 0.0, 0.0),
        v_d=(0.05, 0.0, 0.0),
        a_d=(0.2, 0.1, -0.3),
        d=(0.3, -0.1, 0.2),
        integral=(0.1, 0.2, 0.3),
    )
    error = np.array([0.05 - 0.08 - 0.02, 0.0, 0.04])
    wanted = np.array([0.2, 0.1, -0.3]) + 2.2 * error + np.array([0.1, 0.2, 0.3]) - np.array([0.3, -0.1, 0.2])
    np.testing.assert_allclose(force, MASS * (wanted + [0.0, 0.0, GRAVITY]), rtol=1e-12)
    # i grows by k_i times the error of the velocity in a period of 5 ms.
    np.testing.assert_allclose(new, np.array([0.1, 0.2, 0.3]) + 0.005 * error, rtol=1e-12)


@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (-0.6, 0.0, 0.8), (2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0)])
def test_speed_that_is_asked_for_has_its_limit_and_the_way_its_direction(direction):
    """Beyond 1.25 m the speed is no longer in proportion to the way: it stays 1 m/s, straight ahead."""
    for far, speed in ((1.0, 0.8), (1.2, 0.96), (1.3, 1.0), (50.0, 1.0)):
        _, new = kept_at(-far * np.array(direction), k_velocity=0.1)
        np.testing.assert_allclose(new / 0.005, speed * np.array(direction), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    ("force", "tilt", "lift"),
    [
        ((0.0, 0.0, -50.0), 0.0, 1.4),
        ((0.0, 0.0, 50.0), 0.0, 7.0),
        ((30.0, -40.0, 0.0), 0.61, None),
        ((30.0, -40.0, 50.0), 0.61, 7.0 * np.cos(0.61)),
    ],
)
def test_force_is_cut_to_what_lift_and_tilt_allow(force, tilt, lift):
    """Sideways the direction stays: 3 to −4; upwards there is all thrust that the tilt leaves, and always room for the whole tilt."""
    found, _ = kept_at(a_d=force)
    assert np.arctan2(np.hypot(*found[:2]), found[2]) == pytest.approx(tilt, abs=1e-9)
    assert found[2] == pytest.approx(MASS * GRAVITY if lift is None else lift)
    if tilt:
        assert found[1] / found[0] == pytest.approx(-4.0 / 3.0)
        assert found[0] > 0.0


@pytest.mark.parametrize(
    ("push", "error", "grows"), [(30.0, 0.5, False), (30.0, -0.5, True), (-30.0, -0.5, False), (1.0, 0.5, True)]
)
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_integral_stops_where_the_force_is_at_its_limit_and_the_error_drives_it_on(push, error, grows, axis):
    """Upwards as well as downwards and sideways; where the error turns it back it goes on at once."""
    way = np.eye(3)[axis]
    _, new = kept_at(v=-error * way, a_d=push * way, k_velocity=1e-9)
    np.testing.assert_allclose(new, 0.005 * error * way * grows, atol=1e-12)


def test_vertical_limit_does_not_stop_the_horizontal_integral_nor_the_other_way_round():
    _, up = kept_at(v=(-0.1, -0.2, -0.3), a_d=(0.0, 0.0, 50.0), k_velocity=1e-9)
    np.testing.assert_allclose(up, [0.0005, 0.001, 0.0], atol=1e-12)
    _, aside = kept_at(v=(-0.1, -0.2, -0.3), a_d=(50.0, 50.0, 0.0), k_velocity=1e-9)
    np.testing.assert_allclose(aside, [0.0, 0.0, 0.0015], atol=1e-12)


def test_integral_has_its_limits_horizontally_by_its_length_and_vertically_on_both_sides():
    _, new = kept_at(integral=(6.0, -8.0, 9.0))
    np.testing.assert_allclose(new, [3.0, -4.0, 5.0])
    _, new = kept_at(integral=(0.3, -0.4, -9.0))
    np.testing.assert_allclose(new, [0.3, -0.4, -5.0])


@pytest.mark.parametrize(("tilt", "factor"), [(0.3, np.cos(0.3)), (0.9, np.cos(0.61)), (-0.3, np.cos(0.3))])
@pytest.mark.parametrize("axis", ["x", "y"])
def test_tilted_uav_is_given_the_thrust_that_keeps_its_lift_up_to_the_largest_tilt(tilt, factor, axis):
    q = Rotation.from_euler(axis, tilt).as_quat(scalar_first=True)
    force, _ = kept_at(q=q)
    assert force[2] == pytest.approx(min(MASS * GRAVITY / factor, 7.0))
