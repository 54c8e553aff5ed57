"""Reference of the arm that gives a UAV a speed at its release: run-up, on at that speed, leave; compiled.

| symbol | name | unit |
|---|---|---|
| s(u), S(u) | septic from 0 to 1 and its integral | 1 |
| V | `launch`, velocity given to the UAV | m/s |

Run-up: v = V s(t/T), then V. Leave: straight down by the depth within `leave_s` while the arm goes along with the UAV; from half
of that time on it slows down, over T. By then it has gone half of its displacement down, faster than it falls behind.
"""

from numba import njit

from armland.mission.reference.septic import septic, septic_integral


@njit(cache=True)
def run_up(t: float, duration: float) -> tuple[float, float, float]:
    """Distance over V, s; speed over V, 1; acceleration over V, 1/s, after `t` s of a run-up of `duration` s."""
    if t <= 0.0:
        return 0.0, 0.0, 0.0
    if t >= duration:
        return t - 0.5 * duration, 1.0, 0.0
    speed, acceleration, _ = septic(t / duration, duration)
    return septic_integral(t / duration) * duration, speed, acceleration


@njit(cache=True)
def leave(t: float, duration: float, leave_s: float) -> tuple[float, float, float]:
    """As `run_up`, of the displacement along V while the arm leaves: at V for half of `leave_s`, then slowing down.

    Args:
        t: s, since it began to leave.
        duration: s, of slowing down.
        leave_s: s, in which it goes down.
    """
    distance, speed, acceleration = run_up(t - 0.5 * leave_s, duration)
    return t - distance, 1.0 - speed, -acceleration
