"""Gusts and recorded wind at the ticks of a run: their shape, and no energy that was not there."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armland.plant.wind.profile import passing_speed
from armland.plant.wind.timed import gust_speed, resampled, timed_wind
from armland.scenario.environment import Gust


def test_gust_rises_and_falls_as_one_minus_cosine():
    """Nothing before and after, half the peak at a quarter, the peak in the middle; l/V s long, ½A l/V m of air in all."""
    gust, times = Gust(at_s=2.0, peak_mps=6.0, length_m=10.0), np.arange(0.0, 6.0, 1e-3)
    speed = gust_speed(gust, times, 5.0)
    at = dict(zip(times.round(3), speed, strict=True))
    assert [at[t] for t in (1.0, 2.0, 4.0, 5.0)] == pytest.approx([0.0, 0.0, 0.0, 0.0], abs=1e-12)
    assert [at[t] for t in (2.5, 3.0, 3.5)] == pytest.approx([3.0, 6.0, 3.0])
    assert speed.sum() * 1e-3 == pytest.approx(0.5 * 6.0 * 10.0 / 5.0, rel=1e-6)
    # It begins and ends without a kink.
    assert np.abs(np.diff(speed)).max() <= 6.0 * np.pi / 2.0 * 1e-3


@pytest.mark.parametrize(
    ("direction", "way"), [(None, [0, 1, 0]), ([0.0, 0.0, 0.5], [0, 0, 1]), ([-0.3, 0.0, 0.0], [-1, 0, 0])]
)
def test_gust_pushes_its_own_way_or_along_the_wind(landing, direction, way):
    gust = {"at_s": 1.0, "peak_mps": 4.0, "length_m": 5.0, "direction": direction}
    s = landing(air={"wind_mps": 6.0, "towards_deg": 90.0, "gusts": [gust]})
    wind = timed_wind(s)
    assert len(wind) == s.run.duration_s * s.run.rate_hz
    peak = round(1000 * (1.0 + 2.5 / passing_speed(s)))
    np.testing.assert_allclose(wind[peak], 4.0 * np.array(way), atol=1e-3)
    np.testing.assert_array_equal(wind[:1001], 0.0)


def test_gusts_and_trace_add_up(landing, tmp_path):
    file = tmp_path / "wind.csv"
    file.write_text("time_s,x,y,z\n" + "".join(f"{100 + t},{t},0.5,-0.1\n" for t in range(50)))
    gust = {"at_s": 0.0, "peak_mps": 4.0, "length_m": 2.0, "direction": [0.0, 0.0, 1.0]}
    s = landing(air={"trace": str(file), "gusts": [gust]})
    wind = timed_wind(s)
    # Tick k has the mean over [k, k + 1] ms; the trace begins when the run does.
    np.testing.assert_allclose(wind[:, 0], (np.arange(len(wind)) + 0.5) * 1e-3, rtol=1e-9)
    assert wind[1000, 2] == pytest.approx(4.0 - 0.1)
    assert len(timed_wind(landing())) == 0


def samples(seed, k):
    generator = np.random.default_rng(seed)
    times = np.concatenate([[0.0], np.cumsum(generator.uniform(0.5, 2.0, k - 1))])
    return times, generator.standard_normal((k, 3))


@given(st.integers(0, 10_000), st.integers(5, 60), st.integers(2, 300))
def test_resampling_keeps_the_mean_and_never_adds_energy(seed, k, ticks):
    times, values = samples(seed, k)
    out = resampled(times, values, np.linspace(0.0, times[-1], ticks + 1))
    steps = np.diff(times)[:, None]
    mean = (0.5 * steps * (values[1:] + values[:-1])).sum(axis=0) / times[-1]
    np.testing.assert_allclose(out.mean(axis=0), mean, atol=1e-12)
    assert (out <= values.max(axis=0) + 1e-12).all()
    assert (out >= values.min(axis=0) - 1e-12).all()
    # Power of the samples, each for the time around it.
    power = (0.5 * steps * (values[1:] ** 2 + values[:-1] ** 2)).sum(axis=0) / times[-1]
    assert ((out**2).mean(axis=0) <= power + 1e-12).all()


def test_slow_wind_passes_and_what_is_faster_than_a_tick_is_averaged():
    """A sine of 1 Hz at 10 Hz keeps its size within the 3.3 % of straight lines; one of 1 kHz at 16 kHz, which single samples at
    1 kHz would show as a steady wind, is gone."""
    edges = np.arange(1001) * 1e-3
    slow, fast = np.arange(0.0, 1.05, 0.1), np.arange(0.0, 1.0001, 1.0 / 16000.0)
    wave = resampled(slow, np.cos(2.0 * np.pi * slow)[:, None] * np.ones(3), edges)[:, 0]
    assert np.std(wave) == pytest.approx(np.sqrt(0.5), rel=0.05)
    assert np.std(wave) < np.sqrt(0.5)
    steady = np.cos(2.0 * np.pi * 1000.0 * fast)[:, None] * np.ones(3)
    np.testing.assert_allclose(steady[::16], 1.0, atol=1e-9)
    np.testing.assert_allclose(resampled(fast, steady, edges[:-1]), 0.0, atol=1e-9)
