"""Thrust of fixed-pitch rotors that move through the air: momentum theory, at constant rotor speed and at constant power; compiled.

| symbol | name | unit |
|---|---|---|
| T, T₀ | thrust of a rotor; `static`, its thrust at rest under the same command | N |
| V_xy, V_n | `in_plane`, `axial`: velocity of the hub relative to the air, in the disc's plane and along the thrust | m/s |
| v_i, v_h | induced velocity; the same at rest, v_h = √(T₀/2ρA) | m/s |
| 2ρA | `disc`, twice the density times the area of the disc | kg/m |
| k | `slope`: relative loss of thrust per relative rise of the inflow v_i + V_n, at constant rotor speed | 1 |
| m | `advance`: relative gain of thrust over (V_xy/v_h)², by the faster air on the blades | 1 |

Glauert: v_i = T / (2ρA √(V_xy² + (V_n + v_i)²)) (I.1). With x = V_xy/v_h, c = V_n/v_h, w = v_i/v_h, t = T/T₀ that is
w √(x² + (w + c)²) = t. A blade element of lift slope a and a rotor of solidity σ give at constant speed
t = 1 + k (1 − w − c) + m x² (I.2), k = σa/(8λ), m = 1.5 (1 + k) λ², λ = v_h/ΩR; a constant shaft power, profile power
left out as constant, gives t (w + c) = 1 (I.3). Near hover (I.3) is (I.2) with k = 1 and m = 0.

Descent: (I.1) is no description of the vortex ring; V_n below −v_h/2 counts as −v_h/2.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

SLOWEST = -0.5
"""V_n/v_h below which momentum theory describes nothing any more."""


class Rotors(NamedTuple):
    """Equal rotors as (I.1) to (I.3) see them."""

    number: int
    static: float
    """Largest thrust of all rotors together at rest, N."""
    disc: float
    """2ρA of one rotor, kg/m."""
    slope: float
    """k of (I.2)."""
    advance: float
    """m of (I.2)."""

    @property
    def hover_inflow(self) -> float:
        """v_h at the largest static thrust, m/s."""
        return float(np.sqrt(self.static / (self.number * self.disc)))


def disc_of(radius: float, density: float) -> float:
    """2ρA, kg/m, of a rotor of `radius` m in air of `density` kg/m³."""
    return 2.0 * density * np.pi * radius**2


def advance_of(slope: float, inflow_ratio: float) -> float:
    """m of (I.2) for k = `slope` and λ = `inflow_ratio`, which a fixed-pitch rotor keeps at every speed."""
    return 1.5 * (1.0 + slope) * inflow_ratio**2


@njit(cache=True)
def factor_at_speed(static: float, in_plane: float, axial: float, disc: float, slope: float, advance: float) -> float:
    """t = T/T₀ of a rotor that keeps its speed. Source: (I.1), (I.2)."""
    if static <= 1e-3:
        return 1.0
    v_h = np.sqrt(static / disc)
    x, c, w = in_plane / v_h, max(axial / v_h, SLOWEST), 1.0
    most = 1.0 + slope * (1.0 - c) + advance * x * x
    if most <= 0.0:
        # The air drives the rotor.
        return 0.0
    for _ in range(50):
        s = np.sqrt(x * x + (w + c) * (w + c)) + 1e-300
        step = (w * s + slope * w - most) / (s + w * (w + c) / s + slope)
        w = max(w - step, 0.1 * w)
        if abs(step) < 1e-9:
            break
    return float(max(most - slope * w, 0.0))  # (I.2)


@njit(cache=True)
def factor_at_power(static: float, in_plane: float, axial: float, disc: float) -> float:
    """t = T/T₀ of a rotor whose shaft keeps its power. Source: (I.1), (I.3)."""
    if static <= 1e-3:
        return 1.0
    v_h = np.sqrt(static / disc)
    x, c = in_plane / v_h, max(axial / v_h, SLOWEST)
    # w s(w) (w + c) grows from 0 at w = max(0, −c): bracketed and halved where Newton leaves the bracket.
    low, high = max(0.0, -c), 2.0
    w = max(1.0, low + 0.1)
    for _ in range(80):
        s = np.sqrt(x * x + (w + c) * (w + c))
        f = w * s * (w + c) - 1.0
        low, high = (w, high) if f < 0.0 else (low, w)
        step = f / ((s + w * (w + c) / s) * (w + c) + w * s)
        if abs(step) < 1e-12:
            break
        new = w - step
        w = new if low < new < high else 0.5 * (low + high)
    return float(1.0 / (w + c))  # (I.3)


@njit(cache=True)
def factor(
    power: bool, static: float, in_plane: float, axial: float, disc: float, slope: float, advance: float
) -> float:
    """t, thrust over static thrust, 1, by (I.3) if `power`, else by (I.2)."""
    if power:
        return factor_at_power(static, in_plane, axial, disc)
    return factor_at_speed(static, in_plane, axial, disc, slope, advance)


@njit(cache=True)
def level_flight(
    speed: float, drag: float, power: bool, static: float, disc: float, slope: float, advance: float
) -> float:
    """Largest weight over the static thrust that flies level at `speed` m/s; `static` N and `disc` are of one rotor.

    The thrust is tilted by θ so that T sin θ holds the drag of `drag` N·s/m (of one rotor's share) and T cos θ the weight;
    the disc then moves at V sin θ along the thrust. 0 where no tilt holds the drag.
    """
    d = drag * speed / static
    # t sin θ − d grows with θ until the axial flow has eaten the thrust: the smallest root is what flies.
    low, high = 0.0, 0.0
    for i in range(1, 61):
        high = i * np.pi / 120.0
        if factor(power, static, speed * np.cos(high), speed * np.sin(high), disc, slope, advance) * np.sin(high) >= d:
            break
        low = high
    else:
        return 0.0
    for _ in range(50):
        tilt = 0.5 * (low + high)
        t = factor(power, static, speed * np.cos(tilt), speed * np.sin(tilt), disc, slope, advance)
        if t * np.sin(tilt) >= d:
            high = tilt
        else:
            low = tilt
    t = factor(power, static, speed * np.cos(high), speed * np.sin(high), disc, slope, advance)
    return float(t * np.cos(high))


def sustained(rotors: Rotors, speed: float, drag: float, power: bool = False) -> float:
    """Largest weight, N, that flies level at `speed` m/s against a linear drag of `drag` N·s/m, by (I.2) or at constant power."""
    one = rotors.static / rotors.number
    share = level_flight(speed, drag / rotors.number, power, one, rotors.disc, rotors.slope, rotors.advance)
    return share * rotors.static


def small_gain(rotors: Rotors, speed: float, drag: float, power: bool = False) -> float:
    """The first terms of `sustained`'s gain over the static thrust, 1, at `speed` m/s with `drag` N·s/m: what can be checked by hand.

    With u = V/v_h and δ = drag v_h / T₀: inflow gives k u²/(2(2 + k)), the faster air 2m u²/(2 + k), the climb along the tilted
    thrust costs k δu²/(2 + k), the tilt itself δ²u²/2.
    """
    k, m = (1.0, 0.0) if power else (rotors.slope, rotors.advance)
    u, d = speed / rotors.hover_inflow, drag * rotors.hover_inflow / rotors.static
    return u * u * ((0.5 * k + 2.0 * m - k * d) / (2.0 + k) - 0.5 * d * d)
