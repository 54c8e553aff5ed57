"""A signal and its derivatives from its samples (D.1)."""

import numpy as np
from scipy.signal import lfilter

from armland.estimation.tracking import begin, kept_layout, steady_gains, track

PERIOD_S = 0.01


def tracked(samples, gains):
    """Value, first and second derivative (k, 3) after each sample."""
    s, rows = np.zeros(1, kept_layout()), []
    begin(np.full(3, samples[0]), s[0])
    for z in samples[1:]:
        track(np.full(3, z), PERIOD_S, gains, s[0])
        rows.append([s["value"][0, 1], s["first"][0, 1], s["second"][0, 1]])
    return np.array(rows)


def test_d1_parabola_is_followed_without_being_late():
    """Closed form: of z = 1 + 2t + 3t² all three are known exactly in the end; differences behind a low pass are late for ever."""
    t, gains = PERIOD_S * np.arange(300), steady_gains(PERIOD_S, 300.0, 1e-3)
    rows, now = tracked(1.0 + 2.0 * t + 3.0 * t**2, gains), t[-1]
    np.testing.assert_allclose(rows[-1], [1.0 + 2.0 * now + 3.0 * now**2, 2.0 + 6.0 * now, 6.0], rtol=1e-6)


def test_d1_gains_are_those_of_the_kalman_filter_at_rest():
    """The oracle is the filter itself, its covariance carried on from sample to sample until it rests."""
    t, q, sigma = PERIOD_S, 300.0, 1.2e-3
    F = np.array([[1.0, t, 0.5 * t * t], [0.0, 1.0, t], [0.0, 0.0, 1.0]])
    steps = 200
    # ∫ Φ(τ) e₃ e₃ᵀ Φ(τ)ᵀ dτ by the midpoint rule.
    tau = (np.arange(steps) + 0.5) * t / steps
    kick = np.stack([0.5 * tau**2, tau, np.ones(steps)])
    Q, P = q * kick @ kick.T * t / steps, np.eye(3)
    for _ in range(3000):
        P = F @ P @ F.T + Q
        k = P[:, 0] / (P[0, 0] + sigma**2)
        P = P - np.outer(k, P[0])
    np.testing.assert_allclose(steady_gains(t, q, sigma), k, rtol=1e-4)


def test_swing_of_half_a_second_is_known_where_differences_behind_a_low_pass_are_late():
    """At 10 rad/s and with the noise of a motion reference the derivative errs by less than a fifth of itself; differences
    behind 30 ms, whose noise is no smaller, by more than a quarter."""
    rng, t, omega, noise = np.random.default_rng(1), PERIOD_S * np.arange(2000), 10.0, np.deg2rad(0.07)
    z = 0.12 * np.sin(omega * t) + noise * rng.standard_normal(len(t))
    gain = PERIOD_S / (0.03 + PERIOD_S)
    ways = {
        "tracked": tracked(z, steady_gains(PERIOD_S, 300.0, noise))[:, 1],
        "late": lfilter([gain], [1.0, gain - 1.0], np.diff(z) / PERIOD_S),
    }
    rate = 0.12 * omega * np.cos(omega * t[1:])
    error = {way: np.std((found - rate)[200:]) / np.std(rate) for way, found in ways.items()}
    assert error["tracked"] < 0.2
    assert error["late"] > 0.25
