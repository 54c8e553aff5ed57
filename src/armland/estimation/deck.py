"""The deck as the controller knows it: the motion reference's newest sample, carried on to now, into the `environment`; compiled.

| symbol | name | unit, frame |
|---|---|---|
| q_b, ω_b, v_b, a_b | `base_quat`, `base_omega`, `base_v`, `base_a` of the environment | 1 W<-D; rad/s, m/s, m/s², D |
| ω̇_b | `base_alpha`: from the rates, smoothed over `SMOOTH_S` | rad/s², D |
| g | `gravity` in deck axes, R(q_b)ᵀ g_W | m/s², D |

q_b and ω_b are carried on with ω_b and ω̇_b over the sample's age; a_b stays: at 1 rad/s and 10 ms that is 1 % of it.
The UAV speaks of its attitude in the inertial frame. q_DB = q_b⁻¹ ⊗ q_WB, both at the time of its sample, and its rates against the
deck are ω − R_DBᵀ ω_b. Where there is no motion reference nothing of this happens: D is W.
"""

import numpy as np
from numba import njit

from armland.records import Record
from armland.rotations import Array, conjugate, from_rotation_vector, matrix, multiply, turned_back

SMOOTH_S = 0.03
"""Above it the rates' noise, 0.07 deg/s every 10 ms, would be 0.17 rad/s² of ω̇_b; it is 0.04."""

OLDEST_S = 0.2
"""Age beyond which a sample is carried on no further."""


def kept_layout() -> np.dtype:
    """What of the motion reference is remembered."""
    return np.dtype([("known", "i8"), ("tick", "i8"), ("rate", "f8", (3,)), ("alpha", "f8", (3,))])


@njit(cache=True)
def know_deck(m: Record, gravity: Array, tick_s: float, s: Record, e: Record) -> None:
    """Bring the environment up to date.

    Args:
        m: measurement.
        gravity: (3,), m/s², W.
        tick_s: s.
        s: of `kept_layout`, updated.
        e: of `models.environment.environment_layout`, written where there is a motion reference.
    """
    if not m.deck_known:
        return
    if s.known and m.deck_tick > s.tick:
        dt = (m.deck_tick - s.tick) * tick_s
        for i in range(3):
            s.alpha[i] += dt / (SMOOTH_S + dt) * ((m.deck_rate[i] - s.rate[i]) / dt - s.alpha[i])
    if not s.known or m.deck_tick > s.tick:
        s.known, s.tick = 1, m.deck_tick
        for i in range(3):
            s.rate[i] = m.deck_rate[i]
    age, turn = min((m.tick - m.deck_tick) * tick_s, OLDEST_S), np.empty(3)
    e.moves = 1
    for i in range(3):
        turn[i] = (s.rate[i] + 0.5 * age * s.alpha[i]) * age
        e.base_omega[i], e.base_alpha[i] = s.rate[i] + age * s.alpha[i], s.alpha[i]
        e.base_v[i], e.base_a[i] = m.deck_v[i], m.deck_a[i]
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
    since, turn = min((m.tick - m.uav_tick) * tick_s, OLDEST_S), np.empty(3)
    for i in range(3):
        turn[i] = -since * e.base_omega[i]
    quat = multiply(conjugate(multiply(e.base_quat, from_rotation_vector(turn))), m.uav_quat)
    deck = turned_back(matrix(quat), e.base_omega)
    for i in range(4):
        m.uav_quat[i] = quat[i]
    for i in range(3):
        m.uav_rate[i] -= deck[i]
