"""A UAV too heavy to hover, thrown by the arm: may it gain what forward flight lifts more before it has lost its height? Point mass.

| symbol | name | unit |
|---|---|---|
| x, z; ẋ, ż | along the throw and upwards | m, m/s |
| θ | tilt of the thrust towards x | rad |
| W, c | `weight`, linear drag, horizontal | N, N·s/m |

(W/g) ẍ = T sin θ − c ẋ, (W/g) z̈ = T cos θ − W, T at full command by `models.inflow`. The pilot tilts by one angle until he has one
speed, then by what holds the drag: over all pairs of a grid that is a lower bound of what any pilot can do. No pilot can do
better for long than the heaviest UAV that flies level at any speed.
"""

import numpy as np
from numba import njit

from armland.models.inflow import Rotors, factor, level_flight
from armland.models.uav import GRAVITY
from armland.rotations import Array

TILTS = np.array([0.0, 0.03, 0.06, 0.1, 0.14, 0.2, 0.28, 0.4])
"""rad, while it gains speed."""

TARGETS = np.array([0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0])
"""m/s, at which it stops gaining speed."""

ELEVATIONS = np.deg2rad([0.0, 15.0, 30.0, 45.0, 60.0, 90.0])
"""Of the throw above the horizon."""

LAG_S = 0.15
"""With which the tilt follows: attitude loop and rotors."""

STEP_S, HORIZON_S = 0.01, 12.0


@njit(cache=True)
def survives(
    share: float,
    speed: float,
    elevation: float,
    height: float,
    tilt: float,
    target: float,
    drag: float,
    power: bool,
    count: int,
    static: float,
    disc: float,
    slope: float,
    advance: float,
) -> bool:
    """Whether a UAV of `share` times the static thrust never sinks `height` m below its release and no longer sinks at the end."""
    one, weight = static / count, share * static
    x, z, rise, theta = speed * np.cos(elevation), 0.0, speed * np.sin(elevation), 0.0
    for _ in range(int(HORIZON_S / STEP_S)):
        wanted = tilt if x < target else drag * x / weight
        theta += STEP_S / LAG_S * (wanted - theta)
        sine, cosine = np.sin(theta), np.cos(theta)
        t = factor(power, one, abs(x * cosine - rise * sine), x * sine + rise * cosine, disc, slope, advance) * static
        x += STEP_S * GRAVITY * (t * sine - drag * x) / weight
        rise += STEP_S * GRAVITY * (t * cosine / weight - 1.0)
        z += STEP_S * rise
        if z < -height:
            return False
    return rise >= -1e-3


@njit(cache=True)
def _heaviest(
    speed: float,
    elevation: float,
    height: float,
    tilts: Array,
    targets: Array,
    drag: float,
    power: bool,
    count: int,
    static: float,
    disc: float,
    slope: float,
    advance: float,
) -> float:
    low, high = 0.9, 1.3
    for _ in range(11):
        middle, possible = 0.5 * (low + high), False
        for tilt in tilts:
            for target in targets:
                possible = survives(
                    middle, speed, elevation, height, tilt, target, drag, power, count, static, disc, slope, advance
                )
                if possible:
                    break
            if possible:
                break
        low, high = (middle, high) if possible else (low, middle)
    return low


def heaviest_thrown(
    rotors: Rotors, speed: float, height: float, drag: float, power: bool = False
) -> tuple[float, float]:
    """Largest weight over the static thrust that flies off after a throw at `speed` m/s, and the throw's best elevation, rad.

    Args:
        rotors: of the UAV.
        speed: that the arm gives, m/s.
        height: that may be lost, m.
        drag: linear, horizontal, N·s/m.
        power: constant power instead of constant rotor speed.
    """
    r = rotors
    found = [
        _heaviest(speed, e, height, TILTS, TARGETS, drag, power, r.number, r.static, r.disc, r.slope, r.advance)
        for e in (ELEVATIONS if speed > 0.0 else ELEVATIONS[:1])
    ]
    best = int(np.argmax(found))
    return found[best], float(ELEVATIONS[best])


def heaviest_at_any_speed(rotors: Rotors, drag: float, power: bool = False) -> tuple[float, float]:
    """Largest weight over the static thrust that flies level, and the speed at which it does, m/s."""
    speeds = np.linspace(0.0, 20.0, 401)
    one = rotors.static / rotors.number
    share = [
        level_flight(v, drag / rotors.number, power, one, rotors.disc, rotors.slope, rotors.advance) for v in speeds
    ]
    best = int(np.argmax(share))
    return float(share[best]), float(speeds[best])


def speed_for_gain(rotors: Rotors, gain: float, drag: float, power: bool = False) -> float | None:
    """Smallest speed, m/s, at which the rotors carry 1 + `gain` times their static thrust in level flight; None: at none."""
    speeds = np.linspace(0.0, 40.0, 4001)
    one = rotors.static / rotors.number
    for v in speeds:
        if level_flight(v, drag / rotors.number, power, one, rotors.disc, rotors.slope, rotors.advance) >= 1.0 + gain:
            return float(v)
    return None
