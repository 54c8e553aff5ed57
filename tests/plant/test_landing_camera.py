import numpy as np

from armland.mission.landing_scenario import landing_scenario
from armland.plant.camera import Camera, camera_parameters, visible
from armland.plant.landing_camera import landing_camera, see_all


def camera(seed, **bad):
    return landing_camera(landing_scenario("landing", {"seed": seed, "imperfections": bad}).landing)


def test_mounting_errors_are_drawn_within_their_bounds_and_for_each_seed_anew():
    drawn = np.array([[*c.shift_m, *c.slope] for c in (camera(seed) for seed in range(60))])
    bounds = np.array([5e-4] * 3 + [np.deg2rad(0.1)] * 2 + [3e-3])
    assert (np.abs(drawn) <= bounds).all()
    assert (np.abs(drawn).max(axis=0) > 0.8 * bounds).all()
    assert camera(7) == camera(7)


def test_exact_camera_is_without_them():
    exact = camera(3, camera=False)
    assert exact.shift_m == exact.slope == (0.0, 0.0, 0.0)
    assert exact.delay_ms == (0.0, 0.0)


def test_camera_that_sees_all_sees_what_the_plain_one_does_not():
    beside, p = np.array([3.0, 0.0, 0.5]), camera_parameters(Camera(), 1000)
    R = np.diag([1.0, -1.0, -1.0])
    assert not visible(beside, R, p[0])
    see_all(p)
    assert visible(beside, R, p[0])
    assert not visible(-beside, R, p[0])
