"""Figures of merit against hand-worked motions."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.experiments.judge.tracking import deviation, measure, overshoot
from armland.mission.reference.path import Leg
from armland.records import tick_layout

RATE = 1000


def legs() -> list[Leg]:
    return [
        Leg(0.1, 0.2, 0.4, np.zeros(3), np.array([0.2, 0.0, -0.1])),
        Leg(0.4, 0.5, 0.7, np.array([0.2, 0.0, -0.1]), np.array([0.0, 0.0, 0.0])),
    ]


def test_overshoot_counts_only_beyond_the_end_point_in_the_move_s_direction() -> None:
    r = np.zeros((700, 3))
    r[200:400] = [0.2, 0.0, -0.1]
    r[250, 0] = 0.207  # beyond the first end point
    r[260, 0] = 0.190  # short of it: no overshoot
    r[270, 1] = 0.050  # an axis that does not move
    r[550, 2] = 0.004  # beyond the second end point, upwards
    np.testing.assert_allclose(overshoot(r, legs(), RATE), [0.007, 0.0, 0.004], atol=1e-12)


def test_no_overshoot_when_the_end_point_is_never_reached() -> None:
    assert overshoot([*np.zeros((700, 3)), 0.1, 0.0, -0.05], legs()[:1], RATE).max() == 0.0


def test_deviation_against_scipy_over_the_sphere() -> None:
    rng = np.random.default_rng(3)
    a, b = Rotation.random(200, rng), Rotation.random(200, rng)
    q, q_d = a.as_quat(scalar_first=True), b.as_quat(scalar_first=True)
    q[::2] *= -1.0
    np.testing.assert_allclose(deviation(q, q_d), (b.inv() * a).magnitude(), atol=1e-7)


@pytest.mark.parametrize("angle", [1e-7, 1e-5, 1e-3, 0.1, 2.0])
def test_deviation_keeps_its_digits_at_small_angles(angle: float) -> None:
    q = Rotation.from_rotvec([[angle, 0.0, 0.0]]).as_quat(scalar_first=True)
    assert deviation(q, np.array([[1.0, 0.0, 0.0, 0.0]]))[0] == pytest.approx(angle, rel=1e-6)


def test_measure_uses_truth_and_skips_the_settling() -> None:
    ticks = np.zeros(700, tick_layout(7))
    ticks["truth"]["quat"][:, 0] = ticks["reference"]["quat"][:, 0] = 1.0
    ticks["truth"]["r"][50] = 1.0  # before the first leg: not judged
    ticks["truth"]["r"][300] = [0.003, -0.004, 0.0]
    ticks["estimate"]["r"] = 9.0  # the judge does not look at estimates
    ticks["truth"]["hinge_force"][600] = [3.0, 0.0, 4.0]
    ticks["command"]["delta_tau"][600] = [0.0, -0.2, 0.1]
    m = measure(ticks, legs(), RATE)
    assert m.position_max_m == pytest.approx([0.003, 0.004, 0.0])
    assert m.position_rms_m[0] == pytest.approx(0.003 / np.sqrt(600))
    assert m.hinge_force_max_n == pytest.approx(5.0)
    assert m.delta_tau_max_nm == pytest.approx(0.2)
    assert m.attitude_max_deg == 0.0
