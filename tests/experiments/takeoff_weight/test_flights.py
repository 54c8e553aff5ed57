"""Flights at the limit of the weight, and the bisection about it."""

from armland.experiments.takeoff_weight.flights import bisected, flies_off, loaded

STATIC, EMPTY = 4.0 * 1.86, 0.5277 * 9.81


def test_a_uav_too_heavy_at_rest_flies_with_the_arms_speed_and_sinks_without(landing_scenario):
    weight = 1.0008 * STATIC
    assert flies_off(loaded(landing_scenario, (0.0, -0.6, 0.0), weight, EMPTY))
    assert not flies_off(loaded(landing_scenario, (0.0, 0.0, 0.0), weight, EMPTY))


def test_bisection_finds_the_limit_and_says_whether_it_saw_both_sides():
    tried = []
    found, half, inside = bisected(lambda share: share < 1.0021, 1.0, lambda: tried.append(1))
    assert abs(found - 1.0021) <= half < 3e-4
    assert inside
    assert len(tried) == 5
    assert bisected(lambda _: True, 1.0, lambda: None)[2] is False
