"""The deck as the controller knows it: the motion reference's newest sample, carried on to now, into the `environment`; compiled.

| symbol | name | unit, frame |
|---|---|---|
| q_b, ω_b, v_b, a_b | `base_quat`, `base_omega`, `base_v`, `base_a` of the environment | 1 W<-D; rad/s, m/s, m/s², D |
| ω̇_b | `base_alpha`: from the rates, by `tracking` | rad/s², D |
| t | age of the newest sample | s |
| g | `gravity` in deck axes, R(q_b)ᵀ g_W | m/s², D |

Rates and acceleration are tracked with their derivatives and all is carried on over t with these: ω_b = ω + ω̇ t + ½ ω̈ t²,
ω̇_b = ω̇ + ω̈ t, a_b = a + ȧ t + ½ ä t², v_b = v + (a − ω × v) t + ½ ȧ t², q_b = q exp(ω t + ½ ω̇ t² + ⅙ ω̈ t³).
A platform that rolls every half a second turns by 0.1 rad while a sample is under way and the next is waited for: with differences
behind a low pass of 30 ms ω̇_b was wrong by half, 0.5 of 1 rad/s², on `tank`; it is by 0.15.

The UAV speaks of its attitude in the inertial frame. q_DB = q_b⁻¹ ⊗ q_WB, both at the time of its sample, and its rates against the
deck are ω − R_DBᵀ ω_b, likewise then. Where there is no motion reference nothing of this happens: D is W.
"""

import numpy as np
from numba import njit

from armland.estimation import tracking
from armland.records import Record, Records
from armland.rotations import Array, conjugate, cross, from_rotation_vector, matrix, multiply, turned_back
from armland.scenario import Scenario

SWINGS, JOLTS = 300.0, 3e3
"""q of the rates, rad²/s⁷, and of the acceleration, m²/s⁹: where on the fastest deck there is, `tank`, noise and lateness add up to
least; in sea state 3 ω̇_b is then as good as behind a low pass of 30 ms."""

OLDEST_S = 0.2
"""Age beyond which a sample is carried on no further."""


def told_layout() -> np.dtype:
    """What knowing the deck is told: gains of `tracking` for rates and acceleration."""
    return np.dtype([("rate", "f8", (3,)), ("a", "f8", (3,))])


def told(scenario: Scenario) -> Records:
    """The record (1,) of `told_layout`, for the motion reference as the controller believes it."""
    u, p = scenario.motion_reference, np.zeros(1, told_layout())
    p["rate"] = tracking.steady_gains(1.0 / u.rate_hz, SWINGS, np.deg2rad(u.rate_noise_deg_s))
    p["a"] = tracking.steady_gains(1.0 / u.rate_hz, JOLTS, u.acceleration_noise_mps2)
    return p


def kept_layout() -> np.dtype:
    """What of the motion reference is remembered."""
    return np.dtype([("known", "i8"), ("tick", "i8"), ("rate", tracking.kept_layout()), ("a", tracking.kept_layout())])


@njit(cache=True)
def know_deck(m: Record, gravity: Array, tick_s: float, p: Record, s: Record, e: Record) -> None:
    """Bring the environment up to date.

    Args:
        m: measurement.
        gravity: (3,), m/s², W.
        tick_s: s.
        p: of `told_layout`.
        s: of `kept_layout`, updated.
        e: of `models.environment.environment_layout`, written where there is a motion reference.
    """
    if not m.deck_known:
        return
    if not s.known:
        tracking.begin(m.deck_rate, s.rate)
        tracking.begin(m.deck_a, s.a)
    elif m.deck_tick > s.tick:
        since = (m.deck_tick - s.tick) * tick_s
        tracking.track(m.deck_rate, since, p.rate, s.rate)
        tracking.track(m.deck_a, since, p.a, s.a)
    s.known, s.tick, e.moves = 1, m.deck_tick, 1
    t, turn = min((m.tick - m.deck_tick) * tick_s, OLDEST_S), np.empty(3)
    carried = cross(s.rate.value, m.deck_v)
    for i in range(3):
        w, a = s.rate, s.a
        turn[i] = (w.value[i] + (w.first[i] / 2.0 + w.second[i] / 6.0 * t) * t) * t
        e.base_omega[i] = w.value[i] + (w.first[i] + 0.5 * w.second[i] * t) * t
        e.base_alpha[i] = w.first[i] + w.second[i] * t
        e.base_a[i] = a.value[i] + (a.first[i] + 0.5 * a.second[i] * t) * t
        e.base_v[i] = m.deck_v[i] + (a.value[i] - carried[i] + 0.5 * a.first[i] * t) * t
    quat = multiply(m.deck_quat, from_rotation_vector(turn))
    down = turned_back(matrix(quat), gravity)
    for i in range(4):
        e.base_quat[i] = quat[i]
    for i in range(3):
        e.gravity[i] = down[i]


@njit(cache=True)
def as_sent(m: Record, good: Record) -> None:
    """Put the UAV's sample back as it came, where none has come since it was turned into the deck's axes.

    Args:
        m: measurement, before it is screened; its numbers, 1 and rad/s, are written.
        good: the last good one.
    """
    if m.uav_tick == good.uav_tick and good.tick > 0 and np.isfinite(m.uav_quat.sum() + m.uav_rate.sum()):
        for i in range(4):
            m.uav_quat[i] = good.uav_quat[i]
        for i in range(3):
            m.uav_rate[i] = good.uav_rate[i]


@njit(cache=True)
def turn_into_deck(m: Record, e: Record, tick_s: float) -> None:
    """Turn the UAV's attitude (4,), scalar first, and rates (3,), rad/s, into those against the deck, at the tick of its sample.

    Args:
        m: measurement, screened; written.
        e: environment of the present tick.
        tick_s: s.
    """
    since, turn, then = min((m.tick - m.uav_tick) * tick_s, OLDEST_S), np.empty(3), np.empty(3)
    for i in range(3):
        turn[i] = -since * (e.base_omega[i] - 0.5 * since * e.base_alpha[i])
        then[i] = e.base_omega[i] - since * e.base_alpha[i]
    quat = multiply(conjugate(multiply(e.base_quat, from_rotation_vector(turn))), m.uav_quat)
    deck = turned_back(matrix(quat), then)
    for i in range(4):
        m.uav_quat[i] = quat[i]
    for i in range(3):
        m.uav_rate[i] -= deck[i]
