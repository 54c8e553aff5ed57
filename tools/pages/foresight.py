"""The deck's motion of the next half second, by autoregressions that are fitted to its last minute; compiled.

| symbol | name | unit |
|---|---|---|
| y_k | `past` (6, N): rates ω_b and acceleration a_b of the deck, newest first, T = `PERIOD_S` apart | rad/s, m/s², D |
| φ | the N of them before y_k, each of the six by itself | |
| θ, P | `theta` (6, N), `P` (6, N, N): coefficients, their covariance over the residual's variance | 1, 1/u² |
| λ | `FORGETS`: weight of a sample over that of the one after it | 1 |

    y_k = θᵀφ + e;  g = P φ/(λ + φᵀP φ),  θ ← θ + g (y_k − θᵀφ),  P ← (P − g φᵀP)/λ                          (D.2)

θ begins as y_k = y_{k−1}: until something has been learnt the motion is held. From the newest samples (D.2) goes on without e for
`STEPS` steps; between two steps a cubic leads. What a sample T ago did not know is added, and fades: y(h) + (y_now − y(0)) e^(−h/T).
A sea is no sum of a few sinusoids, but a hull passes on a narrow band of it, and a platform swings at its own periods.

A UAV that keeps its station goes along with the share σ of the deck's motion, (K.3): the plate is foreseen as the deck sees it where σ
is 1, and as it hovers in W above a deck that is foreseen where σ is 0. With T₁ = `LASTS_S`, f = T₁ (h − T₁ (1 − e^(−h/T₁))), the deck's
turn R and way d until then, v_I = v + v_b + ω_b × r and a_I = a + g − γ

    r(h) = σ² (r + v h + a f) + (1 − σ²) Rᵀ (r + σ (v_I h + a_I f) − d)                                       (D.3)

The error of what was said of half a second later is measured all the time: `missed2` (2,), beside `size2` (2,) of what there was,
of rates and acceleration.
"""

import numpy as np
from numba import njit

from armland.models.environment import apparent_gravity
from armland.records import Record
from armland.rotations import Array, conjugate, cross, from_rotation_vector, matrix, multiply, turned, turned_back

PERIOD_S, ORDER, FORGETS = 0.1, 12, 0.998
"""T, N, λ: on hulls of 4 m and on `tank` no shorter period, other order or faster forgetting predicts half a second better."""

UNSURE = 1e6
"""Variance of each coefficient before anything is known, over that of the residual."""

LONGEST_S = 0.5
"""Longest horizon."""

STEPS = 7
"""T ahead that are said: the horizon, up to one since the newest sample, and one more for the cubic."""

MEASURED_S = 4.0
"""Time constant with which the prediction's error is measured."""

LASTS_S = 0.1
"""T₁: how long what accelerates a UAV in W lasts."""

FINE_S = 0.01
"""Step in which rates and acceleration ahead are summed up to attitude and velocity."""


def kept_layout() -> np.dtype:
    """What is remembered; zeros at first."""
    return np.dtype(
        [
            ("samples", "i8"),  # so far
            ("tick", "i8"),  # of the newest
            ("past", "f8", (6, ORDER)),
            ("theta", "f8", (6, ORDER)),
            ("P", "f8", (6, ORDER, ORDER)),
            ("course", "f8", (STEPS + 2, 6)),  # of one T before the newest sample, of it, and of the steps ahead
            (
                "said",
                "f8",
                (round(LONGEST_S / PERIOD_S), 6),
            ),  # what was said of the samples to come, the next one first
            ("missed2", "f8", (2,)),  # rad²/s², m²/s⁴
            ("size2", "f8", (2,)),
        ]
    )


@njit
def foresee(tick: int, tick_s: float, e: Record, s: Record) -> None:
    """Take a sample of the deck where it is time, learn from it and say how the motion goes on.

    Args:
        tick: present one.
        tick_s: s.
        e: environment of now, of `models.environment.environment_layout`.
        s: of `kept_layout`, updated.
    """
    if s.samples > 0 and (tick - s.tick) * tick_s < PERIOD_S - 0.5 * tick_s:
        return
    now = motion(e)
    _measure(now, s)
    for c in range(6):
        if s.samples == 0:
            s.theta[c, 0] = 1.0
            for i in range(ORDER):
                s.P[c, i, i], s.past[c, i] = UNSURE, now[c]
        elif s.samples >= ORDER:
            _learn(now[c], s.past[c], s.theta[c], s.P[c])
        for i in range(ORDER - 1, 0, -1):
            s.past[c, i] = s.past[c, i - 1]
        s.past[c, 0] = now[c]
        _go_on(c, s)
    for k in range(s.said.shape[0] - 1):
        s.said[k] = s.said[k + 1]
    s.said[-1] = s.course[1 + s.said.shape[0]]
    s.samples, s.tick = s.samples + 1, tick


@njit
def motion(e: Record) -> Array:
    """ω_b and a_b (6,), rad/s and m/s², D, of the environment `e`."""
    out = np.empty(6)
    for i in range(3):
        out[i], out[3 + i] = e.base_omega[i], e.base_a[i]
    return out


@njit
def _measure(now: Array, s: Record) -> None:
    if s.samples <= s.said.shape[0]:
        return
    gain = max(PERIOD_S / MEASURED_S, 1.0 / (s.samples - s.said.shape[0]))
    for kind in range(2):
        missed2, size2 = 0.0, 0.0
        for c in range(3 * kind, 3 * kind + 3):
            missed2 += (now[c] - s.said[0, c]) ** 2
            size2 += now[c] ** 2
        s.missed2[kind] += gain * (missed2 - s.missed2[kind])
        s.size2[kind] += gain * (size2 - s.size2[kind])


@njit
def _learn(y: float, phi: Array, theta: Array, P: Array) -> None:
    # (D.2) of one motion.
    spread, total, error = np.zeros(ORDER), FORGETS, y
    for i in range(ORDER):
        for k in range(ORDER):
            spread[i] += P[i, k] * phi[k]
        total += phi[i] * spread[i]
        error -= theta[i] * phi[i]
    for i in range(ORDER):
        theta[i] += spread[i] / total * error
        for k in range(ORDER):
            P[i, k] = (P[i, k] - spread[i] * spread[k] / total) / FORGETS  # (D.2)
    # What a calm deck does not excite is not forgotten for ever.
    for i in range(ORDER):
        if P[i, i] > UNSURE:
            shrink = np.sqrt(UNSURE / P[i, i])
            for k in range(ORDER):
                P[i, k] *= shrink
                P[k, i] *= shrink


@njit
def _go_on(c: int, s: Record) -> None:
    # Motion `c` of the steps ahead; no further than four times what it was of late, should its coefficients not be stable.
    most = 0.0
    for i in range(ORDER):
        most = max(most, 4.0 * abs(s.past[c, i]))
    s.course[0, c], s.course[1, c] = s.past[c, 1], s.past[c, 0]
    for k in range(STEPS):
        y = 0.0
        for i in range(ORDER):
            y += s.theta[c, i] * (s.course[1 + k - i, c] if i <= k + 1 else s.past[c, i - k])
        s.course[2 + k, c] = min(max(y, -most), most)


@njit
def at(later_s: float, s: Record) -> Array:
    """ω_b and a_b (6,), rad/s and m/s², D, `later_s` ≥ 0, s, after the newest sample; `s` of `kept_layout`."""
    u = min(max(later_s / PERIOD_S, 0.0), STEPS - 1.0)
    k = min(int(u), STEPS - 2)
    u -= k
    # Lagrange's cubic through the steps k − 1 to k + 2.
    weights = (
        -u * (u - 1.0) * (u - 2.0) / 6.0,
        (u + 1.0) * (u - 1.0) * (u - 2.0) / 2.0,
        -(u + 1.0) * u * (u - 2.0) / 2.0,
        (u + 1.0) * u * (u - 1.0) / 6.0,
    )
    out = np.zeros(6)
    for j in range(4):
        for c in range(6):
            out[c] += weights[j] * s.course[k + j, c]
    return out


@njit
def ahead(horizon_s: float, since_s: float, e: Record, s: Record, out: Record) -> Array:
    """Fill the environment `out` with what that of now will be; returns the way (3,), m, of the deck's origin, in the axes of now.

    Args:
        horizon_s: s, up to `LONGEST_S`.
        since_s: time since the newest sample of `foresee`, s.
        e: environment of now.
        s: of `kept_layout`; without a sample the deck's motion is held.
        out: of `models.environment.environment_layout`, written; gravity turns with the attitude.
    """
    h, quat, v = min(max(horizon_s, 0.0), LONGEST_S), e.base_quat.copy(), e.base_v.copy()
    R, way, steps = np.eye(3), np.zeros(3), int(np.ceil(h / FINE_S - 1e-9))
    for k in range(steps):
        dt = h / steps
        y = _course((k + 0.5) * dt, since_s, e, s)
        half = v + 0.5 * dt * (y[3:] - cross(y[:3], v))
        quat = multiply(quat, from_rotation_vector(y[:3] * dt))
        way += dt * turned(R, half)
        v = v + dt * (y[3:] - cross(y[:3], half))
        R = matrix(multiply(conjugate(e.base_quat.copy()), quat))
    y, before = _course(h, since_s, e, s), _course(max(h - FINE_S, 0.0), since_s, e, s)
    slope = (_course(h + FINE_S, since_s, e, s) - before) / (FINE_S + min(FINE_S, h))
    down, out.moves = turned_back(R, e.gravity.copy()), e.moves
    for i in range(4):
        out.base_quat[i] = quat[i]
    for i in range(3):
        out.base_omega[i], out.base_a[i], out.base_v[i], out.gravity[i] = y[i], y[3 + i], v[i], down[i]
        out.base_alpha[i] = slope[i] if s.samples > 0 else e.base_alpha[i]
    return way


@njit
def _course(later_s: float, since_s: float, e: Record, s: Record) -> Array:
    # ω_b and a_b (6,) `later_s` after now, beginning with what is known now.
    now = motion(e)
    if s.samples == 0:
        return now
    return at(since_s + later_s, s) + (now - at(since_s, s)) * np.exp(-later_s / PERIOD_S)


@njit
def plate_ahead(
    horizon_s: float, since_s: float, plate: tuple[Array, Array, Array], along: float, e: Record, s: Record, out: Record
) -> tuple[Array, Array]:
    """Place (3,), m, and velocity (3,), m/s, of the plate of a flying UAV, as the deck sees it then.

    Args:
        horizon_s: s, up to `LONGEST_S`.
        since_s: as in `ahead`.
        plate: place, velocity and acceleration now, each (3,), m, m/s, m/s², D.
        along: σ, share of the deck's motion that the UAV goes along with, 1; on land 1.
        e: as in `ahead`.
        s: likewise.
        out: likewise, written.

    Source: (D.3).
    """
    r, v, a = plate
    gamma, carried = apparent_gravity(e, r, v), cross(e.base_omega.copy(), r)
    way = ahead(horizon_s, since_s, e, s, out)
    h, both = min(max(horizon_s, 0.0), LONGEST_S), along * along
    speeds = LASTS_S * (1.0 - np.exp(-h / LASTS_S))
    moves = LASTS_S * (h - speeds)
    place, speed = np.empty(3), np.empty(3)
    for i in range(3):
        v_i, a_i = v[i] + e.base_v[i] + carried[i], a[i] + e.gravity[i] - gamma[i]
        place[i], speed[i] = r[i] + along * (v_i * h + a_i * moves) - way[i], along * (v_i + a_i * speeds)
    R = matrix(multiply(conjugate(e.base_quat.copy()), out.base_quat.copy()))
    place = turned_back(R, place)
    speed = turned_back(R, speed) - out.base_v - cross(out.base_omega.copy(), place)
    return both * (r + h * v + moves * a) + (1.0 - both) * place, both * (v + speeds * a) + (
        1.0 - both
    ) * speed  # (D.3)
