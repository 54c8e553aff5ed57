"""Rigid-body model of the UAV and the allocation of thrust and torque to its four rotors, compiled.

| symbol | name | unit |
|---|---|---|
| f_T | `thrust`, along body z | N |
| τ | `torque` (3,), body axes | N·m |
| T_i | `rotor` (4,), thrust of each rotor | N |

[f_T, τ] = A T with A of `mixer`; row by row: 1, y_i, −x_i, ±k (reaction torque per thrust, sign by spin).
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.rotations import Array


class UavParameters(NamedTuple):
    """The rigid body: mass, kg; inertia (3, 3) about the CM, kg·m², body; lever (3,) from CM to pivot, m, body."""

    mass: float
    inertia: Array
    lever: Array


def mixer(position: Array, drag_torque: float) -> Array:
    """A (4, 4) of rotors at `position` (4, 3) m, body axes, spins alternating in sign, `drag_torque` in N·m/N."""
    spin = np.array([1.0, -1.0, 1.0, -1.0])
    return np.array([np.ones(4), position[:, 1], -position[:, 0], spin * drag_torque])


@njit(cache=True)
def allocate(thrust: float, torque: Array, inverse: Array, low: float, high: float) -> Array:
    """Rotor thrusts (4,) N, each in [low, high], for a total thrust and a torque (3,) N·m; `inverse` = A⁻¹ (4, 4).

    Exact where the rotors can give it. What they cannot is dropped in this order: yaw torque, total thrust, roll and
    pitch torque. The result is a continuous function of what was asked.
    """
    lift = inverse[:, 0].copy()
    tilt = np.empty(4)
    yaw = np.empty(4)
    for i in range(4):
        tilt[i] = inverse[i, 1] * torque[0] + inverse[i, 2] * torque[1]
        yaw[i] = inverse[i, 3] * torque[2]
    total = _nearest_thrust(thrust, lift, tilt, yaw, low, high)
    if np.isnan(total):
        # Roll and pitch are beyond the rotors at any thrust: scaled down together by the largest factor that is not.
        possible, beyond = 0.0, 1.0
        for _ in range(40):
            factor = 0.5 * (possible + beyond)
            if np.isnan(_nearest_thrust(thrust, lift, factor * tilt, yaw, low, high)):
                beyond = factor
            else:
                possible = factor
        # A little less, so that rounding does not close the room that is left.
        tilt *= possible * (1.0 - 1e-9)
        total = _nearest_thrust(thrust, lift, tilt, yaw, low, high)
    _, share = _yaw_shares(total, lift, tilt, yaw, low, high)
    rotor = np.empty(4)
    for i in range(4):
        rotor[i] = min(max(total * lift[i] + tilt[i] + max(share, 0.0) * yaw[i], low), high)
    return rotor


@njit(cache=True)
def _yaw_shares(thrust: float, lift: Array, tilt: Array, yaw: Array, low: float, high: float) -> tuple[float, float]:
    # Smallest and largest share of the yaw torque, from 0 to 1, that the rotors' limits allow; crossed if there is none.
    smallest, largest = 0.0, 1.0
    for i in range(4):
        base = thrust * lift[i] + tilt[i]
        if yaw[i] > 0.0:
            smallest, largest = max(smallest, (low - base) / yaw[i]), min(largest, (high - base) / yaw[i])
        elif yaw[i] < 0.0:
            smallest, largest = max(smallest, (high - base) / yaw[i]), min(largest, (low - base) / yaw[i])
        elif base < low or base > high:
            return 1.0, 0.0
    return smallest, largest


@njit(cache=True)
def _nearest_thrust(thrust: float, lift: Array, tilt: Array, yaw: Array, low: float, high: float) -> float:
    # The thrust nearest to the wanted one that some share of the yaw torque leaves room for; NaN if there is none.
    smallest, largest = _yaw_shares(thrust, lift, tilt, yaw, low, high)
    if smallest <= largest:
        return thrust
    # Each rotor's limits bound the thrust by lines p + k s of the share s: floors (the first four) and ceilings. Where the
    # wanted thrust has no room, the nearest that has is at s = 0, at s = 1 or where two lines cross.
    p, k = np.empty(8), np.empty(8)
    for i in range(4):
        p[i], p[4 + i] = (low - tilt[i]) / lift[i], (high - tilt[i]) / lift[i]
        k[i] = k[4 + i] = -yaw[i] / lift[i]
    nearest, gap = np.nan, np.inf
    for a in range(8):
        for b in range(a, 8):
            s = 0.0 if a == 0 else 1.0
            if b > a:
                s = (p[b] - p[a]) / (k[a] - k[b]) if k[a] != k[b] else -1.0
            if not 0.0 <= s <= 1.0:
                continue
            floor, ceiling = (p[:4] + k[:4] * s).max(), (p[4:] + k[4:] * s).min()
            candidate = max(min(thrust, ceiling), floor)
            if floor <= ceiling and abs(candidate - thrust) < gap:
                nearest, gap = candidate, abs(candidate - thrust)
    return nearest
