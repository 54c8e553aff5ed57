"""Closed forms of a capture: what the magnet's face, the hinge plate and the arm allow, without a simulation.

| symbol | name | unit |
|---|---|---|
| R, r | `plate_radius`, `pad_radius`: a pad that the plate does not cover pulls at nothing | m |
| F₀, g₀ | `rated_force`, `gap_scale`: pull F(g) = F₀/(1 + g/g₀)² | N, m |
| μ | `shear_share` | 1 |
| h | `drop`, pivot to the plate's face | m |
| T, x_r | `brake_s`, `reach`: the approach is braked as ẍ = −2ẋ/T − x/T² from x_r on | s, m |
| m, m_b, Λ | mass that flies, without the plate, the arm's effective mass along the approach | kg |
| c = R − r − d | clearance that an offset d leaves | m |

The controller's own idea of the gear, as its arm model is: the plant has its own. Source of the
numbers: facts E; T and x_r are assumptions.
"""

from typing import NamedTuple

import numpy as np

GATE_M = 0.003
"""Gap between pad and plate at which a capture is said to begin: the magnet closes it faster than a camera sample arrives."""


class Grip(NamedTuple):
    """What a capture depends on, as the ground knows it."""

    plate_radius: float = 0.022
    pad_radius: float = 0.015
    drop: float = 0.012
    rated_force: float = 177.0
    gap_scale: float = 0.2e-3
    shear_share: float = 0.2
    brake_s: float = 0.002
    reach: float = 2e-3


def covered_offset(grip: Grip, angle: float = 0.0) -> float:
    """Largest offset d in m towards `angle` rad from a pad at which the plate still covers all four pads.

    The pad opposite is left bare first: |d − p| = R with |p| = r; at worst, along a pad, d = R − r.
    """
    # Of four pads one lies within 45° of the point opposite.
    off = (angle + 0.25 * np.pi) % (0.5 * np.pi) - 0.25 * np.pi
    R, r = grip.plate_radius, grip.pad_radius
    return float(np.sqrt(R**2 - (r * np.sin(off)) ** 2) - r * np.cos(off))


def snap_speed(grip: Grip, mass: float, closing: float, gate: float, gap: float) -> float:
    """Approach speed in m/s at `gap` of a `mass` that passes the `gate` (m) at `closing` m/s: the magnet's work adds to it."""
    g0 = grip.gap_scale
    work = grip.rated_force * g0 * (1.0 / (1.0 + gap / g0) - 1.0 / (1.0 + gate / g0))
    return float(np.sqrt(max(closing, 0.0) ** 2 + 2.0 * work / mass))


def closing_time(grip: Grip, mass: float, closing: float, gate: float, touching: float = 2e-5) -> float:
    """Time, s, from the `gate`, m, passed at `closing` m/s, to a gap of `touching` m.

    ∫ dg / v(g), v by the magnet's work until the brake allows no more than g/(2T).
    """
    edges = np.geomspace(touching, gate, 200)
    middle = np.sqrt(edges[1:] * edges[:-1])
    v = np.array([min(max(snap_speed(grip, mass, closing, gate, g), 1e-3), 0.5 * g / grip.brake_s) for g in middle])
    return float(np.sum(np.diff(edges) / v))


def lateral_speed_bound(grip: Grip, mass: float, closing: float, gate: float, offset: float = 0.0) -> float:
    """Largest lateral speed v, m/s, at the `gate`, m, passed at `closing` m/s: moving until contact and sliding fit the clearance.

    v t + m v²/(2 μ F₀) = c; 0 where there is no clearance.
    """
    c = covered_offset(grip) - offset
    if c <= 0.0:
        return 0.0
    t, a = closing_time(grip, mass, closing, gate), slide(grip, mass, 1.0)
    return float((-t + np.sqrt(t * t + 4.0 * a * c)) / (2.0 * a))


def hinge_impact(grip: Grip, mass: float, body: float, arm: float, closing: float, gate: float) -> float:
    """Largest hinge force, N, as a `mass`, kg, that passes the `gate`, m, at `closing` m/s is braked on an arm of mass `arm`, kg.

    The brake is critically damped. It begins where 2ẋ/T = x/T², and ẍ is largest, v/(e T), a time T later; an approach that is
    too fast for that meets it at its reach x_r with ẍ = 2v/T − x_r/T². The hinge moves `body`, the share m_b/m of what flies.
    """
    T, together = grip.brake_s, mass * arm / (mass + arm)
    onset = min(2.0 * T * max(closing, 0.0), grip.reach)
    v = snap_speed(grip, together, closing, gate, max(onset, grip.gap_scale))
    a = max(v / (np.e * T), 2.0 * v / T - grip.reach / T**2)
    return float(body / mass * together * a)


def closing_speed_bound(grip: Grip, mass: float, body: float, arm: float, force: float, gate: float) -> float:
    """Largest closing speed, m/s, at the `gate`, m, whose impact stays below `force` N; 0 where the magnet's own snap exceeds it.

    Masses `mass`, `body` and `arm`, kg, as in `hinge_impact`.
    """
    low, high = 0.0, 10.0
    if hinge_impact(grip, mass, body, arm, low, gate) > force:
        return 0.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if hinge_impact(grip, mass, body, arm, middle, gate) < force else (low, middle)
    return low


def covered_tilt(grip: Grip, offset: float = 0.0) -> float:
    """Largest tilt θ in rad of a plate about its pivot at which its lower edge still reaches a pad: R cos θ − h sin θ = r + d."""
    a = np.hypot(grip.plate_radius, grip.drop)
    need = grip.pad_radius + offset
    if need >= grip.plate_radius:
        return 0.0
    return float(np.arccos(need / a) - np.arctan2(grip.drop, grip.plate_radius))


def righting(acceleration: float, lag: float, time: float) -> tuple[float, float]:
    """Displacement, m, and speed, m/s, of a pivot after `time` s under an `acceleration`, m/s², that lags by `lag` s."""
    fade = 1.0 - np.exp(-time / lag)
    return float(acceleration * (0.5 * time**2 - lag * (time - lag * fade))), float(acceleration * (time - lag * fade))


def slide(grip: Grip, mass: float, speed: float) -> float:
    """Distance in m over which the magnet's friction stops a `mass` that slides at `speed` m/s: m v²/(2 μ F₀)."""
    return mass * speed**2 / (2.0 * grip.shear_share * grip.rated_force)
