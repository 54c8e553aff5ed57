"""Station keeping of the flying UAV: position and velocity to thrust and attitude, within limits of tilt and thrust; compiled.

| symbol | name | unit, frame |
|---|---|---|
| r, v | `position`, `velocity` (3,) of the centre of mass | m, m/s, world |
| r_d, v_d, a_d, ψ_d | reference: `position`, `velocity`, `acceleration`, `heading` | m, m/s, m/s², rad, world |
| i | `integral` (3,): acceleration that holds against wind and model error | m/s², world |
| d | `disturbance` (3,): acceleration by wind as an observer knows it, zero without one | m/s², world |
| F | force that the rotors shall make | N, world |
| f_T, q_d | `thrust`, desired attitude (4,) | N, 1 |

v_w = v_d + sat(k_p (r_d − r)), a_w = a_d + k_v (v_w − v) + i − d, F = m (a_w + g e₃) (K.1), i̇ = k_i (v_w − v); q_d turns b_z
into F's direction and has the heading ψ_d. The reference may jump: the speed that is asked for is limited.

Limits: F_z is kept in [`lift_min`, `thrust_max` cos `tilt_max`] and the horizontal part of F below F_z tan `tilt_max`. So |F|
is never beyond `thrust_max`, and however hard the UAV climbs, the whole tilt stays available. f_T = F_z / (b_z·e₃): the
vertical force is what was asked for, also while the attitude still follows. i stops, vertically and horizontally, where F
is at a limit and the error drives it on.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.rotations import Array, multiply


class StationGains(NamedTuple):
    """Gains and limits.

    The defaults leave a phase margin of 34° with rotors of 50 ms, 50 ms of latency, and the demonstrator's onboard attitude
    gains of 0.4 N·m/rad and 0.056 N·m·s/rad, which let the attitude overshoot a jump of its set-point by a quarter.
    """

    mass: float = 0.480
    """kg."""
    gravity: float = 9.81
    """m/s²."""
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


class StationReference(NamedTuple):
    """Where the centre of mass shall be."""

    position: Array
    """(3,) m, world."""
    velocity: Array
    """(3,) m/s, world."""
    acceleration: Array
    """(3,) m/s², world."""
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
) -> tuple[float, Array, Array]:
    """One sample of the controller; to be called every `gains.period`.

    Args:
        position: (3,), m, world.
        velocity: (3,), m/s, world.
        q: attitude (4,), world<-body.
        reference: where to be.
        disturbance: (3,), m/s², world; zeros without an observer.
        gains: gains and limits.
        integral: i (3,), m/s²; zeros at first.

    Returns:
        f_T in N, q_d (4,), and the new i.
    """
    wanted_velocity = reference.velocity + _limited(gains.k_position * (reference.position - position), gains.speed_max)
    velocity_error = wanted_velocity - velocity
    force = reference.acceleration + gains.k_velocity * velocity_error + integral - disturbance
    force[2] += gains.gravity
    force *= gains.mass  # (K.1)
    held = _within_limits(force, gains)
    thrust = held[2] / max(1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]), np.cos(gains.tilt_max))
    q_d = attitude_of(held, reference.heading)
    return min(thrust, gains.thrust_max), q_d, _integrated(integral, velocity_error, force, held, gains)


@njit(cache=True)
def attitude_of(force: Array, heading: float) -> Array:
    """The attitude (4,) with b_z along `force` (3,), which does not point straight down: `heading` rad, then the shortest turn."""
    length = np.sqrt(force[0] ** 2 + force[1] ** 2 + force[2] ** 2)
    tilt = np.array([length + force[2], -force[1], force[0], 0.0])
    tilt /= np.sqrt(tilt[0] ** 2 + tilt[1] ** 2 + tilt[2] ** 2)
    return multiply(tilt, np.array([np.cos(0.5 * heading), 0.0, 0.0, np.sin(0.5 * heading)]))


@njit(cache=True)
def _limited(a: Array, largest: float) -> Array:
    length = np.sqrt(a[0] ** 2 + a[1] ** 2 + a[2] ** 2)
    return a * (largest / length) if length > largest else a


@njit(cache=True)
def _within_limits(force: Array, gains: StationGains) -> Array:
    held = force.copy()
    held[2] = min(max(force[2], gains.lift_min), gains.thrust_max * np.cos(gains.tilt_max))
    sideways, room = np.sqrt(force[0] ** 2 + force[1] ** 2), held[2] * np.tan(gains.tilt_max)
    if sideways > room:
        held[:2] *= room / sideways
    return held


@njit(cache=True)
def _integrated(integral: Array, velocity_error: Array, force: Array, held: Array, gains: StationGains) -> Array:
    step = gains.k_integral * gains.period * velocity_error
    outwards = force[0] * step[0] + force[1] * step[1] > 0.0
    if outwards and (force[0] != held[0] or force[1] != held[1]):
        step[:2] = 0.0
    if (force[2] - held[2]) * step[2] > 0.0:
        step[2] = 0.0
    new = integral + step
    sideways = np.sqrt(new[0] ** 2 + new[1] ** 2)
    if sideways > gains.integral_max:
        new[:2] *= gains.integral_max / sideways
    new[2] = min(max(new[2], -gains.integral_max), gains.integral_max)
    return new
