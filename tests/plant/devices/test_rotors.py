"""Rotors one by one: lag, gain, disturbance, drag, and what motion through the air does to them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.models.inflow import advance_of, disc_of, factor_at_speed
from armland.rotations import from_rotation_vector, matrix

POSITION = np.array([[0.127, 0.127], [-0.127, 0.127], [-0.127, -0.127], [0.127, -0.127]])
SPIN = np.array([1.0, -1.0, 1.0, -1.0])


def test_thrusts_are_recorded_with_the_torque_they_make(bench):
    b, thrust = bench(), np.array([0.4, 0.5, 0.7, 0.6])
    b.kept["rotors"]["lift"][0, :4] = thrust
    b.read(0)
    torque = [POSITION[:, 1] @ thrust, -POSITION[:, 0] @ thrust, 0.02 * SPIN @ thrust]
    np.testing.assert_array_equal(b.t["rotor_thrust"][0], [*thrust, 0.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(b.t["tau_uav"][0], torque, atol=1e-15)


def test_rotors_reach_a_share_of_their_set_point_each_tick(bench):
    b = bench(rotors={"time_constant_s": 0.05})
    rest = b.sim.scenario.control.thrust_n
    lift = np.array([b.act(k, thrust=3.0)[2] for k in range(200)])
    np.testing.assert_allclose(lift, 3.0 - (3.0 - rest) * np.exp(-1e-3 * np.arange(1, 201) / 0.05), atol=1e-9)


def test_weak_rotor_tilts_the_uav(bench):
    b = bench()
    b.told["rotors"]["gain"][0, :4] = [1.0, 0.9, 1.0, 1.0]
    quarter = 0.25 * b.sim.scenario.control.thrust_n
    wrench, missing = b.act(0), 0.1 * quarter
    expected = [0.0, 0.0, 4.0 * quarter - missing, -missing * 0.127, -missing * 0.127, missing * 0.02]
    np.testing.assert_allclose(wrench, expected, atol=1e-12)


def test_disturbance_is_a_force_of_the_world_and_a_torque_of_the_body(bench):
    b = bench(disturbance={"force_n": [0.1, 0.2, 0.3], "torque_nm": [0.01, 0.02, 0.03]})
    turn = Rotation.from_rotvec([0.0, 0.0, np.pi / 2])
    b.t["quat"] = turn.as_quat(scalar_first=True)
    b.kept["imu"]["quat"] = [1.0, 0.0, 0.0, 0.0]
    wrench = b.act(0)
    np.testing.assert_allclose(wrench[:3] - [0.0, 0.0, b.sim.scenario.control.thrust_n], [0.1, 0.2, 0.3], atol=1e-12)
    np.testing.assert_allclose(wrench[3:], turn.apply([0.01, 0.02, 0.03]), atol=1e-12)


def moving(b, velocity, turn=(0.0, 0.0, 0.0), rate=(0.0, 0.0, 0.0), air=(0.0, 0.0, 0.0)):
    """Wrench (6,) on the UAV, world, between two samples on board, so that all ask the same of their rotors."""
    b.t["v_cm"], b.t["omega"], b.t["quat"] = velocity, rate, from_rotation_vector(np.array(turn))
    b.told["air"]["moves"], b.told["air"]["mean"] = 1, air
    return b.act(1)


@pytest.fixture
def flying(bench_in_air):
    return lambda **rotors: bench_in_air(
        onboard={"rate_hz": 200},
        uav={"drag_nspm": rotors.pop("drag", 0.22)},
        rotors={"time_constant_s": 0.05, **rotors},
    )


@pytest.mark.parametrize("velocity", [(0.0, 0.0, 0.0), (0.5, -0.3, 0.0), (0.0, 0.0, 0.4), (2.0, 0.0, -0.5)])
@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (0.2, -0.1, 0.4)])
def test_thrust_is_momentum_theorys_and_drag_is_linear(flying, velocity, turn):
    b = flying()
    wrench, R = moving(b, velocity, turn), matrix(from_rotation_vector(np.array(turn)))
    static, body = b.kept["rotors"]["static"][0], R.T @ np.array(velocity)
    flow = np.hypot(body[0], body[1]), body[2], disc_of(0.1, 1.225), 0.7, advance_of(0.7, 0.115)
    thrust = sum(s * factor_at_speed(s, *flow) for s in static[:4])
    np.testing.assert_allclose(
        wrench[:3], thrust * R[:, 2] - 0.22 * np.array([*velocity[:2], 0.0]), rtol=1e-9, atol=1e-12
    )


def test_only_motion_through_the_air_counts(flying):
    still, with_the_wind = moving(flying(), (0.0, 0.0, 0.0)), moving(flying(), (1.0, 0.5, 0.2), air=(1.0, 0.5, 0.2))
    np.testing.assert_allclose(with_the_wind, still, atol=1e-12)


def test_climb_costs_thrust_and_forward_speed_gains_it(flying):
    still, climb, forward = (moving(flying(drag=0.0), v)[2] for v in ((0, 0, 0), (0, 0, 0.5), (1.0, 0, 0)))
    assert climb < still < forward


def test_a_roll_is_damped_by_its_own_rotors(flying):
    still, rolling = moving(flying(), (0, 0, 0))[3], moving(flying(), (0, 0, 0), rate=(3.0, 0.0, 0.0))[3]
    assert rolling < still - 5e-3


def test_switched_off_nothing_is_felt(flying):
    still, moves = (moving(flying(inflow=False, drag=0.0), v) for v in ((0, 0, 0), (1.0, 0.0, 0.5)))
    np.testing.assert_array_equal(still, moves)


@pytest.mark.parametrize("along", [0.0, 4.8])
@pytest.mark.parametrize("up", [-2.4, -0.8, 0.8, 2.4])
def test_air_that_rises_or_falls_acts_by_the_inflow_and_hardly_by_the_body(flying, along, up):
    """Why the drag is horizontal: the published drag of such a body along z, 0.01 N/(m/s)² (Hummingbird), is below a ninth of it."""
    felt, level = (moving(flying(drag=0.0), (0, 0, 0), air=(along, 0.0, w))[2] for w in (up, 0.0))
    assert (felt - level) * up > 0.0
    assert 0.01 * up**2 < abs(felt - level) / 9.0


def test_gust_acts_as_the_air_that_moves_and_not_on_one_that_drifts_along(flying):
    wind = np.array([3.0, -2.0, 0.0])
    gust, air, calm, along = flying(), flying(), flying(), flying()
    gust.kept["faults"]["wind"] = along.kept["faults"]["wind"] = wind
    felt, same, still = moving(gust, (0, 0, 0)), moving(air, (0, 0, 0), air=wind), moving(calm, (0, 0, 0))
    np.testing.assert_array_equal(felt, same)
    np.testing.assert_allclose(felt[:2] - still[:2], 0.22 * wind[:2], atol=1e-12)
    np.testing.assert_allclose(moving(along, wind), still, atol=1e-12)


PLACE = [[0.2, 0.0, 0.0], [0.1, 0.17, 0.0], [-0.1, 0.17, 0.0], [-0.2, 0.0, 0.0], [-0.1, -0.17, 0.0], [0.1, -0.17, 0.0]]
AXIS = [[0.0, 0.3, 0.9], [0.2, -0.1, 0.9], [0.0, 0.2, 0.9], [0.1, -0.3, 0.9], [-0.2, 0.1, 0.9], [0.0, -0.2, 0.9]]


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (0.2, -0.1, 0.4)])
def test_tilted_rotors_push_along_their_own_axes(flying, turn):
    b = flying(inflow=False, drag=0.0, place_m=PLACE, axis=AXIS, spin=[1, -1, 1, -1, 1, -1])
    b.kept["rotors"]["asked"][0, :6] = b.kept["rotors"]["static"][0, :6] = np.linspace(0.6, 1.1, 6)
    wrench, R = moving(b, (0.0, 0.0, 0.0), turn), matrix(from_rotation_vector(np.array(turn)))
    axis = np.array([np.array(a) / np.linalg.norm(a) for a in AXIS])
    forces = b.kept["rotors"]["lift"][0, :6, None] * axis
    spin = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    torque = np.cross(PLACE, forces).sum(axis=0) - 0.02 * spin @ forces
    np.testing.assert_allclose(wrench, [*(R @ forces.sum(axis=0)), *(R @ torque)], rtol=1e-9, atol=1e-12)
    assert np.abs(forces.sum(axis=0)[:2]).max() > 0.05


def test_a_tilted_rotor_feels_the_air_along_its_own_axis(flying):
    b, velocity = flying(drag=0.0, place_m=PLACE, axis=AXIS), np.array([0.3, -0.4, 0.6])
    moving(b, velocity)
    static, lift = b.kept["rotors"]["static"][0], b.kept["rotors"]["lift"][0]
    for k, a in enumerate(np.array(AXIS) / np.linalg.norm(AXIS, axis=1)[:, None]):
        axial = velocity @ a
        in_plane = np.linalg.norm(velocity - axial * a)
        expected = static[k] * factor_at_speed(
            static[k], in_plane, axial, disc_of(0.1, 1.225), 0.7, advance_of(0.7, 0.115)
        )
        assert lift[k] == pytest.approx(expected, rel=1e-9)
