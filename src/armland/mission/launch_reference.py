"""Reference of the arm that gives a UAV a speed at its release: run-up, way at that speed, leave; compiled.

| symbol | name | unit |
|---|---|---|
| b(u) | septic from 0 to 1, `landing_arm.septic` | 1 |
| B(u) | its integral, 1/2 at u = 1 | 1 |
| V | `velocity` given to the UAV | m/s |

Run-up: v = V b(t/T), then V. Leave: straight down by the depth within `leave` s while the arm goes along with the UAV; from half
of that time on it slows down, over T. By then it has gone half of its way down, faster than it falls behind.
"""

from numba import njit


@njit(cache=True)
def run_up(t: float, duration: float) -> tuple[float, float, float]:
    """Distance over V, s; speed over V, 1; acceleration over V, 1/s, after `t` s of a run-up of `duration` s."""
    if t <= 0.0:
        return 0.0, 0.0, 0.0
    if t >= duration:
        return t - 0.5 * duration, 1.0, 0.0
    u = t / duration
    w = 1.0 - u
    b = u**4 * (35.0 + u * (-84.0 + u * (70.0 - 20.0 * u)))
    integral = u**5 * (7.0 + u * (-14.0 + u * (10.0 - 2.5 * u)))
    return integral * duration, b, 140.0 * u**3 * w**3 / duration


@njit(cache=True)
def leave(t: float, duration: float, leave_s: float) -> tuple[float, float, float]:
    """As `run_up`, of the way along V while the arm leaves: at V for half of `leave_s`, then slowing down over `duration` s."""
    distance, speed, acceleration = run_up(t - 0.5 * leave_s, duration)
    return t - distance, 1.0 - speed, -acceleration
