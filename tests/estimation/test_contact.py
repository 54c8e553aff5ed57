"""Contact and load transfer: false alarms and delays measured under the sensor's noise, and simple scenes with known answers."""

import numpy as np
import pytest
from numba import njit
from scipy.special import gammaincc, gammainccinv

from armland.estimation.contact import detect, kept_layout, load_layout, told
from armland.scenario import load_scenario
from armland.scenario.estimation import ContactDetection, Switching

H, WEIGHT = 1e-3, 0.480 * 9.81
# A more sensitive contact than the landing's, so that its noise matters.
SETTINGS = ContactDetection(contact_n=Switching(on=0.6, off=0.3, on_s=0.005, off_s=0.10))
SIGMA, FILTER = 0.05, 1.0 - np.exp(-2.0 * np.pi * 0.1)  # N white; the sensor's 100 Hz low pass at 1 kHz
FIELDS = ("arm_share", "rotor_share", "ground_share", "contact", "touchdown", "resting", "released")


@njit
def observed(force, thrust, magnet, retreat, p, s, load):
    out = np.empty((len(force), 7))
    for k in range(len(force)):
        detect(force[k], thrust[k], WEIGHT, magnet[k], retreat[k], p[0], s[0], load[0])
        o = load[0]
        out[k, 0], out[k, 1], out[k, 2] = o.arm_share, o.rotor_share, o.ground_share
        out[k, 3], out[k, 4], out[k, 5], out[k, 6] = o.contact, o.touchdown, o.resting, o.released
    return out


@njit
def low_passed(white, gain):
    out = white.copy()
    for k in range(1, len(white)):
        for i in range(white.shape[1]):
            out[k, i] = out[k - 1, i] + gain * (white[k, i] - out[k - 1, i])
    return out


def watch(force, thrust=0.0, magnet=True, retreat=0.0, settings=SETTINGS, noise=1.0, seed=1, gain=FILTER):
    """Columns by name. `force` (ticks, 3) or (ticks,) along z, before the sensor's low pass; the rest scalar or (ticks,)."""
    force = np.asarray(force, float)
    if force.ndim == 1:
        force = np.column_stack([np.zeros((len(force), 2)), force])
    white = noise * SIGMA * np.random.default_rng(seed).standard_normal(force.shape)
    ticks = len(force)
    series = [
        np.broadcast_to(np.asarray(a, d), ticks).copy() for a, d in ((thrust, float), (magnet, bool), (retreat, float))
    ]
    # `model_dump` gives tables, as a scenario's file has them.
    p = told(load_scenario("landing", {"estimation": {"contact": settings.model_dump()}}))
    out = observed(low_passed(force + white, gain), *series, p, np.zeros(1, kept_layout()), np.zeros(1, load_layout()))
    return dict(zip(FIELDS, out.T, strict=True))


def with_contact(on, off, on_s, off_s):
    return SETTINGS.model_copy(update={"contact_n": Switching(on=on, off=off, on_s=on_s, off_s=off_s)})


def rises(flag):
    return np.flatnonzero(np.diff(flag, prepend=0.0) > 0.5)


def step(size, at=1000, ticks=2000):
    return np.where(np.arange(ticks) >= at, size, 0.0)


def test_no_false_contact_in_a_quarter_of_an_hour_of_noise():
    assert len(rises(watch(np.zeros(900_000))["contact"])) == 0


@pytest.mark.parametrize(("gain", "on_s"), [(1.0, 0.0), (FILTER, 0.0), (FILTER, 0.003)])
def test_false_alarms_stay_below_the_bound(gain, on_s):
    """At a threshold so low that they can be counted. The bound is nearly met by white noise and no debouncing."""
    sigma = SIGMA * np.sqrt(gain / (2.0 - gain))
    threshold = sigma * np.sqrt(2.0 * gammainccinv(1.5, 2.0 * H))
    settings = with_contact(threshold, 0.99 * threshold, on_s, 0.0)
    alarms = len(rises(watch(np.zeros(300_000), settings=settings, gain=gain)["contact"])) / 300.0
    # P(χ₃ > threshold/σ) a tick.
    bound = gammaincc(1.5, 0.5 * (threshold / sigma) ** 2) / H
    assert bound == pytest.approx(2.0)
    assert alarms < bound * (1.0 + 4.0 / np.sqrt(600.0))
    if gain == 1.0:
        assert alarms > 0.8 * bound
    elif on_s > 0.0:
        # Debouncing is what it is for.
        assert alarms < 0.3 * bound


@pytest.mark.parametrize(("size", "slowest_ms"), [(0.8, 8), (1.5, 6), (5.0, 5)])
def test_contact_is_noticed_within_milliseconds(size, slowest_ms):
    delays = [rises(watch(step(size), seed=seed)["contact"])[0] - 1000 for seed in range(100)]
    assert min(delays) >= 4
    assert max(delays) <= slowest_ms
    assert len(rises(watch(step(0.3))["contact"])) == 0


@pytest.mark.parametrize(("on_s", "hysteresis"), [(0.005, True), (0.005, False), (0.0, False)])
def test_hysteresis_and_debouncing_spare_the_chatter(on_s, hysteresis):
    """A force that creeps over the threshold within 20 s under noise."""
    on = 0.6
    settings = with_contact(on, 0.3 if hysteresis else on - 1e-9, on_s, 0.10 if hysteresis else on_s)
    found = rises(watch(np.linspace(0.4, 0.8, 20_000), settings=settings)["contact"])
    assert len(found) == 1 if hysteresis else len(found) > 5


def test_direction_of_the_force_does_not_matter_for_contact():
    for direction in ([1.0, 0.0, 0.0], [0.0, 0.6, 0.8], [0.0, 0.0, -1.0]):
        force = np.outer(step(1.0), direction)
        assert len(rises(watch(force)["contact"])) == 1


def test_shares_add_up_where_the_uav_is_at_rest():
    ticks = 3000
    arm, rotors = np.linspace(0.0, 0.7, ticks), np.linspace(1.0, 0.2, ticks)
    seen = watch(arm * WEIGHT, thrust=rotors * WEIGHT, noise=0.0)
    lag = SETTINGS.share_s / H
    np.testing.assert_allclose(seen["arm_share"][500:], (arm - lag * 0.7 / ticks)[500:], atol=2e-3)
    np.testing.assert_allclose(seen["rotor_share"][500:], (rotors + lag * 0.8 / ticks)[500:], atol=2e-3)
    np.testing.assert_allclose(seen["ground_share"], 1.0 - seen["arm_share"] - seen["rotor_share"], atol=1e-12)
    assert watch(np.full(10, WEIGHT), noise=0.0)["arm_share"][0] == pytest.approx(1.0)


def set_down(speed=0.05, stiffness=2000.0, ticks=4000, arm_stiffness=500.0, rotors=0.08):
    """The arm lowers the UAV onto springy rails at 2 s: the force of the arm, by statics of two springs in series."""
    t = np.arange(ticks) * H
    below = np.maximum(t - 2.0, 0.0) * speed  # how far the arm's set-point is below the rails
    rails = np.minimum(stiffness * arm_stiffness / (stiffness + arm_stiffness) * below, (1.0 - rotors) * WEIGHT)
    return (1.0 - rotors) * WEIGHT - rails, rails / WEIGHT


def test_touchdown_and_rest_are_noticed_soon_after_they_happen():
    force, rails = set_down()
    begun, done = np.argmax(rails > SETTINGS.touchdown.on), np.argmax(rails > SETTINGS.resting.on)
    late = []
    for seed in range(40):
        seen = watch(force, thrust=0.08 * WEIGHT, seed=seed)
        late.append([rises(seen["touchdown"]) - begun, rises(seen["resting"]) - done])
        assert [len(a) for a in late[-1]] == [1, 1]
    late = np.array(late)[:, :, 0]
    assert late.min() > 20
    assert (late.max(axis=0) < [90, 160]).all()
    # Control: in the air nothing of the kind is seen, not even with the arm swaying the UAV at 0.5 m/s² and 2 Hz.
    sway = 0.48 * 0.5 * np.sin(2.0 * np.pi * 2.0 * np.arange(20_000) * H)
    assert not watch(0.92 * WEIGHT + sway, thrust=0.08 * WEIGHT)["touchdown"].any()
    # 2 m/s² downwards for longer than the debouncing is beyond what the shares can tell from rails.
    fall = np.where((np.arange(2000) >= 1000) & (np.arange(2000) < 1100), -0.48 * 2.0, 0.0)
    assert watch(0.92 * WEIGHT + fall, thrust=0.08 * WEIGHT)["touchdown"].any()


def test_release_needs_the_way_back_and_no_force():
    ticks = 2000
    off = np.arange(ticks) < 500
    back = np.maximum(np.arange(ticks) - 600, 0) * 1e-4  # 0.1 m/s from 0.6 s on, clear at 0.7 s
    free = watch(np.zeros(ticks), magnet=off, retreat=back)["released"]
    assert len(rises(free)) == 1
    assert rises(free)[0] == pytest.approx(700 + SETTINGS.release_n.off_s / H, abs=3)
    # A UAV that hovers on the magnet pulls at nothing either; nor does one on a magnet that is off but still touches.
    assert not watch(np.zeros(ticks), magnet=True, retreat=back)["released"].any()
    assert not watch(np.zeros(ticks), magnet=off, retreat=0.0)["released"].any()
    # A magnet that sticks pulls on the way back.
    sticking = np.where(np.arange(ticks) >= 600, -0.9, 0.0)
    assert not watch(sticking, magnet=off, retreat=back)["released"].any()
    gone = np.where((np.arange(ticks) >= 600) & (np.arange(ticks) < 1200), -0.9, 0.0)
    assert rises(watch(gone, magnet=off, retreat=back)["released"])[0] > 1200
