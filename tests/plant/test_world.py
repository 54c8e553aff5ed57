"""The plant's record: one layout for all missions, and every number of the scenario in its place."""

import numpy as np

from armland.plant.world import KEPT, TOLD, absent, world_layout


def test_layout_is_one_object_and_the_same_for_all_missions(bench, bench_in_air):
    assert world_layout(7) is world_layout(7)
    assert bench().world.dtype == bench_in_air().world.dtype == world_layout(7)


def test_every_device_has_its_place():
    layout = world_layout(6)
    assert layout["told"].names == tuple(TOLD)
    assert layout["kept"].names == tuple(KEPT)
    assert layout["told"]["encoders"]["offset"].shape == (6,)
    assert set(KEPT) <= set(TOLD)


def test_noise_may_be_switched_off_in_the_air(bench_in_air):
    for noisy in (True, False):
        told = bench_in_air(imperfections={"noise": noisy}).told
        for device, sigma in (("encoders", "sigma_q"), ("wrench", "sigma"), ("imu", "sigma_rate")):
            assert told[device][sigma].any() == noisy


def test_gravity_stands_in_the_environment(bench_in_air):
    b = bench_in_air(environment={"gravity_mps2": [0.0, 0.0, -9.7]})
    np.testing.assert_array_equal(b.world["environment"]["gravity"][0], [0.0, 0.0, -9.7])
    assert not b.world["environment"]["base_v"].any()


def test_streams_of_absent_devices_are_named(bench, bench_in_air):
    """On the hinge there is no camera; on land the deck has no motion reference."""
    assert absent(bench().world) == {"camera", "flip", "reference"}
    assert absent(bench_in_air().world) == {"reference"}
    assert absent(bench_in_air(sea={"state": "ss2"}).world) == set()
