"""The camera's measurement model against the published numbers, an independent corner model, and plain geometry."""

import numpy as np
import pytest
from numba import njit
from scipy.spatial.transform import Rotation
from scipy.stats import chisquare

from armland.plant.devices.camera import observe, visible
from armland.plant.devices.camera_numbers import SAMPLE, camera_told, kept_layout, well
from armland.plant.devices.detector_errors import DETECTOR, second_pose
from armland.plant.noise import CAMERA_WIDTH, stream
from armland.scenario.sensing import Camera

LEVEL, ORIGIN = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
FACING = np.array([0.0, 1.0, 0.0, 0.0])  # the printed face looks back along the camera's z
STEADY = Camera(lose=0.0, marker_size_m=0.08)


def other(camera=STEADY, **changes):
    return camera.model_copy(update=changes)


@njit(cache=True)
def run(eye, mark, noise, frozen, errors, told, kept, arrival, samples):
    found = 0
    for k in range(len(noise)):
        s = kept[0]
        for i in range(3):
            s.eye[i], s.mark[i] = eye[k, i], mark[k, i]
        for i in range(4):
            s.eye_quat[i], s.mark_quat[i] = eye[k, 3 + i], mark[k, 3 + i]
        errors[0].frozen = frozen[k]
        observe(k, noise[k], errors[0], told[0], s)
        if s.sample.fresh:
            arrival[found] = k
            samples[found].capture = s.sample.capture
            for i in range(3):
                samples[found].position[i] = s.sample.position[i]
            for i in range(4):
                samples[found].quat[i] = s.sample.quat[i]
            for i in range(6):
                samples[found].sigma[i] = s.sample.sigma[i]
            found += 1
    return found


class Seen:
    """The samples of a run: arrival ticks and the samples as they came."""

    def __init__(self, arrival, samples):
        self.arrival, self.samples = arrival, samples

    def __getattr__(self, name):
        return self.samples[name]


def watch(
    ticks, camera=STEADY, offset=(0.0, 0.0, 0.5), quat=FACING, frozen=None, base_hz=1000, eye=None, fails=None, **told
):
    """Run the camera; `offset` of the marker may be a function of the tick, `eye` = (position, quat) is the camera.

    `fails` are fields of `camera_numbers.ERRORS`.
    """
    p, s = camera_told(camera, base_hz), np.zeros(1, kept_layout(0))
    for name, value in told.items():
        p[name] = value
    noise = stream(1, "camera").standard_normal((ticks, CAMERA_WIDTH))
    mark, here, view = np.zeros((ticks, 7)), *(eye or (ORIGIN, LEVEL))
    mark[:, :3] = [offset(k) for k in range(ticks)] if callable(offset) else offset
    mark[:, 3:] = quat
    where = np.tile(np.concatenate([here, view]), (ticks, 1))
    stuck = np.zeros(ticks, dtype=bool) if frozen is None else np.array([frozen(k) for k in range(ticks)])
    arrival, samples = np.zeros(ticks, dtype=np.int64), np.zeros(ticks, SAMPLE)
    errors = well()
    for name, value in (fails or {}).items():
        errors[name] = value
    found = run(where, mark, noise, stuck, errors, p, s, arrival, samples)
    return Seen(arrival[:found], samples[:found])


@pytest.mark.parametrize(("depth", "lateral_mm", "depth_mm"), [(0.3, 0.4, 0.9), (1.0, 0.7, 3.3)])
def test_spread_of_samples_is_the_published_precision(depth, lateral_mm, depth_mm):
    seen = watch(60_000, offset=(0.02, -0.01, depth))
    error = seen.position - [0.02, -0.01, depth]
    # 1800 samples: the standard deviation is known to 1.7 %.
    np.testing.assert_allclose(1e3 * error.std(axis=0), [lateral_mm, lateral_mm, depth_mm], rtol=0.06)
    assert (np.abs(error.mean(axis=0)) < 4.0 * seen.sigma[0, :3] / np.sqrt(len(error))).all()


def test_spread_of_attitude_is_that_of_a_square_fitted_to_four_noisy_corners():
    """Oracle: corners with independent errors, their mean and their rigid least-squares fit by scipy."""
    size, rng = 0.08, np.random.default_rng(3)
    seen = watch(60_000, offset=(0.0, 0.0, 0.6), camera=other(marker_size_m=size))
    lateral, depth = seen.sigma[0, 0], seen.sigma[0, 2]
    corners = 0.5 * size * np.array([[1, 1, 0], [1, -1, 0], [-1, -1, 0], [-1, 1, 0]])
    fits, means = [], []
    for _ in range(4000):
        noisy = corners + 2.0 * rng.normal(size=(4, 3)) * [lateral, lateral, depth]
        means.append(noisy.mean(axis=0))
        fits.append(_fit(noisy, corners))
    np.testing.assert_allclose(np.std(means, axis=0), seen.sigma[0, :3], rtol=0.06)
    turns = (
        Rotation.from_quat(seen.quat, scalar_first=True) * Rotation.from_quat(FACING, scalar_first=True).inv()
    ).as_rotvec()
    np.testing.assert_allclose(np.std(fits, axis=0), turns.std(axis=0), rtol=0.08)


def _fit(noisy, corners):
    # Small rotation θ with θ × c ≈ noisy − mean − c, unweighted per direction: tilt from depths, yaw from the image plane.
    d = noisy - noisy.mean(axis=0) - corners
    x, y = corners[:, 0], corners[:, 1]
    return [y @ d[:, 2] / (y @ y), -x @ d[:, 2] / (x @ x), (x @ d[:, 1] - y @ d[:, 0]) / (x @ x + y @ y)]


def test_a_larger_marker_helps_the_attitude_and_not_the_position():
    small, large = (watch(200, camera=other(marker_size_m=s)).sigma[0] for s in (0.04, 0.12))
    np.testing.assert_array_equal(large[:3], small[:3])
    np.testing.assert_allclose(small[3:] / large[3:], 3.0)


@pytest.mark.parametrize("base_hz", [1000, 500])
def test_rate_is_exact_on_average_and_the_delay_uniform(base_hz):
    seen = watch(20 * base_hz, base_hz=base_hz)
    period = base_hz / 30
    # The last images are still under way.
    assert len(seen.arrival) in range(20 * 30 - 4, 20 * 30 + 1)
    assert np.abs(seen.capture - np.arange(len(seen.capture)) * period).max() < 1.0
    delay = seen.arrival - seen.capture
    ticks = np.arange(round(0.050 * base_hz), round(0.075 * base_hz) + 1)
    assert set(delay) <= set(ticks)
    assert chisquare([np.sum(delay == k) for k in ticks]).pvalue > 1e-3
    assert (np.diff(seen.arrival) > 0).all()


def test_no_image_overtakes_another_where_the_delay_scatters_by_periods():
    seen = watch(10_000, camera=other(rate_hz=100, delay_ms=(10.0, 90.0)))
    assert (np.diff(seen.capture) == 10).all()
    assert (np.diff(seen.arrival) > 0).all()


def test_sample_belongs_to_the_capture_and_not_to_the_arrival():
    seen = watch(8000, offset=lambda k: (0.1 * np.sin(0.003 * k), 0.0, 0.4))
    at_capture = 0.1 * np.sin(0.003 * seen.capture)
    at_arrival = 0.1 * np.sin(0.003 * seen.arrival)
    assert np.sqrt(np.mean((seen.position[:, 0] - at_capture) ** 2)) < 0.6e-3
    assert np.sqrt(np.mean((seen.position[:, 0] - at_arrival) ** 2)) > 8e-3


def test_pose_is_that_of_the_marker_in_the_camera_frame():
    view = Rotation.from_rotvec([0.3, -0.2, 0.5])
    eye = np.array([0.4, -0.3, 0.7])
    marker = view * Rotation.from_rotvec([np.pi, 0.0, 0.0]) * Rotation.from_rotvec([0.1, 0.2, -0.7])
    place = eye + view.apply([0.03, -0.05, 0.4])
    seen = watch(
        4000,
        offset=place,
        quat=marker.as_quat(scalar_first=True),
        eye=(eye, view.as_quat(scalar_first=True)),
        camera=other(honesty=1e-6),
    )
    back = eye + view.apply(seen.position[-1])
    np.testing.assert_allclose(back, place, atol=1e-7)
    attitude = view * Rotation.from_quat(seen.quat[-1], scalar_first=True)
    assert (attitude * marker.inv()).magnitude() < 1e-6


@pytest.mark.parametrize(
    ("offset", "tilt_deg", "expected", "incidence_deg"),
    [
        ((0.0, 0.0, 0.5), 0.0, True, 25.0),
        ((0.0, 0.0, -0.5), 0.0, False, 25.0),  # behind
        ((0.0, 0.0, 0.04), 0.0, False, 25.0),  # too near
        ((0.0, 0.0, 2.3), 0.0, False, 25.0),  # too far
        ((0.24, 0.0, 0.5), 0.0, True, 60.0),  # the edge of the view lies at 0.289 m, the marker's at 0.28 m
        ((0.26, 0.0, 0.5), 0.0, False, 60.0),  # a corner is out of view
        ((0.0, 0.19, 0.5), 0.0, False, 60.0),  # the image is lower than wide
        ((0.19, 0.0, 0.5), 0.0, True, 60.0),
        ((0.0, 0.0, 0.5), 24.0, True, 25.0),
        ((0.0, 0.0, 0.5), 26.0, False, 25.0),  # at too flat an angle
        ((0.0, 0.0, 0.5), 180.0, False, 25.0),  # from behind
    ],
)
def test_what_is_in_view(offset, tilt_deg, expected, incidence_deg):
    camera = other(incidence_max_deg=incidence_deg)
    R = (Rotation.from_quat(FACING, scalar_first=True) * Rotation.from_euler("x", tilt_deg, degrees=True)).as_matrix()
    p = camera_told(camera, 1000)
    assert visible(np.array(offset), np.ascontiguousarray(R), p[0]) == expected
    assert (
        len(watch(300, camera, offset=offset, quat=Rotation.from_matrix(R).as_quat(scalar_first=True)).arrival) > 0
    ) == expected


@pytest.mark.parametrize(("azimuth_deg", "expected"), [(0.0, False), (8.0, False), (30.0, True), (180.0, True)])
def test_marker_is_not_seen_from_where_its_own_uav_hides_it(azimuth_deg, expected):
    """Hidden from 20° on in one direction of the marker's frame, and in those up to the next one beside it."""
    p = camera_told(other(incidence_max_deg=60.0), 1000)
    p["cos_clear"][0, 0] = np.cos(np.deg2rad(20.0))
    facing = Rotation.from_quat(FACING, scalar_first=True)
    for tilt_deg, seen in ((19.0, True), (30.0, expected)):
        # The marker turned about an axis across the direction from which it is looked at then.
        a = np.deg2rad(azimuth_deg)
        turn = Rotation.from_rotvec(np.deg2rad(tilt_deg) * np.array([np.sin(a), -np.cos(a), 0.0]))
        R = np.ascontiguousarray((facing * turn).as_matrix())
        assert visible(np.array([0.0, 0.0, 0.5]), R, p[0]) == seen


def test_dropouts_come_as_often_and_as_long_as_stated():
    lose, stay = 0.05, 0.6
    seen = watch(300_000, camera=other(lose=lose, stay_lost=stay))
    gaps = np.round(np.diff(seen.capture) * 0.03).astype(int) - 1
    lost_share = gaps.sum() / (gaps.sum() + len(gaps))
    # A chain with two states: found → lost with p, lost → lost with s.
    assert lost_share == pytest.approx(lose / (1.0 + lose - stay), rel=0.12)
    assert gaps[gaps > 0].mean() == pytest.approx(1.0 / (1.0 - stay), rel=0.12)
    assert len(watch(3000, camera=other(lose=1.0, stay_lost=1.0)).arrival) == 0


def test_frozen_camera_delivers_the_last_image_with_stamps_that_look_new():
    def moving(k):
        return (1e-4 * k, 0.0, 0.5)

    seen = watch(2000, offset=moving, frozen=lambda k: k >= 1000)
    after = seen.samples[seen.capture >= 1000]
    assert len(after) > 20
    assert (np.diff(after["capture"]) > 0).all()
    assert (after["position"] == seen.samples[seen.capture < 1000]["position"][-1]).all()
    healthy = watch(2000, offset=moving)
    assert len(np.unique(healthy.position[:, 0])) == len(healthy.position)
    assert len(watch(500, frozen=lambda k: True).arrival) == 0


def test_claimed_noise_may_be_a_lie():
    honest, liar = (watch(20_000, camera=other(honesty=h)) for h in (1.0, 3.0))
    np.testing.assert_array_equal(liar.sigma, honest.sigma)
    np.testing.assert_allclose(liar.position.std(axis=0), 3.0 * honest.position.std(axis=0), rtol=1e-9)


def test_larger_of_published_and_detectors_errors_holds():
    """Negative control: with a detector that is worse than published, its own law is what comes out, at any size of marker."""
    bad = (DETECTOR.lateral, (0.1, 2.0), DETECTOR.tilt, (0.2, 1.0))
    plain, worse = (watch(200, camera=other(marker_size_m=0.06), detector=d).sigma[0] for d in (DETECTOR[:4], bad))
    changed = [0.1 * 0.5**2, 0.2 * 0.5]
    np.testing.assert_allclose(worse[[2, 5]], changed)
    np.testing.assert_array_equal(worse[[0, 1, 3, 4]], plain[[0, 1, 3, 4]])
    # Twice the marker at twice the distance makes the same picture.
    double = watch(200, offset=(0, 0, 1.0), camera=other(marker_size_m=0.12), detector=bad).sigma[0]
    np.testing.assert_allclose(double[[2, 5]], np.multiply(changed, [2.0, 1.0]))


def test_published_errors_are_the_larger_ones_over_the_published_range():
    for z in np.geomspace(0.13, 1.6, 12):
        sigma = watch(200, offset=(0, 0, z), camera=other(marker_size_m=0.06)).sigma[0]
        ours = [law.at_1m * z**law.power for law in DETECTOR[:4]]
        assert (sigma[[0, 2, 3, 5]] > ours).all()


def test_calibration_shifts_every_sample_alike():
    biased = {"shift": (1e-3, -2e-3, 3e-3), "slope": (2e-3, 0.0, -4e-3)}
    plain, shifted = watch(3000, offset=(0, 0, 0.5)), watch(3000, offset=(0, 0, 0.5), **biased)
    expected = [1e-3 + 2e-3 * 0.5, -2e-3, 3e-3 - 4e-3 * 0.5]
    np.testing.assert_allclose(
        shifted.position - plain.position, np.tile(expected, (len(plain.position), 1)), atol=1e-12
    )
    np.testing.assert_array_equal(shifted.sigma, plain.sigma)


def test_smeared_images_are_lost_and_a_short_exposure_keeps_them():
    # 1.5 m/s at 0.4 m: the line of sight turns by 3.75 rad/s, 4 ms and 1078 px make 16 px of it.
    def swept(k):
        return (0.1 * np.sin(15.0 * k * 1e-3), 0.0, 0.4)

    still, fast, short = (
        len(watch(30_000, **more).arrival)
        for more in (
            {"offset": (0.1, 0.0, 0.4)},
            {"offset": swept},
            {"offset": swept, "camera": other(exposure_s=1e-3)},
        )
    )
    assert still > 890
    assert short > 890
    assert fast < 0.7 * still


def test_outliers_are_as_many_and_as_far_as_stated():
    plain, strayed = watch(60_000), watch(60_000, outlier=0.1, outlier_m=0.2)
    off = np.linalg.norm(strayed.position - plain.position, axis=1)
    assert np.mean(off > 0.0) == pytest.approx(0.1, abs=0.02)
    assert np.sqrt(np.mean(off[off > 0.0] ** 2) / 3.0) == pytest.approx(0.2, rel=0.1)
    # They claim to be as good as any.
    np.testing.assert_array_equal(strayed.sigma, plain.sigma)


def differing(one, other):
    """Fields in which two runs that found equally often differ."""
    np.testing.assert_array_equal(one.arrival, other.arrival)
    return {n for n in ("capture", "position", "quat", "sigma") if (getattr(one, n) != getattr(other, n)).any()}


def test_fault_in_the_noise_is_not_claimed():
    true = np.array([0.02, -0.01, 0.5])
    well, noisy = (watch(6000, offset=true, fails={"noise": n}) for n in (1.0, 3.0))
    assert differing(well, noisy) == {"position", "quat"}
    np.testing.assert_allclose(noisy.position - true, 3.0 * (well.position - true), atol=1e-12)


def test_outliers_scatter_as_stated_on_each_axis_and_turn_nothing():
    well, off = watch(60_000), watch(60_000, fails={"outlier": 0.011})
    assert differing(well, off) == {"position"}
    error = off.position - well.position
    # 1800 samples: the standard deviation is known to 1.7 %.
    np.testing.assert_allclose(error.std(axis=0), 0.011, rtol=0.06)
    np.testing.assert_allclose(np.corrcoef(error[1:].T, error[:-1].T) - np.eye(6), 0.0, atol=0.1)


def test_flipped_attitude_is_the_second_pose_and_nothing_else_changes():
    offset = np.array([0.1, 0.05, 0.5])
    well, flipped = (watch(3000, offset=offset, honesty=0.0, fails={"flipped": f}) for f in (0, 1))
    assert differing(well, flipped) == {"quat"}
    np.testing.assert_allclose(flipped.quat, np.tile(second_pose(offset, FACING), (len(flipped.quat), 1)), atol=1e-12)
    # At twelve degrees beside the axis it is off by twice that.
    turn = Rotation.from_quat(flipped.quat[0], scalar_first=True) * Rotation.from_quat(FACING, scalar_first=True).inv()
    assert turn.magnitude() == pytest.approx(2.0 * np.arctan(np.hypot(0.1, 0.05) / 0.5), abs=1e-9)


def test_wrong_marker_lies_beside_in_the_worlds_axes():
    """The camera is turned by a quarter about its view: 20 mm along the world's x are its -y."""
    view = np.array([np.cos(np.pi / 4), 0.0, 0.0, np.sin(np.pi / 4)])
    well, wrong = (
        watch(3000, eye=(ORIGIN, view), honesty=0.0, fails={"marker": d}) for d in (np.zeros(3), [0.02, 0, 0])
    )
    assert differing(well, wrong) == {"position"}
    np.testing.assert_allclose(
        wrong.position - well.position, np.tile([0.0, -0.02, 0.0], (len(wrong.position), 1)), atol=1e-12
    )


def test_wrong_marker_out_of_sight_is_not_found():
    assert len(watch(3000, fails={"marker": [1.0, 0.0, 0.0]}).arrival) == 0
