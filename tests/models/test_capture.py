"""Closed forms of a capture against integrations and hand-worked numbers."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from armland.models.capture import (
    GATE_M,
    Grip,
    closing_speed_bound,
    closing_time,
    covered_offset,
    covered_tilt,
    hinge_impact,
    lateral_speed_bound,
    righting,
    slide,
    snap_speed,
)

GRIP = Grip()


@pytest.mark.parametrize("angle", np.linspace(0.0, 2.0 * np.pi, 13))
def test_covered_offset_is_where_the_first_pad_is_bared(angle):
    pads = GRIP.pad_radius * np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
    way = np.array([np.cos(angle), np.sin(angle)])

    def bare(d):
        return (np.linalg.norm(pads - d * way, axis=1) > GRIP.plate_radius).any()

    d = covered_offset(GRIP, float(angle))
    assert not bare(0.9999 * d)
    assert bare(1.0001 * d)


def test_covered_offset_by_hand():
    assert covered_offset(GRIP) == pytest.approx(0.007)
    assert covered_offset(GRIP._replace(plate_radius=0.030)) == pytest.approx(0.015)


def test_snap_speed_is_the_work_of_the_pull():
    work, _ = quad(lambda g: GRIP.rated_force / (1.0 + g / GRIP.gap_scale) ** 2, 0.0005, GATE_M)
    assert 0.25 * snap_speed(GRIP, 0.5, 0.0, GATE_M, 0.0005) ** 2 == pytest.approx(work)
    assert snap_speed(GRIP, 0.5, 0.3, GATE_M, GATE_M) == pytest.approx(0.3)


def test_closing_time_without_a_magnet_is_way_over_speed():
    weak = GRIP._replace(rated_force=1e-9, brake_s=1e-9)
    assert closing_time(weak, 0.5, 0.1, GATE_M) == pytest.approx(0.03, rel=0.01)
    assert closing_time(GRIP, 0.5, 0.1, GATE_M) < 0.04


def test_impact_is_that_of_the_braked_approach():
    # ẍ = −2ẋ/T − x/T², where it decelerates: integrated, on an arm that does not give way.
    T, v = GRIP.brake_s, 0.3

    def motion(_, y):
        return [y[1], max(-2.0 * y[1] / T - y[0] / T**2, 0.0)]

    path = solve_ivp(motion, (0.0, 0.05), [0.0019, -v], max_step=1e-5, rtol=1e-9, atol=1e-12)
    a = max(motion(0.0, y)[1] for y in path.y.T)
    weak = GRIP._replace(rated_force=1e-9)
    assert hinge_impact(weak, 0.5, 0.4, 1e9, v, GATE_M) == pytest.approx(0.4 * a, rel=1e-3)


def test_impact_beyond_the_reach_of_the_brake_is_higher():
    long = GRIP._replace(reach=0.02)
    assert hinge_impact(GRIP, 0.5, 0.5, 8.0, 0.8, GATE_M) > 1.5 * hinge_impact(long, 0.5, 0.5, 8.0, 0.8, GATE_M)


def test_closing_speed_bound_meets_the_force():
    v = closing_speed_bound(GRIP, 0.528, 0.48, 8.2, 106.2, GATE_M)
    assert hinge_impact(GRIP, 0.528, 0.48, 8.2, v, GATE_M) == pytest.approx(106.2, rel=1e-6)
    assert closing_speed_bound(GRIP, 0.528, 0.48, 8.2, 1.0, GATE_M) == 0.0


def test_lateral_speed_bound_uses_up_the_clearance():
    v, t = lateral_speed_bound(GRIP, 0.528, 0.1, GATE_M, 0.002), closing_time(GRIP, 0.528, 0.1, GATE_M)
    assert v * t + slide(GRIP, 0.528, v) == pytest.approx(0.005)
    assert lateral_speed_bound(GRIP, 0.528, 0.1, GATE_M, 0.007) == 0.0


def test_slide_by_hand():
    # 0.5 kg at 0.3 m/s against 35.4 N: 0.0225 J.
    assert slide(GRIP, 0.5, 0.3) == pytest.approx(0.0225 / 35.4)


def test_righting_is_the_integral_of_a_lagging_acceleration():
    def motion(t, y):
        return [y[1], 2.0 * (1.0 - np.exp(-t / 0.05))]

    path = solve_ivp(motion, (0.0, 0.04), [0.0, 0.0], rtol=1e-10, atol=1e-14)
    np.testing.assert_allclose(righting(2.0, 0.05, 0.04), path.y[:, -1], rtol=1e-7)


def test_covered_tilt_solves_its_equation():
    tilt = covered_tilt(GRIP, 0.002)
    assert GRIP.plate_radius * np.cos(tilt) - GRIP.drop * np.sin(tilt) == pytest.approx(GRIP.pad_radius + 0.002)
    assert covered_tilt(GRIP, 0.007) == 0.0
