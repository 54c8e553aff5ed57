"""The link: exact delays, lateness and loss up and down, and what a silent link leaves."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.plant.devices.link import _lost


@pytest.mark.parametrize("delay", [0, 1, 12, 1023])
def test_downlink_brings_the_sample_of_exactly_that_many_ticks_ago(bench, delay):
    b = bench(link={"downlink_delay_ms": float(delay)})
    for k in range(1100):
        b.put("gyro", [float(k)] * 3)
        m = b.read(k)
        if k >= delay:
            assert m["uav_rate"][0, 0] == k - delay
            assert m["uav_tick"] == k - delay


def test_downlink_at_a_lower_rate_repeats_the_last_sample(bench):
    """200 Hz and 12 ms: at tick k the sample of tick 5⌊(k − 12)/5⌋ is the newest."""
    b = bench(link={"downlink_delay_ms": 12.0, "rate_hz": 200})
    taken = [b.read(k)["uav_tick"].item() for k in range(200)]
    k = np.arange(12, 200)
    np.testing.assert_array_equal(taken[12:], 5 * ((k - 12) // 5))


@pytest.mark.parametrize("delay", [0, 1, 25, 1023])
def test_uplink_acts_exactly_that_many_ticks_later(bench, delay):
    """The thrust of tick k is 2 N + k mN; before anything has arrived the rotors turn as they did."""
    b = bench(link={"uplink_delay_ms": float(delay)})
    rest = b.sim.scenario.control.thrust_n
    for k in range(1100):
        lift = b.act(k, thrust=2.0 + 1e-3 * k)[2]
        assert lift == pytest.approx(2.0 + 1e-3 * (k - delay) if k >= delay else rest, abs=1e-9)


def thrusts(b, ticks=2000):
    return np.round(1e3 * (np.array([b.act(k, noise=None, thrust=2.0 + 1e-3 * k)[2] for k in range(ticks)]) - 2.0))


def with_noise(b):
    rng = np.random.default_rng(4)
    b.fill = lambda noise: b.sim.noise.link.__setitem__(slice(None), rng.standard_normal(b.sim.noise.link.shape))
    return b


def test_lateness_scatters_within_its_bound_and_nothing_overtakes(bench):
    b = with_noise(bench(link={"uplink_delay_ms": 10.0}))
    b.told["link"]["jitter_up"] = 20
    sent = thrusts(b)[100:]
    late = np.arange(100, 2000) - sent
    assert late.min() == 10
    # What is late is passed by the next, so the age in use is mostly short.
    assert 20 < late.max() <= 31
    assert (np.diff(sent) >= 0).all()


def test_lost_messages_are_as_many_as_stated(bench):
    b = with_noise(bench())
    b.told["link"]["loss_up"] = 0.3
    sent = thrusts(b)[1:]
    assert np.mean(sent != np.arange(1, 2000)) == pytest.approx(0.3, abs=0.04)


def test_downlink_loses_and_is_late_on_its_own(bench):
    b = with_noise(bench())
    b.told["link"]["loss_down"], b.told["link"]["jitter_down"] = 0.3, 3
    age = np.array([k - b.read(k, None)["uav_tick"].item() for k in range(2000)])
    assert (age == 0).mean() < 0.3
    assert age.max() > 3
    # Upwards nothing is lost.
    np.testing.assert_array_equal(thrusts(b, 100)[1:], np.arange(1, 100))


def test_samples_and_messages_say_their_ticks(bench):
    b = bench(link={"uplink_delay_ms": 25.0, "downlink_delay_ms": 12.0})
    for k in range(300):
        m = b.read(k)
        b.act(k)
    assert m["uav_tick"] == 299 - 12
    # The newest command had reached it in the tick before the sample was taken.
    assert m["uav_heard"] == 299 - 13


def test_delay_beyond_the_delay_line_is_refused(bench):
    with pytest.raises(ConfigurationError, match=r"link\.uplink_delay_ms = 2000 ms is too long.* 1023 ms"):
        bench(link={"uplink_delay_ms": 2000.0})


@pytest.mark.parametrize(("loss", "burst"), [(0.05, 0.0), (0.05, 0.5), (0.3, 0.8)])
def test_losses_come_as_often_and_as_correlated_as_stated(loss, burst):
    """A chain of two states: mean p, correlation ρ from one to the next; its mean errs by √(p q (1 + ρ)/(1 − ρ)/N)."""
    normal = np.random.default_rng(3).standard_normal(40_000)
    lost, before = np.empty(normal.size), 0
    for k, x in enumerate(normal):
        before = _lost(loss, burst, before, x)
        lost[k] = before
    error = np.sqrt(loss * (1.0 - loss) * (1.0 + burst) / (1.0 - burst) / normal.size)
    assert lost.mean() == pytest.approx(loss, abs=4.0 * error)
    assert np.corrcoef(lost[1:], lost[:-1])[0, 1] == pytest.approx(burst, abs=4.0 / np.sqrt(normal.size * loss))


def test_stamp_of_a_uav_whose_clock_is_late_is_late(bench):
    b = bench(link={"downlink_delay_ms": 10.0})
    b.told["link"]["stamp"] = 4
    assert [b.read(k)["uav_tick"].item() for k in range(50)][-1] == 49 - 10 + 4


def test_sample_says_what_was_asked_of_the_rotors_and_which_command_was_heard(bench):
    """The echo is the tick at which the newest command on board was sent: what the ground learns the delay of."""
    b = bench(link={"uplink_delay_ms": 7.0, "downlink_delay_ms": 3.0})
    for k in range(40):
        m = b.read(k)
        b.act(k)
    # The sample of tick 36 was taken before that tick's command arrived.
    assert m["uav_tick"] == 36
    assert m["uav_echo"] == 35 - 7
    np.testing.assert_allclose(m["uav_rotors"][0].sum(), b.sim.scenario.control.thrust_n)
    assert m["uav_weak"] == 0
