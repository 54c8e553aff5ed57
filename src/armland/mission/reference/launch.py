"""Reference of the arm that gives a UAV a speed at its release: run-up, on at that speed, leave; compiled.

| symbol | name | unit |
|---|---|---|
| s(u), S(u) | septic from 0 to 1 and its integral | 1 |
| V | `launch`, velocity given to the UAV | m/s |

Run-up: the velocity is V s(t/T), and V from then on. Leave: within `leave_s` the arm moves down by the depth. Until half of that time
it keeps the UAV's velocity V; then it slows down over T. By then it has covered half of the depth, so it clears the UAV
before it falls behind.
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
