"""A platform that stands still on a hull that moves, as far as its legs let it; compiled.

| symbol | name | unit, frame |
|---|---|---|
| R, ω, v | hull's attitude, rate and velocity of its origin, as its motion reference and (D.1) have them now | rad/s, m/s, D |
| h | `moved` (3,): how far the middle was carried lately, ḣ = v_c − h/T, v_c its velocity | m, W |
| d, R_P | pose that is asked for: d = −e sat(|h|/e) Rᵀ h/|h|, R_P = Rᵀ R_yaw (C.1), sat = tanh | m, D |
| e | `travel`: farthest from the neutral pose that the middle is asked to go | m |

T lets the platform come back to its middle: of a swing of ω it cancels ωT/√(1 + ω²T²). What the legs' stroke does not hold of the way
is given up softly, so that the attitude is held all the same. The heading of the hull is left as it is. A leg follows its length by a
servo of bandwidth ω_s within acceleration, speed and stroke:

    l̈ = sat(ω_s² (l_d − l) + 2 ω_s (l̇_d − l̇)),  |l̇| ≤ min(l̇_max, √(2 l̈_max s)),  s the way to the stop     (C.2)
"""

import numpy as np
from numba import njit

from armland.rotations import Array, cross, matrix, turned, turned_back


@njit(cache=True)
def wanted(
    quat: Array, rate: Array, v: Array, middle: Array, moved: Array, times: tuple[float, float, float]
) -> tuple[Array, Array]:
    """The pose (6,), m and rad, that holds the platform level and at rest, and its rate; `moved` (3,), m, is carried on.

    Args:
        quat: of the hull (4,), W<-D, scalar first.
        rate: ω (3,), rad/s, D.
        v: of D's origin (3,), m/s, D.
        middle: of the platform (3,), m, D.
        moved: h (3,), m, W, updated.
        times: tick, s; T, s; and e, m.
    """
    tick_s, fade_s, travel = times
    R, carried = matrix(quat), cross(rate, middle)
    for i in range(3):
        carried[i] += v[i]
    along, goes = turned(R, carried), np.empty(3)
    for i in range(3):
        goes[i] = along[i] - moved[i] / fade_s
        moved[i] += goes[i] * tick_s
    far = np.sqrt(moved[0] ** 2 + moved[1] ** 2 + moved[2] ** 2)
    share = travel * np.tanh(far / travel) / far if far > 1e-9 else 1.0
    slope = 1.0 - np.tanh(far / travel) ** 2
    back, going = turned_back(R, moved), turned_back(R, goes)
    outwards = 0.0
    for i in range(3):
        outwards += back[i] * going[i] / max(far * far, 1e-18)
    x, x_rate = np.empty(6), np.zeros(6)
    for i in range(3):
        # Along the way out by the slope, across it by the share.
        radial = back[i] * outwards if far > 1e-9 else 0.0
        x[i] = -share * back[i]
        x_rate[i] = -(slope * radial + share * (going[i] - radial))
    turns = cross(rate, np.array([x[0], x[1], x[2]]))
    for i in range(3):
        x_rate[i] -= turns[i]
    _level(R, x)
    x_rate[4], x_rate[5] = -rate[1], -rate[0]
    return x, x_rate


@njit(cache=True)
def _level(R: Array, x: Array) -> None:
    # The platform's attitude in W keeps the hull's heading alone.
    yaw = np.arctan2(R[1, 0], R[0, 0])
    c, s, P = np.cos(yaw), np.sin(yaw), np.empty((3, 3))
    for i in range(3):
        P[i, 0], P[i, 1], P[i, 2] = c * R[0, i] + s * R[1, i], -s * R[0, i] + c * R[1, i], R[2, i]
    x[3], x[4], x[5] = np.arctan2(P[1, 0], P[0, 0]), -np.arcsin(P[2, 0]), np.arctan2(P[2, 1], P[2, 2])  # (C.1)


@njit(cache=True)
def follow_length(l: float, speed: float, l_d: float, speed_d: float, limits: Array, tick_s: float) -> float:
    """The speed, m/s, of a leg after a tick.

    Args:
        l: its length, m.
        speed: its speed, m/s.
        l_d: length that is asked for, m.
        speed_d: rate of that, m/s.
        limits: (5,), shortest and longest, m; largest speed, m/s, and acceleration, m/s²; bandwidth ω_s, rad/s.
        tick_s: s.
    """
    shortest, longest, fastest, hardest, omega = limits[0], limits[1], limits[2], limits[3], limits[4]
    push = omega**2 * (l_d - l) + 2.0 * omega * (speed_d - speed)
    new = speed + min(max(push, -hardest), hardest) * tick_s
    up, down = np.sqrt(2.0 * hardest * max(longest - l, 0.0)), np.sqrt(2.0 * hardest * max(l - shortest, 0.0))
    new = min(max(new, -min(fastest, down)), min(fastest, up))
    # What the stop asks for is no more than the leg's acceleration but for the last of it.
    return min(max(new, speed - hardest * tick_s), speed + hardest * tick_s)  # (C.2)
