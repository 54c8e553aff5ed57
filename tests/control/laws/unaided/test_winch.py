"""A winch against a spring and a mass: it keeps a tension, reels in at a speed, and keeps its limits."""

import pytest

from armland.control.laws.unaided.winch import reel

LIMITS = (0.5, 2.0, 20.0)
TICK = 1e-3


def led(asked, rate, limits=LIMITS, thrust=1.2, seconds=3.0, deck=lambda t: 0.0):
    """A UAV of 0.48 kg that thrusts upwards against the rope, a spring of 3000 N/m; tension, height and speed of the UAV."""
    height, v, length, w, tension, out = 0.5, 0.0, 0.5, 0.0, 0.0, []
    for k in range(round(seconds / TICK)):
        w = reel(w, tension, asked, rate, limits, TICK)
        length -= w * TICK
        stretch = height - deck(k * TICK) - length
        tension = max(3000.0 * stretch + 8.0 * (v + w), 0.0) if stretch > 0.0 else 0.0
        v += (thrust - tension) / 0.48 * TICK
        height += v * TICK
        out.append((tension, height, v))
    return out


def test_eq_t2_keeps_the_tension():
    # Rope and winch swing a little; thrust and tension agree on the mean.
    late = led(1.0, 0.0, thrust=1.0, seconds=6.0)[-2000:]
    assert sum(tension for tension, _, _ in late) / 2000 == pytest.approx(1.0, abs=0.03)
    assert sum(v for _, _, v in late) / 2000 == pytest.approx(0.0, abs=0.05)


def test_eq_t2_reels_in_at_its_speed_where_thrust_and_tension_agree():
    tension, _, v = led(1.2, 0.15, (0.06, 2.0, 20.0))[-1]
    assert v == pytest.approx(-0.15, abs=0.005)
    assert tension == pytest.approx(1.2, abs=0.05)


def test_more_thrust_is_slower():
    _, _, v = led(1.2, 0.15, (0.06, 2.0, 20.0), thrust=1.7)[-1]
    # w = w_r + κ (T_d − T).
    assert v == pytest.approx(-(0.15 - 0.06 * 0.5), abs=0.005)


def test_a_slack_rope_is_taken_in():
    w = 0.0
    for _ in range(200):
        w = reel(w, 0.0, 1.0, 0.0, LIMITS, TICK)
    assert w == pytest.approx(0.5)


@pytest.mark.parametrize("tension", [100.0, 0.0])
def test_limits_of_speed_and_acceleration_hold(tension):
    w, before = 0.0, 0.0
    for _ in range(500):
        w = reel(w, tension, 50.0, 0.0, LIMITS, TICK)
        assert abs(w - before) <= LIMITS[2] * TICK + 1e-12
        before = w
    assert abs(w) == pytest.approx(LIMITS[1])
