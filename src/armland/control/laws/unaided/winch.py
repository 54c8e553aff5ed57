"""A winch that keeps the rope's tension, or reels in at a speed, more stiffly; compiled.

| symbol | name | unit |
|---|---|---|
| w | speed of the rope, in is positive | m/s |
| T, T_d | tension at the drum as its load cell has it, and the one that is asked for | N |
| κ | `give`: speed per newton of error, larger where it keeps a tension than where it reels in | m/s/N |
| w_r | speed at which it reels in, where the tension is T_d; 0 to keep the tension | m/s |

    w_d = w_r + κ (T_d − T)                                                                              (T.2)
    |ẇ| ≤ `hardest`, |w| ≤ `fastest`

A rope cannot push: where it is slack T is zero, and the winch takes it in. With a large κ the UAV does not feel the deck, with a small
one it moves as the deck does: 1/κ is a damper between them.
"""

from numba import njit


@njit(cache=True)
def reel(
    speed: float, tension: float, asked: float, rate: float, limits: tuple[float, float, float], tick_s: float
) -> float:
    """w after a tick, m/s.

    Args:
        speed: w, m/s.
        tension: T, N.
        asked: T_d, N.
        rate: w_r, m/s.
        limits: κ, m/s/N; fastest, m/s; hardest, m/s².
        tick_s: s.
    """
    give, fastest, hardest = limits
    wanted = rate + give * (asked - tension)  # (T.2)
    wanted = min(max(wanted, -fastest), fastest)
    return float(min(max(wanted, speed - hardest * tick_s), speed + hardest * tick_s))
