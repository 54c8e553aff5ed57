"""What a seed draws: within its bounds, the same for the same seed, and nothing for a UAV on the hinge."""

import numpy as np

from armland.plant.draw import draw
from armland.rotations import angle
from armland.scenario import load_scenario


def test_each_seed_draws_its_own_start_and_imperfections_within_the_bounds():
    draws = [draw(load_scenario("landing").with_seed(seed), "air") for seed in range(40)]
    position = np.array([d.position for d in draws]) - [0.62, 0.0, 1.06]
    assert (np.abs(position) <= [0.10, 0.10, 0.15]).all()
    assert len(np.unique(position)) == position.size
    bias = np.array([d.wrench_bias for d in draws])
    assert (np.abs(bias) <= [1.0, 1.0, 1.0, 0.05, 0.05, 0.05]).all()
    assert (np.abs(bias).max(axis=0) > [0.8, 0.8, 0.8, 0.04, 0.04, 0.04]).all()
    turned = np.rad2deg([angle(d.imu_bias) for d in draws])
    assert 8.0 < turned.max() < 10.1
    factor = np.array([d.thrust_factor for d in draws])
    assert (np.abs(factor - 1.0) <= 0.05).all()
    assert np.ptp(factor) > 0.07


def test_draw_is_a_function_of_the_seed_alone():
    plain, faulty = (
        draw(load_scenario("landing", {"faults": f}).with_seed(7), "air")
        for f in ([], [{"kind": "twist", "size": 1.0}])
    )
    for one, two in zip(plain, faulty, strict=True):
        np.testing.assert_array_equal(one, two)


def test_uav_on_the_hinge_is_calibrated():
    d = draw(load_scenario("landing").with_seed(3), "hinged")
    assert not d.wrench_bias.any()
    assert not d.velocity.any()
    np.testing.assert_array_equal(d.imu_bias, [1.0, 0.0, 0.0, 0.0])
    assert d.thrust_factor == 1.0
