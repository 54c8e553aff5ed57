"""Station keeping of the flying UAV: position and velocity to thrust and attitude, within limits of tilt and thrust; compiled.

| symbol | name | unit, frame |
|---|---|---|
| r, v | `position`, `velocity` (3,) of the centre of mass | m, m/s, D |
| r_d, v_d, a_d, ψ_d | reference: `position`, `velocity`, `acceleration`, `heading` | m, m/s, m/s², rad, D |
| i | `integral` (3,): acceleration that holds against wind and model error | m/s², D |
| d | `disturbance` (3,): acceleration by wind as an observer knows it, zero without one | m/s², D |
| F | force that the rotors shall make | N, D |
| f_T, q_d | `thrust`, desired attitude (4,) | N, 1 |

v_w = v_d + sat(k_p (r_d − r)), a_w = a_d + k_v (v_w − v) + i − d, F = m (a_w − γ) (K.1), i̇ = k_i (v_w − v); q_d turns b_z
into F's direction and has the heading ψ_d. sat limits the speed that is asked for, so the reference may jump.

Limits: the horizontal part F_h of F is kept below F_z tan `tilt_max`, where F_z counts for at most `thrust_max` cos `tilt_max`, and
then F_z in [`lift_min`, √(`thrust_max`² − F_h²)]. So |F| never exceeds `thrust_max`, the whole tilt stays available however hard the
UAV climbs, and one that leans less climbs with all that is left. f_T = F_z / (b_z·e₃) gives the vertical force that was asked for
even while the attitude still lags. Anti-windup: i stops, vertically and horizontally, where F is at a limit
and the error would drive it further.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.models.environment import DOWN
from armland.rotations import Array, multiply


class StationGains(NamedTuple):
    """Gains and limits.

    The defaults leave a phase margin of 34° with rotors of 50 ms, 50 ms of latency, and the demonstrator's onboard attitude
    gains of 0.4 N·m/rad and 0.056 N·m·s/rad, which let the attitude overshoot a jump of its set-point by a quarter.
    """

    mass: float = 0.480
    """kg."""
    period: float = 0.005
    """Time between two samples, s."""
    k_position: float = 0.8
    """1/s."""
    k_velocity: float = 2.2
    """1/s."""
    k_integral: float = 1.0
    """1/s²."""
    speed_max: float = 1.0
    """Largest speed asked for on top of v_d, m/s."""
    integral_max: float = 5.0
    """Largest |i|, horizontally and vertically, m/s²."""
    tilt_max: float = 0.61
    """rad."""
    lift_min: float = 1.4
    """Smallest F_z, N: what the rotors need so that the attitude stays under control."""
    thrust_max: float = 7.0
    """N, below the rotors' 7.44 N: the rest is for the attitude."""
    vertical: float = 1.0
    """k_v and k_i upwards over those sideways: thrust answers sooner than attitude."""


class StationReference(NamedTuple):
    """Where the centre of mass shall be."""

    position: Array
    """(3,) m, D."""
    velocity: Array
    """(3,) m/s, D."""
    acceleration: Array
    """(3,) m/s², D."""
    heading: float
    """ψ_d, rad."""


@njit(cache=True)
def keep_station(
    position: Array,
    velocity: Array,
    q: Array,
    reference: StationReference,
    disturbance: Array,
    gains: StationGains,
    integral: Array,
    gravity: tuple[float, float, float] = DOWN,
) -> tuple[float, Array, Array]:
    """One sample of the controller; to be called every `gains.period`.

    Args:
        position: (3,), m, D.
        velocity: (3,), m/s, D.
        q: attitude (4,), scalar first, D<-B.
        reference: where to be.
        disturbance: (3,), m/s², D; zeros without an observer.
        gains: gains and limits.
        integral: i (3,), m/s²; zeros at first.
        gravity: γ (3,), m/s², D.

    Returns:
        f_T in N, q_d (4,), and the new i.
    """
    velocity_error, force = np.empty(3), np.empty(3)
    catching_up = _limited(reference.position - position, gains.k_position, gains.speed_max)
    for i in range(3):
        velocity_error[i] = reference.velocity[i] + catching_up[i] - velocity[i]
        k_v = gains.k_velocity * (gains.vertical if i == 2 else 1.0)
        wanted = reference.acceleration[i] + k_v * velocity_error[i] + integral[i] - disturbance[i]
        force[i] = gains.mass * (wanted - gravity[i])  # (K.1)
    held = _within_limits(force, gains)
    thrust = held[2] / max(1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]), np.cos(gains.tilt_max))
    q_d = attitude_of(held, reference.heading)
    return min(thrust, gains.thrust_max), q_d, _integrated(integral, velocity_error, force, held, gains)


@njit(cache=True)
def attitude_of(force: Array, heading: float) -> Array:
    """The attitude (4,), D<-B, with b_z along `force` (3,), N, not straight down: `heading` rad, then the shortest turn."""
    length = np.sqrt(force[0] ** 2 + force[1] ** 2 + force[2] ** 2)
    size = np.sqrt((length + force[2]) ** 2 + force[1] ** 2 + force[0] ** 2)
    tilt = np.array([(length + force[2]) / size, -force[1] / size, force[0] / size, 0.0])
    return multiply(tilt, np.array([np.cos(0.5 * heading), 0.0, 0.0, np.sin(0.5 * heading)]))


@njit(cache=True)
def _limited(a: Array, factor: float, largest: float) -> Array:
    # `factor` times a (3,), its length at most `largest`.
    length, out = factor * np.sqrt(a[0] ** 2 + a[1] ** 2 + a[2] ** 2), np.empty(3)
    for i in range(3):
        out[i] = factor * a[i] * (largest / length) if length > largest else factor * a[i]
    return out


@njit(cache=True)
def _within_limits(force: Array, gains: StationGains) -> Array:
    held = force.copy()
    lift = min(max(force[2], gains.lift_min), gains.thrust_max * np.cos(gains.tilt_max))
    sideways, room = np.sqrt(force[0] ** 2 + force[1] ** 2), lift * np.tan(gains.tilt_max)
    if sideways > room:
        held[0] *= room / sideways
        held[1] *= room / sideways
    left = np.sqrt(gains.thrust_max**2 - min(sideways, room) ** 2)
    held[2] = min(max(force[2], gains.lift_min), left)
    return held


@njit(cache=True)
def _integrated(integral: Array, velocity_error: Array, force: Array, held: Array, gains: StationGains) -> Array:
    step, new = np.empty(3), np.empty(3)
    for i in range(3):
        k_i = gains.k_integral * (gains.vertical if i == 2 else 1.0)
        step[i] = k_i * gains.period * velocity_error[i]
    outwards = force[0] * step[0] + force[1] * step[1] > 0.0
    if outwards and (force[0] != held[0] or force[1] != held[1]):
        step[0] = step[1] = 0.0
    if (force[2] - held[2]) * step[2] > 0.0:
        step[2] = 0.0
    for i in range(3):
        new[i] = integral[i] + step[i]
    sideways = np.sqrt(new[0] ** 2 + new[1] ** 2)
    if sideways > gains.integral_max:
        new[0] *= gains.integral_max / sideways
        new[1] *= gains.integral_max / sideways
    new[2] = min(max(new[2], -gains.integral_max), gains.integral_max)
    return new
