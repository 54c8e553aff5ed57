"""The pose filter on a swaying UAV whose motion, attitude and late samples are made with NumPy and scipy alone."""

from time import perf_counter
from types import SimpleNamespace

import numpy as np
import pytest
from numba import njit
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from armland.estimation.plate.late_fusion import RING
from armland.estimation.plate.layouts import kept_layout, plate_layout, told
from armland.estimation.plate.pose_filter import (
    FUSED,
    GATED,
    REPEATED,
    RESTARTED,
    STARTED,
    UNUSABLE,
    fuse,
    predict,
)
from armland.estimation.plate.reckoning import advance, present
from armland.estimation.plate.scatter import learn_noise
from armland.models.environment import DOWN
from armland.scenario import load_scenario

H, MASS, GRAVITY = 1e-3, 0.480, 9.81
MESSAGE = np.dtype(
    [("tick", "i8"), ("uav_tick", "i8"), ("uav_quat", "f8", (4,)), ("uav_rate", "f8", (3,)), ("uav_force", "f8", (3,))]
    + [("camera_capture", "i8")]
    + [("camera_position", "f8", (3,)), ("camera_quat", "f8", (4,)), ("camera_sigma", "f8", (6,))]
)
"""Of the measurement what the filter reads."""
SIGMA = np.array([0.4e-3, 0.4e-3, 1.0e-3, 0.025, 0.025, 0.007])
PERIOD, LINK = 33, 5  # ticks between images, between attitudes
MARKER, PLATE_OFFSET = np.array([0.04, -0.02, -0.03]), np.array([0.0, 0.0, -0.06])
FACE = Rotation.from_quat([0.0, 1.0, 0.0, 0.0], scalar_first=True)
GATE, RESTART_AFTER = 16.27, 4
STILL, UNITY = np.zeros(3), np.ones(1)


def settings(**changes):
    """What the filter is told, with fields changed."""
    p = told(load_scenario("landing", {"camera": {"marker_m": list(MARKER)}}), MASS, PLATE_OFFSET)
    assert p["gate"] == GATE
    assert p["restart_after"] == RESTART_AFTER
    for name, value in changes.items():
        p[name] = value
    return p


def tick(k, taken, quat, rate, lift, eye, view, p, s, push=STILL, force=STILL):
    """One tick of the filter, the UAV's newest attitude `quat`, `rate` and specific `force` having been taken at `taken`."""
    m = np.zeros(1, MESSAGE)
    m["tick"], m["uav_tick"], m["uav_quat"], m["uav_rate"], m["uav_force"] = k, taken, quat, rate, force
    advance(m[0], lift, push, DOWN, eye, view, p[0], s[0])


def quats(R):
    return R.as_quat(scalar_first=True)


def swaying(ticks=4000, seed=0, pace=1.0, tilt_error=(0.02, -0.015), heading_error=0.4):
    """Truth and what the UAV reports. The camera moves, too."""
    t, w, rng = (
        np.arange(ticks)[:, None] * H,
        2.0 * np.pi * pace * np.array([0.5, 0.5, 0.65]),
        np.random.default_rng(seed),
    )
    size, phase, middle = np.array([0.10, 0.08, 0.03]), np.array([0.0, 1.0, 2.0]), np.array([0.5, 0.1, 1.2])
    p, v = middle + size * np.sin(w * t + phase), size * w * np.cos(w * t + phase)
    force = MASS * (-size * w * w * np.sin(w * t + phase) + [0.0, 0.0, GRAVITY])
    thrust = np.linalg.norm(force, axis=1)
    axis = np.cross([0.0, 0.0, 1.0], force)
    angle = np.arctan2(np.linalg.norm(axis, axis=1), force[:, 2])
    tilt = Rotation.from_rotvec(axis / np.maximum(np.linalg.norm(axis, axis=1), 1e-12)[:, None] * angle[:, None])
    R = tilt * Rotation.from_euler("z", 0.3)
    omega = np.zeros((ticks, 3))
    omega[:-1] = (R[:-1].inv() * R[1:]).as_rotvec() / H
    drift = Rotation.from_rotvec([*tilt_error, heading_error])
    report = drift.inv() * R * Rotation.from_rotvec(2e-3 * rng.normal(size=(ticks, 3)))
    eye = np.array([0.5, 0.1, 0.75]) + 0.05 * np.sin(2.0 * t * [1.0, 1.5, 0.7])
    view = Rotation.from_rotvec(0.1 * np.sin(1.5 * t + [0.0, 1.0, 2.0]))
    return SimpleNamespace(
        ticks=ticks,
        rng=rng,
        cm=p,
        cm_velocity=v,
        R=R,
        plate=p + R.apply(PLATE_OFFSET),
        velocity=v + R.apply(np.cross(omega, PLATE_OFFSET)),
        report=quats(report),
        rate=omega + 1e-2 * rng.normal(size=(ticks, 3)),
        thrust=thrust,
        eye=eye,
        view=view,
        view_quat=quats(view),
    )


def image(motion, tick, sigma=SIGMA):
    """The sample of an exposure at `tick`."""
    n, view = motion.rng.normal(size=6) * sigma, motion.view[tick]
    marker = motion.R[tick] * FACE
    sample = np.zeros(1, MESSAGE)
    sample["camera_capture"], sample["camera_sigma"] = tick, SIGMA
    sample["camera_position"] = (
        view.inv().apply(motion.cm[tick] + motion.R[tick].apply(MARKER) - motion.eye[tick]) + n[:3]
    )
    sample["camera_quat"] = quats(Rotation.from_rotvec(n[3:]) * view.inv() * marker)
    return sample


def run(motion, p=None, tamper=lambda tick, sample: sample, horizon=0.0, lag=12, **kinds):
    """Fly the motion; records of the plate, the states, and what `fuse` answered.

    `tamper` may change or drop a sample as it arrives; `kinds["stamp_imu"]` and `kinds["stamp_camera"]` stamp anew on arrival.
    """
    p = settings() if p is None else p
    s, plate = np.zeros(1, kept_layout()), np.zeros(1, plate_layout())
    rows, states, answers, arrivals = [], [], [], {}
    for k in range(motion.ticks):
        taken = max(k - lag, 0) // LINK * LINK
        stamp = k if kinds.get("stamp_imu") else taken
        report, rate = motion.report[taken], motion.rate[taken]
        force = kinds["force"][taken] if "force" in kinds else STILL
        lift = motion.thrust[k] * kinds.get("gives", UNITY)[k % len(kinds.get("gives", UNITY))]
        view = motion.eye[k], motion.view_quat[k]
        tick(k, stamp, report, rate, lift, *view, p, s, kinds.get("push", STILL), force)
        if k % PERIOD == 0:
            sample = image(motion, k, kinds.get("sigma", SIGMA))
            arrivals[k + int(motion.rng.integers(50, 76))] = sample
        if k in arrivals and (sample := tamper(k, arrivals[k])) is not None:
            if kinds.get("stamp_camera"):
                sample["camera_capture"] = k
            answers.append((k, fuse(sample[0], p[0], s[0])))
            if answers[-1][1] == FUSED:
                states.append((k, *s["distance"][0]))
        predict(horizon, p[0], s[0], plate[0])
        rows.append(plate[0].copy())
    return SimpleNamespace(
        plate=np.array(rows, plate_layout()),
        answers=np.array(answers),
        distances=np.array(states),
        memory=s,
        parameters=p,
    )


def rms(a):
    return np.sqrt(np.mean(np.square(a), axis=0))


@pytest.fixture(scope="module")
def motion():
    return swaying()


@pytest.fixture(scope="module")
def flown(motion):
    return run(swaying())


SETTLED = slice(1500, None)


def test_plate_is_known_to_millimetres_although_samples_are_late(motion, flown):
    assert flown.answers[0, 1] == STARTED
    assert np.mean(flown.answers[1:, 1] == FUSED) > 0.97
    error = (flown.plate["position"] - motion.plate)[SETTLED]
    assert (rms(error) < [1.5e-3, 1.5e-3, 2.5e-3]).all()
    assert (rms((flown.plate["velocity"] - motion.velocity)[SETTLED]) < 0.025).all()
    assert flown.plate["valid"][300:].all()


def test_samples_taken_for_current_ones_show_the_lag(motion):
    """Control: at 0.3 m/s a sample that is 62 ms old is 20 mm off."""
    naive = run(swaying(), settings(gate=np.inf), stamp_camera=True)
    lag = rms((naive.plate["position"] - motion.plate)[SETTLED])
    assert lag[:2].min() > 8e-3
    expected = 0.062 * rms(motion.velocity[SETTLED] - np.gradient(motion.eye, H, axis=0)[SETTLED])
    np.testing.assert_allclose(lag[:2], expected[:2], rtol=0.4)


def test_attitude_comes_out_although_the_uav_has_another_world(motion, flown):
    error = (Rotation.from_quat(flown.plate["quat"], scalar_first=True) * motion.R.inv()).as_rotvec()
    assert (rms(error[SETTLED]) < [6e-3, 6e-3, 4e-3]).all()
    # The alignment's error changes slowly: this is one draw of it.
    assert (rms(error[SETTLED]) < 3.0 * flown.plate["sigma_attitude"][SETTLED].mean(axis=0)).all()
    reported = (Rotation.from_quat(motion.report, scalar_first=True) * motion.R.inv()).magnitude()
    assert np.median(reported) > 0.3


def test_acceleration_of_the_centre_of_mass(motion, flown):
    error = flown.plate["acceleration"] - np.gradient(motion.cm_velocity, H, axis=0)
    assert rms(error[SETTLED]).max() < 0.15


def test_attitude_is_reckoned_from_the_tick_at_which_it_was_taken():
    errors = []
    for as_current in (False, True):
        out = run(swaying(), lag=30, stamp_imu=as_current)
        error = (Rotation.from_quat(out.plate["quat"], scalar_first=True) * swaying().R.inv()).as_rotvec()
        # Without its mean, which is the alignment's error.
        errors.append(error[SETTLED].std(axis=0).max())
    assert errors[0] < 5e-3
    assert errors[1] > 3.0 * errors[0]


def test_thrust_and_attitude_predict_better_than_constant_acceleration():
    """Control: a UAV so heavy that its thrust moves it no more, under no gravity; the bias is then the whole acceleration."""
    errors = []
    for p in (settings(), settings(mass=1e9, walk=10.0)):
        quick = swaying(pace=2.0)
        if p["mass"] > 1.0:
            quick.push = np.array([0.0, 0.0, GRAVITY])
        out = run(quick, p, push=getattr(quick, "push", STILL))
        assert np.mean(out.answers[1:, 1] == FUSED) > 0.97
        errors.append(rms((out.plate["velocity"] - quick.velocity)[SETTLED]).max())
    assert 2.0 * errors[0] < errors[1] < 0.4


def test_prediction_beats_waiting(motion):
    ahead = 100
    out = run(swaying(), horizon=ahead * H)
    truth, guess = motion.plate[ahead:], out.plate["position"][:-ahead]
    window = slice(1500, -ahead)
    error = rms((guess - truth)[window])
    assert (error < 5e-3).all()
    assert (error < 1.5 * out.plate["sigma_position"][SETTLED].mean(axis=0)).all()
    assert (rms((motion.plate[:-ahead] - truth)[window])[:2] > 4.0 * error[:2]).all()


def wander(runs, walk=0.3, white=0.05, sigma=SIGMA, seconds=3.0, learns=True):
    """Squared errors of (p, v, b) once a second and squared innovations, under the very noise that the filter assumes."""
    p = settings(marker_offset=(0.0, 0.0, 0.0), sigma_attitude=1e-6, gate=np.inf)
    level, still, errors, distances = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3), [], []
    for seed in range(runs):
        rng, ticks = np.random.default_rng(seed), round(seconds / H)
        b = 0.5 * rng.normal(size=3) + np.cumsum(walk * np.sqrt(H) * rng.normal(size=(ticks, 3)), axis=0)
        v = 0.2 * rng.normal(size=3) + np.cumsum(b * H + white * np.sqrt(H) * rng.normal(size=(ticks, 3)), axis=0)
        x = np.array([0.0, 0.0, 0.4]) + np.cumsum(v * H, axis=0)
        s, arrivals = np.zeros(1, kept_layout()), {}
        for k in range(ticks):
            tick(k, k, level, still, MASS * GRAVITY, still, level, p, s)
            if k % PERIOD == 0:
                sample = np.zeros(1, MESSAGE)
                sample["camera_capture"], sample["camera_sigma"] = k, SIGMA
                sample["camera_quat"] = quats(Rotation.from_rotvec(rng.normal(size=3) * SIGMA[3:]) * FACE)
                sample["camera_position"] = x[k] + rng.normal(size=3) * sigma[:3]
                arrivals[k + int(rng.integers(50, 76))] = sample
            if not learns:
                s["noise"] = 1.0
            if k in arrivals and fuse(arrivals[k][0], p[0], s[0]) == FUSED and k > 500:
                distances.append(s["distance"][0, 0])
            if k % 1000 == 999:
                state, P = present(p[0], s[0])
                error = state - np.concatenate((x[k], v[k], b[k]))
                errors.append(error @ np.linalg.solve(P, error))
    return np.array(errors), np.array(distances)


@pytest.mark.parametrize(
    ("changes", "consistent"),
    [({}, True), ({"sigma": 1.5 * SIGMA, "learns": False}, False), ({"walk": 1.5}, False)],
)
def test_errors_and_innovations_are_as_large_as_the_covariance_says(changes, consistent):
    """NEES with 9 and NIS with 3 degrees of freedom, two-sided at 0.1 %; controls: noise or gusts beyond what is assumed."""
    errors, distances = wander(16, **changes)
    levels = [chi2(9 * len(errors)).cdf(errors.sum()), chi2(3 * len(distances)).cdf(distances.sum())]
    inside = [0.0005 < level < 0.9995 for level in levels]
    assert all(inside) if consistent else not any(inside)


def test_errors_stay_as_large_as_the_covariance_says_where_the_noise_is_learnt():
    """At three times the claimed noise: within two sigma of the learnt ratio's own scatter, 13 %; as claimed it is far out."""
    learnt, frozen = (wander(16, sigma=3.0 * SIGMA, learns=learns)[0].mean() / 9.0 for learns in (True, False))
    assert learnt == pytest.approx(1.0, abs=0.26)
    assert frozen > 2.0


def test_stale_camera_costs_certainty_and_then_validity(motion):
    out = run(swaying(), tamper=lambda k, sample: sample if k < 2000 or k > 3400 else None)
    plate = out.plate
    last = out.answers[out.answers[:, 0] < 2000][-1, 0]
    blind = plate[last + 1 : 3400]
    growth = np.diff(blind["sigma_position"], axis=0)
    assert (growth > 0.0).all()
    assert np.abs(growth / blind["sigma_position"][1:]).max() < 0.05
    assert not blind["valid"][250:].any()
    assert blind["age"][-1] > 1.3 > RING * H
    # The error stays within what is said, also after the last sample has left the ring.
    error = np.abs(blind["position"] - motion.plate[last + 1 : 3400])
    assert (error < 4.0 * blind["sigma_position"]).all()
    assert plate["valid"][3700:].all()


def test_stale_attitude_costs_certainty_and_then_validity():
    sway = swaying()
    frozen = slice(2000, None)
    sway.report[frozen], sway.rate[frozen] = sway.report[1999], sway.rate[1999]
    fresh = run(swaying())
    p, s, plate, valid = fresh.parameters, np.zeros(1, kept_layout()), np.zeros(1, plate_layout()), []
    sigma = []
    for k in range(2600):
        taken = min(max(k - 12, 0) // LINK * LINK, 1995)
        tick(k, taken, sway.report[taken], sway.rate[taken], sway.thrust[k], sway.eye[k], sway.view_quat[k], p, s)
        if k >= 60 and (k - 60) % PERIOD == 0:
            fuse(image(sway, k - 60)[0], p[0], s[0])
        predict(0.0, p[0], s[0], plate[0])
        valid.append(plate["valid"][0])
        sigma.append(plate["sigma_velocity"][0].max())
    assert all(valid[400:2000])
    assert not any(valid[1995 + 251 :])
    assert min(sigma[2200:]) > 1.5 * max(sigma[1500:1990])


@pytest.mark.parametrize("kind", ["frozen", "frozen but never the same"])
def test_frozen_image_is_known_by_its_digits(motion, kind):
    held = {}

    def freeze(k, sample):
        if k < 2000:
            held["last"] = sample.copy()
            return sample
        sample["camera_position"], sample["camera_quat"] = held["last"]["camera_position"], held["last"]["camera_quat"]
        if kind != "frozen":
            sample["camera_position"] += 1e-9 * k
        return sample

    out = run(swaying(), settings(gate=np.inf), tamper=freeze)
    after = out.answers[out.answers[:, 0] >= 2000, 1]
    wrong = np.linalg.norm(out.plate["position"] - motion.plate, axis=1) > 0.03
    believed = out.plate["valid"] == 1
    if kind == "frozen":
        assert (after == REPEATED).all()
        assert not out.plate["valid"][2300:].any()
        assert not (wrong & believed).any()
    else:
        assert (wrong & believed).any()


@pytest.mark.parametrize("gate", [GATE, np.inf])
def test_outlier_is_gated(motion, gate):
    def outlier(k, sample):
        if 2000 <= k < 2000 + PERIOD:
            sample["camera_position"] += [0.2, 0.0, 0.0]
        return sample

    out = run(swaying(2300), settings(gate=gate), tamper=outlier)
    gated = out.answers[(out.answers[:, 0] >= 2000) & (out.answers[:, 0] < 2000 + PERIOD), 1]
    error = np.linalg.norm(out.plate["position"] - motion.plate[:2300], axis=1)[1500:].max()
    assert (gated == GATED).all() == (gate < np.inf)
    assert error < 0.012 if gate < np.inf else error > 0.05


def test_flipped_marker_is_gated():
    def flip(k, sample):
        if 2000 <= k < 2000 + PERIOD:
            sample["camera_quat"] = quats(
                Rotation.from_rotvec([0.6, 0.0, 0.0]) * Rotation.from_quat(sample["camera_quat"], scalar_first=True)
            )
        return sample

    out = run(swaying(2200), tamper=flip)
    assert (out.answers[(out.answers[:, 0] >= 2000) & (out.answers[:, 0] < 2000 + PERIOD), 1] == GATED).all()


@pytest.mark.parametrize(("outlier", "leaps"), [("same", True), ("scattered", False)])
def test_marker_that_leaps_is_told_from_images_that_scatter(outlier, leaps):
    """0.1 m off: another marker is off the same way in every image, noise in each another way."""
    rng, step = np.random.default_rng(4), np.array([0.1, 0.0, 0.0])

    def tamper(k, sample):
        if k >= 2000:
            sample["camera_position"] += step if outlier == "same" else 0.1 * rng.normal(size=3)
        return sample

    s = run(swaying(2800), tamper=tamper).memory
    assert (s["leapt"][0] > 2000) == leaps
    assert (s["noise"][0] > 25.0) != leaps


@pytest.mark.parametrize("times", [1.0, 6.0])
def test_camera_that_errs_six_times_what_it_claims_is_known_soon(times):
    """Place and attitude alike: images that were thrown away would teach nothing."""
    s = run(swaying(4000), tamper=lambda k, sample: noisier(k, sample, times)).memory
    assert (s["noise"][0] > 25.0) == (times > 5.0)
    assert s["leapt"][0] == 0


def noisier(k, sample, times):
    """The sample with noise of `times` what it claims from tick 2000 on."""
    rng = np.random.default_rng(k)
    if k >= 2000 and times > 1.0:
        sample["camera_position"] += times * SIGMA[:3] * rng.normal(size=3)
        turned = Rotation.from_rotvec(times * SIGMA[3:] * rng.normal(size=3))
        sample["camera_quat"] = quats(turned * Rotation.from_quat(sample["camera_quat"], scalar_first=True))
    return sample


def bias_after(fall, ticks=300):
    """Vertical disturbance, m/s², that is known `ticks` after the UAV began to accelerate by `fall`, m/s², beyond its thrust."""
    sway = swaying(2000 + ticks)
    late = np.clip(np.arange(2000 + ticks) - 2000, 0, None)[:, None] * H
    for name in ("cm", "plate"):
        getattr(sway, name)[:] += 0.5 * fall * late**2 * [0.0, 0.0, 1.0]
    return float(run(sway).plate["bias"][-1, 2])


def test_thrust_that_is_lost_is_known_sooner_than_a_lift_that_no_rotor_makes():
    """A loss comes at once; what lifts is wind, and the random walk of the disturbance follows that."""
    lost, lifted = bias_after(-1.5), bias_after(1.5)
    assert -lost > 1.2 * lifted
    assert lost == pytest.approx(-1.5, abs=0.5)


@pytest.mark.parametrize("off", [0.02, -0.02])
def test_one_image_that_sees_the_uav_lower_is_no_loss_of_thrust(off):
    """Of a fall the image before tells, too. Taken for one, the outlier would leave an error of its size, which the next ones cannot
    mend; which way it errs must not matter."""
    sway = swaying(2300)

    def outlier(k, sample):
        if sample["camera_capture"][0] == 2013:
            sample["camera_position"] += sway.view[2013].inv().apply([0.0, 0.0, off])
        return sample

    error = run(sway, tamper=outlier).plate["position"] - sway.plate
    assert np.abs(error[2013:, 2]).max() < 0.5 * abs(off)


def test_begins_anew_where_the_world_has_jumped():
    """The UAV is moved by hand between two images: nothing that the filter knew helps, and it must not insist."""
    sway = swaying()
    for name in ("cm", "plate"):
        getattr(sway, name)[2000:] += [0.15, -0.1, 0.0]
    out = run(sway)
    answers = out.answers[out.answers[:, 0] >= 2070, 1]
    first = int(np.argmax(answers == RESTARTED))
    assert (answers[:first] == GATED).all()
    assert first == RESTART_AFTER - 1
    back = out.answers[out.answers[:, 1] == RESTARTED][0, 0]
    assert not out.plate["valid"][back]
    assert out.plate["valid"][back + 500 :].all()
    assert rms((out.plate["position"] - sway.plate)[back + 500 :]).max() < 4e-3


@pytest.mark.parametrize(("blind_ms", "anew"), [(300, False), (900, True)])
def test_begins_anew_at_rest_where_it_was_blind_for_long(blind_ms, anew):
    """Moved by hand meanwhile: after a long blindness that is no leap, and the velocity is not that of the reckoning."""
    sway = swaying()
    for name in ("cm", "plate"):
        getattr(sway, name)[2000:] += [0.5, 0.0, 0.0]
    out = run(sway, tamper=lambda k, sample: sample if k < 2000 or k >= 2000 + blind_ms else None)
    back = out.answers[out.answers[:, 0] >= 2000 + blind_ms]
    assert (back[0, 1] == RESTARTED) == anew
    if anew:
        np.testing.assert_allclose(out.plate["velocity"][back[0, 0]], 0.0, atol=0.1)
        assert out.memory["leapt"][0] == 0
    assert out.plate["valid"][3700:].all()


def test_what_cannot_be_used_is_refused_and_changes_nothing(flown):
    sway, state = swaying(), flown.memory
    good = image(sway, sway.ticks - 60)
    for name, value in (
        ("position", np.nan),
        ("quat", np.inf),
        ("sigma", 0.0),
        ("capture", sway.ticks + 5),
        ("capture", sway.ticks - RING - 10),
        ("capture", sway.ticks - RING + 10),
    ):
        bad, s = good.copy(), state.copy()
        bad[f"camera_{name}"] = value
        assert fuse(bad[0], flown.parameters[0], s[0]) == UNUSABLE
        assert (s["track"] == state["track"]).all()
    assert fuse(good[0], flown.parameters[0], state.copy()[0]) == FUSED
    assert fuse(good[0], flown.parameters[0], np.zeros(1, kept_layout())[0]) == UNUSABLE


def test_nothing_is_claimed_before_the_first_sample():
    out = run(swaying(100), tamper=lambda k, sample: None)
    assert not out.plate["valid"].any()
    assert np.isinf(out.plate["sigma_position"]).all()


def test_cost_of_a_tick_and_of_a_sample():
    """2 µs and 100 µs, and twice that for a machine that does something else as well."""
    sway = swaying(400)
    out = run(sway)
    sample = image(sway, 340)

    @njit
    def ticks(first, count, m, eye, view, p, s, plate):
        for k in range(first, first + count):
            m[0].tick, m[0].uav_tick = k, (k - 12) // 5 * 5
            advance(m[0], 4.7, eye, (0.0, 0.0, -9.81), eye, view, p[0], s[0])
            predict(0.0, p[0], s[0], plate[0])

    @njit
    def samples(count, sample, p, s):
        fused = 0
        for _ in range(count):
            sample[0].camera_position[0] += 1e-9
            fused += fuse(sample[0], p[0], s[0]) == FUSED
        return fused

    level, still, plate, p, s = (
        np.array([1.0, 0.0, 0.0, 0.0]),
        np.zeros(3),
        np.zeros(1, plate_layout()),
        out.parameters,
        out.memory,
    )
    assert samples(1, sample, p, s) == 1
    cost = _best(lambda: samples(100, sample, p, s)) / 100
    m = np.zeros(1, MESSAGE)
    m["uav_quat"] = level
    ticks(400, 1, m, still, level, p, s, plate)
    start = iter(range(401, 10_000, 100))
    tick = _best(lambda: ticks(next(start), 100, m, still, level, p, s, plate)) / 100
    print(f"tick {1e6 * tick:.2f} µs, sample {1e6 * cost:.2f} µs")
    assert tick < 4e-6
    assert cost < 200e-6


def _best(call, times=20):
    costs = []
    for _ in range(times):
        begin = perf_counter()
        call()
        costs.append(perf_counter() - begin)
    return min(costs)


def test_a_push_that_the_caller_knows_of_is_part_of_the_model():
    """A UAV that an arm accelerates: told of it, the estimate does not lag."""
    speeds = []
    for push in (np.array([2.0, 0.0, 0.0]), STILL):
        p, s, level = settings(), np.zeros(1, kept_layout()), np.array([1.0, 0.0, 0.0, 0.0])
        for k in range(100):
            tick(k, k, level, STILL, MASS * GRAVITY, STILL, level, p, s, push)
        speeds.append(s["track"]["velocity"][0, 99, 0])
    np.testing.assert_allclose(speeds, [2.0 * 0.099, 0.0], atol=1e-12)


def test_p1_is_thrust_along_the_tilted_body_and_apparent_gravity():
    """Tilted by 0.2 rad about y on a deck that accelerates, with the UAV's world turned by 90° against the deck's."""
    p, s = settings(), np.zeros(1, kept_layout())
    s["align"]["quat"] = quats(Rotation.from_euler("z", 90, degrees=True))
    m, gamma = np.zeros(1, MESSAGE), np.array([0.3, -0.2, -10.0])
    m["uav_quat"] = quats(Rotation.from_euler("y", 0.2))
    s["imu_tick"], s["track"]["begun"] = -1, 1
    advance(m[0], 5.0, STILL, tuple(gamma), STILL, m["uav_quat"][0].copy(), p[0], s[0])
    lift = 5.0 / MASS * np.array([0.0, np.sin(0.2), np.cos(0.2)])
    np.testing.assert_allclose(s["track"]["acceleration"][0, 0], lift + gamma, atol=1e-12)


def predicted(flown, horizon, memory=None, **changes):
    """The plate `horizon` s ahead of the flight's end, with some of what the filter is told changed."""
    p, o = flown.parameters.copy(), np.zeros(1, plate_layout())
    for name, value in changes.items():
        p[name] = value
    predict(horizon, p[0], (flown.memory if memory is None else memory)[0], o[0])
    return o[0]


@pytest.fixture
def turning(flown):
    """Memory of the flight's end with rates of 2 rad/s aslant, and all of the alignment known."""
    memory = flown.memory.copy()
    memory["rate"], memory["align"]["P"] = [0.9, -1.2, 1.4], 0.0
    return memory


@pytest.mark.parametrize("ahead", [0.01, 0.02])
def test_p3_predicted_velocity_is_the_rate_of_the_predicted_position(flown, turning, ahead):
    """By differences over the horizon, of a plate that swings about a centre of mass that accelerates."""
    h = 1e-5
    before, after = (predicted(flown, ahead + x, turning) for x in (-h, h))
    here = predicted(flown, ahead, turning)
    np.testing.assert_allclose((after["position"] - before["position"]) / (2.0 * h), here["velocity"], atol=1e-7)
    turn = Rotation.from_quat(before["quat"], scalar_first=True).inv() * Rotation.from_quat(
        after["quat"], scalar_first=True
    )
    np.testing.assert_allclose(turn.as_rotvec() / (2.0 * h), turning["rate"][0], atol=1e-6)
    # The acceleration is held: of the centre of mass the velocity grows by it.
    lever = [
        Rotation.from_quat(x["quat"], scalar_first=True).apply(np.cross(turning["rate"][0], PLATE_OFFSET))
        for x in (before, after)
    ]
    gained = (after["velocity"] - lever[1] - before["velocity"] + lever[0]) / (2.0 * h)
    np.testing.assert_allclose(gained, here["acceleration"], atol=1e-6)


def test_attitude_is_predicted_for_no_longer_than_its_rates_hold(flown, turning):
    """From the tick at which the rates were taken: what is ahead of that is where they have turned it by then."""
    age = int(turning["track"]["tick"][0] - turning["imu_tick"][0])
    left = (int(flown.parameters["hold"][0]) - age) * H
    assert 0.0 < left < 1.0
    at_the_end, later = (predicted(flown, left + x, turning)["quat"] for x in (0.0, 0.3))
    np.testing.assert_allclose(later, at_the_end, atol=1e-12)
    now = Rotation.from_quat(predicted(flown, 0.0, turning)["quat"], scalar_first=True)
    turned = now.inv() * Rotation.from_quat(later, scalar_first=True)
    np.testing.assert_allclose(turned.as_rotvec(), left * turning["rate"][0], atol=1e-9)


def test_errors_of_attitude_and_rate_are_the_plates_by_their_levers(flown, turning):
    """A small turn θ about the marker moves the plate by θ × arm; an error of the rates its velocity by δω × ρ."""
    R = Rotation.from_quat(predicted(flown, 0.0, turning)["quat"], scalar_first=True)
    arm, lever = R.apply(PLATE_OFFSET - MARKER), R.apply(PLATE_OFFSET)
    sure, unsure = (predicted(flown, 0.0, turning, sigma_attitude=s, sigma_rate=0.0) for s in (0.0, 0.1))
    grown = unsure["sigma_position"] ** 2 - sure["sigma_position"] ** 2
    np.testing.assert_allclose(grown, 0.1**2 * (arm @ arm - arm**2), rtol=1e-6)
    np.testing.assert_allclose(unsure["sigma_attitude"], 0.1, rtol=1e-5)
    np.testing.assert_allclose(unsure["sigma_velocity"], sure["sigma_velocity"])
    shaken = predicted(flown, 0.0, turning, sigma_attitude=0.0, sigma_rate=0.5)
    grown = shaken["sigma_velocity"] ** 2 - sure["sigma_velocity"] ** 2
    np.testing.assert_allclose(grown, 0.5**2 * (lever @ lever - lever**2), rtol=1e-6)


def test_alignment_drifts_on_while_no_image_comes_and_over_the_horizon(flown, turning):
    """A random walk: its variance grows by walk² a second since the last image, and as much ahead."""
    turning["align"]["tick"] = turning["track"]["tick"] - 500
    found = [predicted(flown, ahead, turning, sigma_attitude=0.0, align_walk=0.02) for ahead in (0.0, 0.25)]
    np.testing.assert_allclose(found[0]["sigma_attitude"], 0.02 * np.sqrt(0.5))
    np.testing.assert_allclose(found[1]["sigma_attitude"], 0.02 * np.sqrt(0.75))


def test_nothing_is_vouched_for_that_is_less_sharp_than_it_must_be(flown):
    """Each bound on its own, at what the worst axis has."""
    here = predicted(flown, 0.0)
    assert here["valid"] == 1
    for bound, field in (("sigma_position_max", "sigma_position"), ("sigma_velocity_max", "sigma_velocity")):
        worst = here[field].max()
        assert predicted(flown, 0.0, **{bound: 1.01 * worst})["valid"] == 1
        assert predicted(flown, 0.0, **{bound: 0.99 * worst})["valid"] == 0


@pytest.mark.parametrize("clock", ["sample_tick", "imu_tick"])
def test_nothing_is_vouched_for_that_is_older_than_it_may_be(flown, clock):
    most = int(flown.parameters["age_max"][0])
    for age, valid in ((most, 1), (most + 1, 0)):
        memory = flown.memory.copy()
        memory[clock] = memory["track"]["tick"] - age
        found = predicted(flown, 0.0, memory, sigma_position_max=np.inf, sigma_velocity_max=np.inf)
        assert found["valid"] == valid
    if clock == "sample_tick":
        assert found["age"] == pytest.approx((most + 1) * H)


def test_first_sample_knows_the_place_and_hardly_the_motion():
    """Position by the camera alone, speed and bias by their priors, heading by image and gyros together."""
    p, s, level, o = (
        settings(sigma_rate=0.0),
        np.zeros(1, kept_layout()),
        np.array([1.0, 0.0, 0.0, 0.0]),
        np.zeros(1, plate_layout()),
    )
    tick(0, 0, level, STILL, MASS * GRAVITY, STILL, level, p, s)
    sample = np.zeros(1, MESSAGE)
    sample["camera_position"], sample["camera_quat"], sample["camera_sigma"] = [0.1, 0.2, 0.5], quats(FACE), SIGMA
    assert fuse(sample[0], p[0], s[0]) == STARTED
    x, P = present(p[0], s[0])
    np.testing.assert_allclose(x, [*(np.array([0.1, 0.2, 0.5]) - MARKER), *np.zeros(6)], atol=1e-12)
    np.testing.assert_allclose(np.diag(P)[3:6], p["speed_prior"][0] ** 2)
    np.testing.assert_allclose(np.diag(P)[6:], p["bias_prior"][0] ** 2)
    heading = np.hypot(SIGMA[5], p["sigma_attitude"][0])
    np.testing.assert_allclose(np.sqrt(np.diag(s["align"]["P"][0])), [p["tilt_prior"][0], p["tilt_prior"][0], heading])
    # An error of the attitude shows in the centre of mass by the marker's lever.
    by_attitude = np.diag(s["align"]["P"][0]) + p["sigma_attitude"][0] ** 2
    turned = np.array([np.cross(e, MARKER) for e in np.eye(3)])
    np.testing.assert_allclose(np.diag(P)[:3], SIGMA[:3] ** 2 + by_attitude @ turned**2, rtol=1e-9)
    predict(0.0, p[0], s[0], o[0])
    np.testing.assert_allclose(o["sigma_velocity"][0], p["speed_prior"][0])


@pytest.mark.parametrize(("age", "carried"), [(0, 0.0), (20, 0.02), (5000, None)])
def test_first_attitude_that_is_old_is_carried_on_with_its_rates(age, carried):
    """To the first tick, and for no longer than rates hold."""
    p, s, rate = settings(), np.zeros(1, kept_layout()), np.array([0.5, -1.0, 2.0])
    reported = Rotation.from_rotvec([0.1, 0.2, -0.3])
    tick(6000, 6000 - age, quats(reported), rate, MASS * GRAVITY, STILL, np.array([1.0, 0.0, 0.0, 0.0]), p, s)
    carried = p["hold"][0] * H if carried is None else carried
    found = Rotation.from_quat(s["quat"][0, 6000 % RING], scalar_first=True)
    np.testing.assert_allclose((reported.inv() * found).as_rotvec(), carried * rate, atol=1e-9)


def test_attitude_between_samples_turns_on_with_the_rates_until_they_are_too_old():
    p, s, level, rate = (
        settings(hold=30),
        np.zeros(1, kept_layout()),
        np.array([1.0, 0.0, 0.0, 0.0]),
        np.array([0.5, -1.0, 2.0]),
    )
    for k in range(100, 160):
        tick(k, 100, level, rate, MASS * GRAVITY, STILL, level, p, s)
        turned = Rotation.from_quat(s["quat"][0, k], scalar_first=True).as_rotvec()
        np.testing.assert_allclose(turned, min(k - 100, 30) * H * rate, atol=1e-9)
    # Ticks beyond that count as guessed.
    blind = s["track"]["blind"][0]
    assert blind[130] == 0
    assert blind[159] == 29


def learnt_noise(times, samples=4000, seed=2, outliers=0.0):
    """Variance ratios that are learnt of samples whose noise is `times` what is claimed, weighed by what was learnt so far."""
    s, rng, out = np.zeros(1, kept_layout()), np.random.default_rng(seed), []
    s["noise"] = 1.0
    for _ in range(samples):
        squared = float(rng.chisquare(3)) * times**2
        learn_noise((1e6 if rng.random() < outliers else squared) / s["noise"][0], s[0])
        out.append(s["noise"][0])
    return np.array(out)


@pytest.mark.parametrize("times", [1.5, 2.0, 3.0, 5.0])
def test_noise_that_is_more_than_claimed_is_learnt(times):
    """Its variance: E min(χ²₃/3, 4) is 0.99, and what one sample changes scatters the ratio by √(0.05/2 · 2/3) = 13 %."""
    found = np.log(learnt_noise(times)[200:] / times**2)
    assert found.mean() == pytest.approx(0.0, abs=0.05)
    assert found.std() < 0.2


@pytest.mark.parametrize("times", [1.0, 0.5, 0.1])
def test_honest_camera_is_believed_and_one_that_errs_less_gains_nothing(times):
    """Held at 1 from below, the ratio of an honest one wanders by its 13 % above it and no further."""
    found = learnt_noise(times)
    assert found.min() >= 1.0
    assert found.mean() < 1.15
    if times < 1.0:
        assert found[100:].max() < 1.1


def test_outliers_alone_are_not_taken_for_noise():
    """One in 200, however far off, says no more than four times the mean: 1.5 % of the ratio."""
    assert learnt_noise(1.0, outliers=0.005).mean() < 1.2


def test_noise_that_was_learnt_goes_again():
    s = np.zeros(1, kept_layout())
    s["noise"] = 9.0
    for _ in range(60):
        learn_noise(3.0 / 9.0, s[0])
    assert s["noise"] < 1.5


def test_noise_has_a_largest():
    assert learnt_noise(100.0).max() == 400.0


@pytest.mark.parametrize(("times", "low", "high"), [(1.0, 1.0, 1.4), (3.0, 6.0, 11.0)])
def test_filter_learns_of_a_camera_that_claims_too_little(times, low, high):
    """In flight, by what is seen beside what was predicted: its samples are neither gated nor trusted too much."""
    p, s = settings(), np.zeros(1, kept_layout())
    motion, arrivals, ratios, answers = swaying(ticks=12_000), {}, [], []
    for k in range(motion.ticks):
        taken = max(k - 12, 0) // LINK * LINK
        tick(
            k,
            taken,
            motion.report[taken],
            motion.rate[taken],
            motion.thrust[k],
            motion.eye[k],
            motion.view_quat[k],
            p,
            s,
        )
        if k % PERIOD == 0:
            arrivals[k + 60] = image(motion, k, times * SIGMA)
        if k in arrivals:
            answers.append(fuse(arrivals[k][0], p[0], s[0]))
            ratios.append(s["noise"][0])
    assert low <= np.mean(ratios[120:]) <= high
    assert np.mean(np.array(answers[60:]) == FUSED) > 0.97


def gusty(motion, bias=0.0):
    """Share of the thrust that the ground reckons with and the air does not leave as it is, and what accelerometers then feel."""
    t = np.arange(motion.ticks) * H
    wrong = 1.0 + 0.12 * np.sin(2.0 * np.pi * 0.8 * t)
    felt = np.zeros((motion.ticks, 3))
    felt[:, 2] = motion.thrust / MASS
    return wrong, felt + bias + 0.05 * np.random.default_rng(3).normal(size=felt.shape)


def speed_error(motion, **kinds):
    # The same images each time: the motion's own stream goes on from run to run.
    found = run(swaying(), settings(gust_max=kinds.pop("gust_max", 8.0)), **kinds)
    return rms((found.plate["velocity"] - motion.velocity)[1500:])[2]


def test_lift_that_gusts_change_is_known_where_the_uav_says_what_it_feels(motion):
    """Negative controls: not asked, the accelerometers make no difference, and a UAV that sends none is flown without."""
    wrong, felt = gusty(motion)
    without = speed_error(motion, gives=wrong)
    assert speed_error(motion, gives=wrong, force=felt) < 0.4 * without
    assert speed_error(motion, gives=wrong, force=felt, gust_max=0.0) == pytest.approx(without, rel=1e-12)


def test_bias_of_accelerometers_is_found_like_a_steady_disturbance(motion):
    """50 mg of each axis make no more than a tenth of what the gusts would."""
    wrong, felt = gusty(motion, bias=0.5)
    assert speed_error(motion, gives=wrong, force=felt) < 0.45 * speed_error(motion, gives=wrong)


def test_accelerometers_that_read_nonsense_are_believed_within_a_bound(motion):
    _, felt = gusty(motion)
    p = settings(gust_max=8.0)
    found = run(motion, p, force=felt + [0.0, 0.0, 500.0])
    assert np.abs(found.memory["gust"]).max() <= 8.0


def test_what_is_felt_is_part_of_the_disturbance_that_is_cancelled(motion):
    wrong, felt = gusty(motion)
    found = run(motion, settings(gust_max=8.0), gives=wrong, force=felt)
    missed = motion.thrust * (1.0 - wrong) / MASS
    upwards = found.plate["bias"][1500:, 2]
    assert np.corrcoef(upwards, missed[1500:])[0, 1] > 0.97
