"""The late-fusion filter against batch least squares, tick-by-tick integration and a matrix exponential."""

import numpy as np
import pytest
from scipy.linalg import expm

from armland.estimation.plate.late_fusion import (
    MARKS,
    RING,
    TRACK,
    Noise,
    carry,
    correct,
    insert,
    place,
    reckon,
    replay,
    spread,
)

H = 1e-3
NOISE = Noise(white=0.05, blind=0.5, walk=0.4)


def accelerations(ticks, seed=0):
    t = np.arange(ticks)[:, None] * H
    return np.random.default_rng(seed).normal(size=3) * np.sin(2.0 * np.pi * t * [0.7, 1.1, 0.4]) + [0.1, -0.2, 0.3]


def rings(a, ticks, first=0, guessed=lambda k: False):
    track = np.zeros(1, TRACK)
    for k in range(first, first + ticks):
        reckon(track[0], k, a[k - first], guessed(k), H)
    return track


def begin(track, tick, x, P):
    return insert(track[0], track["marks"][0], tick, x, P, np.zeros(3), np.eye(3), False)


def fuse(track, tick, z, R, gate=np.inf):
    s = track[0]
    at = place(s, tick)
    assert at > 0
    x, P = carry(s, s["mark"][at - 1], tick, NOISE, H)
    distance = correct(x, P, z, R, gate)
    replay(s, insert(s, at, tick, x, P, z, R, True), NOISE, H)
    return distance


def newest(track, tick):
    s = track[0]
    return carry(s, s["mark"][s["marks"] - 1], tick, NOISE, H)


def van_loan(tau, white, walk):
    """Transition and process noise of one axis over τ, from the continuous model by one matrix exponential."""
    F = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    block = np.zeros((6, 6))
    block[:3, :3], block[:3, 3:], block[3:, 3:] = -F, np.diag([0.0, white**2, walk**2]), F.T
    E = expm(block * tau)
    A = E[3:, 3:].T
    return A, A @ E[:3, 3:]


def random_covariance(rng, scale=(1e-3, 1e-2, 0.3)):
    B = rng.normal(size=(9, 9)) * np.repeat(scale, 3)[:, None]
    return B @ B.T


@pytest.mark.parametrize("first", [0, 5000])
def test_mean_is_carried_as_tick_by_tick_integration_would(first):
    a, rng = accelerations(400), np.random.default_rng(1)
    track, x = rings(a, 400, first), rng.normal(size=9)
    begin(track, first + 37, x, np.eye(9))
    p, v, b = x[:3].copy(), x[3:6].copy(), x[6:]
    for k in range(37, 399):
        p, v = p + v * H + 0.5 * (a[k] + b) * H * H, v + (a[k] + b) * H
    carried, _ = newest(track, first + 399)
    np.testing.assert_allclose(carried, np.concatenate((p, v, b)), atol=1e-12)


@pytest.mark.parametrize("tau", [0.0, 0.001, 0.07, 1.5])
def test_covariance_spreads_as_the_matrix_exponential_says(tau):
    P = random_covariance(np.random.default_rng(2))
    A, Q = van_loan(tau, NOISE.white, NOISE.walk)
    A, Q = np.kron(A, np.eye(3)), np.kron(Q, np.eye(3))
    expected = A @ P @ A.T + Q
    spread(P, tau, NOISE.white, NOISE.walk)
    np.testing.assert_allclose(P, expected, rtol=1e-9, atol=1e-15)


def test_correction_is_the_textbook_update():
    rng = np.random.default_rng(3)
    x, P, z = rng.normal(size=9), random_covariance(rng), rng.normal(size=3)
    R = np.diag([1e-6, 2e-6, 4e-6])
    H3 = np.eye(3, 9)
    S = H3 @ P @ H3.T + R
    # Information form: an algebra of its own.
    information = np.linalg.inv(P) + H3.T @ np.linalg.inv(R) @ H3
    mean = np.linalg.solve(information, np.linalg.solve(P, x) + H3.T @ np.linalg.solve(R, z))
    distance = (z - x[:3]) @ np.linalg.solve(S, z - x[:3])
    assert correct(x, P, z, R, np.inf) == pytest.approx(distance)
    np.testing.assert_allclose(x, mean, atol=1e-9)
    np.testing.assert_allclose(P, np.linalg.inv(information), atol=1e-10)
    np.testing.assert_allclose(P, P.T, atol=1e-18)


def test_gated_sample_changes_nothing():
    x, P = np.zeros(9), np.eye(9)
    distance = correct(x, P, np.array([10.0, 0.0, 0.0]), np.eye(3), 16.0)
    assert distance == pytest.approx(50.0)
    np.testing.assert_array_equal(x, np.zeros(9))
    np.testing.assert_array_equal(P, np.eye(9))


def smoothed(track, ticks, samples, R, x0, P0, last):
    """Batch least squares over all samples and all states at once, axis by axis; estimate and covariance at `last`."""
    knots = [0, *ticks, last]
    V, S = track["velocity"][0], track["displacement"][0]
    x, P = np.zeros(9), np.zeros((9, 9))
    for axis in range(3):
        rows, right = [], []

        def add(blocks, value, weight, rows=rows, right=right):
            row = np.zeros((len(value), 3 * len(knots)))
            for k, B in blocks:
                row[:, 3 * k : 3 * k + 3] = B
            rows.append(weight @ row)
            right.append(weight @ value)

        prior = slice(axis, 9, 3)
        add([(0, np.eye(3))], x0[prior], np.linalg.inv(np.linalg.cholesky(P0[prior, prior])))
        for k in range(1, len(knots)):
            before, after = knots[k - 1], knots[k]
            tau = (after - before) * H
            if tau == 0.0:
                add([(k - 1, np.eye(3)), (k, -np.eye(3))], np.zeros(3), 1e9 * np.eye(3))
                continue
            A, Q = van_loan(tau, NOISE.white, NOISE.walk)
            gone = [S[after, axis] - S[before, axis] - V[before, axis] * tau, V[after, axis] - V[before, axis], 0.0]
            add([(k - 1, -A), (k, np.eye(3))], np.array(gone), np.linalg.inv(np.linalg.cholesky(Q)))
        for k, z in enumerate(samples):
            add([(1 + k, np.eye(1, 3))], z[axis : axis + 1], np.array([[1.0 / np.sqrt(R[axis, axis])]]))
        A, y = np.vstack(rows), np.concatenate(right)
        information = A.T @ A
        x[prior] = np.linalg.solve(information, A.T @ y)[-3:]
        P[prior, prior] = np.linalg.inv(information)[-3:, -3:]
    return x, P


def late_run(order):
    """Thirty samples, arriving in `order` within groups of four, against the ring of 1000 ticks."""
    rng, a = np.random.default_rng(4), accelerations(1000)
    track, R = rings(a, 1000), np.diag([0.4e-3, 0.5e-3, 1.2e-3]) ** 2
    x0, P0 = np.zeros(9), np.diag(np.repeat([0.1, 1.0, 2.0], 3)) ** 2
    begin(track, 0, x0, P0)
    ticks = np.arange(30) * 33 + 3
    truth = track["displacement"][0][ticks] + 0.02
    samples = truth + rng.normal(size=(30, 3)) * np.sqrt(np.diag(R))
    for group in np.split(np.arange(30), range(4, 30, 4)):
        for k in group[np.argsort([order[j % 4] for j in range(len(group))], kind="stable")]:
            fuse(track, ticks[k], samples[k], R)
    return track, ticks, samples, R, x0, P0


@pytest.mark.parametrize("order", [(0, 1, 2, 3), (3, 1, 2, 0), (1, 0, 3, 2)])
def test_late_and_disordered_samples_give_what_batch_least_squares_gives(order):
    track, *rest = late_run(order)
    x, P = newest(track, 999)
    expected, covariance = smoothed(track, *rest, 999)
    np.testing.assert_allclose(x, expected, atol=2e-7)
    np.testing.assert_allclose(P, covariance, rtol=1e-4, atol=1e-9)


def test_samples_taken_for_current_ones_do_not():
    """Control: the same samples fused 60 ticks too late are off by far more than the filter says."""
    track, ticks, samples, R, x0, P0 = late_run((0, 1, 2, 3))
    naive = rings(accelerations(1000), 1000)
    begin(naive, 0, x0, P0)
    for tick, z in zip(ticks[:-2], samples, strict=False):
        fuse(naive, tick + 60, z, R)
    x, P = newest(naive, 999)
    expected, _ = newest(track, 999)
    assert np.abs((x - expected)[:3] / np.sqrt(np.diag(P)[:3])).max() > 5.0


def test_an_acceleration_that_comes_late_is_as_good_as_one_in_time():
    a = accelerations(300)
    prompt, late = rings(a, 300), rings(np.zeros((300, 3)), 300)
    for k in range(100, 300):
        reckon(prompt[0], k, a[k], False, H)
    for k in range(300):
        reckon(late[0], k, a[k], False, H)
    for track in (prompt, late):
        begin(track, 10, np.zeros(9), np.eye(9))
    np.testing.assert_array_equal(newest(late, 299)[0], newest(prompt, 299)[0])
    assert late["tick"][0] == 299


def test_guessed_accelerations_cost_certainty_only_where_they_act():
    a = accelerations(300)
    for guessed, blind in ((lambda k: False, False), (lambda k: k == 200, True), (lambda k: k == 50, False)):
        track = rings(a, 300, guessed=guessed)
        begin(track, 100, np.zeros(9), np.zeros((9, 9)))
        _, P = newest(track, 299)
        _, Q = van_loan(0.199, NOISE.blind if blind else NOISE.white, NOISE.walk)
        np.testing.assert_allclose(np.diag(P)[::3], np.diag(Q), rtol=1e-9)


def test_oldest_marks_make_room_and_order_is_kept():
    track = rings(accelerations(600), 600)
    for k in range(MARKS + 3):
        begin(track, 40 * k, np.full(9, float(k)), np.eye(9))
    np.testing.assert_array_equal(track["mark"][0]["tick"], 40 * np.arange(3, MARKS + 3))
    at = place(track[0], 250)
    assert at == 4
    assert insert(track[0], at, 250, np.zeros(9), np.eye(9), np.zeros(3), np.eye(3), True) == 3
    assert (np.diff(track["mark"][0]["tick"]) > 0).all()
    assert track["mark"][0]["tick"][3] == 250
    assert place(track[0], 100) == 0


def test_ring_holds_what_it_says():
    ticks = RING + 500
    a = accelerations(ticks)
    track = rings(a, ticks)
    begin(track, ticks - RING, np.zeros(9), np.eye(9))
    p, v = np.zeros(3), np.zeros(3)
    for k in range(ticks - RING, ticks - 1):
        p, v = p + v * H + 0.5 * a[k] * H * H, v + a[k] * H
    np.testing.assert_allclose(newest(track, ticks - 1)[0][:3], p, atol=1e-10)
