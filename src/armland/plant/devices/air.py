"""The air around the UAV: mean wind, gusts, ground effect over floor and cradle, downwash on the arm's tool; compiled.

| symbol | name | unit, frame |
|---|---|---|
| v_a = v̄ + g + f | `velocity` (3,); v̄ `mean`, g `gust`, f a fault's `wind` (3,) | m/s, W |
| σ, T | `sigma` (3,) of the gusts, their correlation time in `hold` = e^(−Δt/T) | m/s, 1 |
| κ | `lift`: thrust near the ground over thrust far from it | 1 |
| R, z | `radius` of a rotor, height of the rotors above floor or rails | m |

g ← h g + σ √(1 − h²) ν, which keeps its variance whatever the step, and begins with it. κ = 1 + e ((1 − (R/4z)²)⁻¹ − 1) (Cheeseman
and Bennett), valid from z = R/2; of the cradle only the share of the rotors' discs counts that lies above its rails.
Downwash: a share of the thrust presses on the tool while it is below the UAV.
"""

import numpy as np
from numba import njit

from armland.plant.scene.composition import Scene
from armland.records import Record, Records
from armland.rotations import Array
from armland.scenario import Scenario

CORRELATED_S = 1.0
"""Correlation time of the gusts. Assumption."""

OVER_RAILS = 0.15
"""Share of the rotors' discs above the rails: two tubes of 24 mm below two rotors each of 0.2 m diameter."""

BESIDE_M, BELOW_M = 0.12, 0.6
"""How far beside and below the UAV's centre of mass the tool is reached by downwash: as far as the rotors' hubs; six radii."""


def told_layout(joints: int) -> np.dtype:
    """What the air is told."""
    return np.dtype(
        [
            ("moves", "i8"),  # 0: still air, no effect of the ground
            ("mean", "f8", (3,)),
            ("sigma", "f8", (3,)),
            ("hold", "f8"),
            ("ground", "f8"),  # e: share of the ground's effect
            ("radius", "f8"),
            ("rails", "f8"),  # m, height of the rails; −∞ where there are none
            ("wash", "f8"),  # share of the thrust on the tool
        ]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the air is like."""
    return np.dtype([("begun", "i8"), ("velocity", "f8", (3,)), ("gust", "f8", (3,)), ("lift", "f8")])


def tell(told: Records, scenario: Scenario, scene: Scene) -> None:
    """Fill `told` (1,) for still air."""
    told["hold"] = np.exp(-1.0 / (scenario.run.rate_hz * CORRELATED_S))
    told["radius"] = scenario.rotors.radius_m
    told["rails"] = scene.model.body("cradle").pos[2] if "cradle" in scene.parts else -np.inf


@njit(cache=True)
def blow(told: Record, kept: Record, faults: Record, noise: Array, t: Record) -> None:
    """One tick.

    Args:
        told: of `told_layout`.
        kept: of `kept_layout`, updated.
        faults: what fails, of `faults.table.kept_layout`: its wind comes on top, m/s, W.
        noise: standard normal numbers (3,).
        t: truth of the tick.
    """
    kept.lift = 1.0
    for i in range(3):
        kept.velocity[i] = faults.wind[i]
    if not told.moves:
        return
    for i in range(3):
        if kept.begun:
            kept.gust[i] = told.hold * kept.gust[i] + told.sigma[i] * np.sqrt(1.0 - told.hold**2) * noise[i]
        else:
            kept.gust[i] = told.sigma[i] * noise[i]
        kept.velocity[i] += told.mean[i] + kept.gust[i]
    kept.begun = 1
    if told.ground > 0.0:
        near = gain(t.r_cm[2], told.radius)
        if np.isfinite(told.rails):
            near += OVER_RAILS * gain(t.r_cm[2] - told.rails, told.radius)
        kept.lift += told.ground * near


@njit(cache=True)
def gain(height: float, radius: float) -> float:
    """Relative gain of thrust at `height`, m, above a plane, of rotors of `radius`, m: 1/(1 − (R/4z)²) − 1."""
    z = max(height, 0.5 * radius)
    ratio = (radius / (4.0 * z)) ** 2
    return float(ratio / (1.0 - ratio))


@njit(cache=True)
def wash(told: Record, thrust: float, t: Record, applied: Array) -> None:
    """Let the downwash press on the tool.

    Args:
        told: of `told_layout`.
        thrust: N, of all rotors.
        t: truth of the tick.
        applied: MuJoCo's row (6,) of `xfrc_applied` of the tool, N, N·m, W, added to.
    """
    beside = np.sqrt((t.r_cm[0] - t.ee[0]) ** 2 + (t.r_cm[1] - t.ee[1]) ** 2)
    below = t.r_cm[2] - t.ee[2]
    if 0.0 < below < BELOW_M and beside < BESIDE_M:
        applied[2] -= told.wash * thrust
