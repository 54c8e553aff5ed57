"""The air around the UAV: wind and turbulence, gusts, ground effect over floor and cradle, downwash on the arm's tool; compiled.

| symbol | name | unit, frame |
|---|---|---|
| v_a = v̄ + g + w + f | `velocity` (3,); v̄ `mean`, g `gust` of a deviation, w of `[air]`, f a fault's `wind` (3,) | m/s, W |
| u, v, w | turbulence along the mean wind, across it, upwards: `along`, `across` (2,), `up` (2,), states of `wind.dryden` | 1 |
| σ, T | `sigma` (3,) of the gusts, their correlation time in `hold` = e^(−Δt/T) | m/s, 1 |
| κ | `lift`: thrust near the ground over thrust far from it | 1 |
| R, z | `radius` of a rotor, height of the rotors above floor or rails | m |

g ← h g + σ √(1 − h²) ν, which keeps its variance whatever the step, and begins with it. κ = 1 + e ((1 − (R/4z)²)⁻¹ − 1) (Cheeseman
and Bennett), valid from z = R/2; of the cradle only the share of the rotors' discs counts that lies above its rails.
The wind of `[air]` follows its profile up to the UAV's height; turbulence keeps its axes, which are the mean wind's.
Downwash: a share of the thrust presses on the tool while it is below the rotors.
"""

import numpy as np
from numba import njit

from armland.models.parameters import rotor_set
from armland.plant.scene.composition import Scene
from armland.plant.wind.dryden import W20_MPS, across_step, along_step, intensities, lengths
from armland.plant.wind.profile import (
    PROFILES,
    W20_AT_M,
    height_of_catch,
    mean_speed,
    passing_speed,
    speed_at,
    towards,
)
from armland.records import Record, Records
from armland.rotations import Array, matrix
from armland.scenario import Scenario

CORRELATED_S = 1.0
"""Correlation time of the gusts. Assumption."""

OVER_RAILS = 0.15
"""Share of the rotors' discs above the rails: two tubes of 24 mm below two rotors each of 0.2 m diameter."""

BELOW_RADII = 6.0
"""How far below the UAV's centre of mass the tool is reached by downwash, in radii of a rotor; beside it, as far as the rotors' hubs.
Assumption. Both edges are as soft as a rotor's radius is wide, as a wake's are that mixes with the air around it."""


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
            ("rails", "f8"),  # m, height of rails or pad; −∞ where there are none
            ("over", "f8"),  # share of the rotors' discs above them
            ("wash", "f8"),  # share of the thrust on the tool
            ("beside", "f8"),  # m, horizontal, of the farthest rotor's hub from the centre of mass
            ("blows", "i8"),  # whether `[air]` has any wind
            ("profile", "i8"),  # number in `wind.profile.PROFILES`
            ("speed", "f8"),  # m/s, at `reference`
            ("reference", "f8"),  # m
            ("roughness", "f8"),  # m
            ("exponent", "f8"),
            ("floor", "f8"),  # m, height of z = 0
            ("towards", "f8", (3,)),
            ("strength", "f8", (3,)),  # m/s, of turbulence: along, across, up
            ("along", "f8", (2,)),  # share of the state that is left after a tick, weight of fresh noise
            ("across", "f8", (2, 2)),
            ("across_root", "f8", (2, 2)),
            ("up", "f8", (2, 2)),
            ("up_root", "f8", (2, 2)),
        ]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the air is like."""
    turbulence = [("along", "f8"), ("across", "f8", (2,)), ("up", "f8", (2,))]
    return np.dtype([("begun", "i8"), ("velocity", "f8", (3,)), ("gust", "f8", (3,)), ("lift", "f8"), *turbulence])


def tell(told: Records, scenario: Scenario, scene: Scene) -> None:
    """Fill `told` (1,): still air but for what `[air]` says."""
    told["hold"] = np.exp(-1.0 / (scenario.run.rate_hz * CORRELATED_S))
    told["radius"] = scenario.rotors.radius_m
    told["beside"] = np.hypot(*rotor_set(scenario).place[:, :2].T).max()
    told["rails"], told["over"] = -np.inf, OVER_RAILS
    if "cradle" in scene.parts:
        told["rails"] = scene.model.body("cradle").pos[2]
    elif "pad" in scene.parts:
        told["rails"], told["over"] = scene.model.body("pad").pos[2], 1.0
    if scenario.air.blows:
        tell_wind(told, scenario)


def tell_wind(told: Records, scenario: Scenario) -> None:
    """Fill `told` (1,) with the wind of `[air]`, which turbulence and gusts of the catch's height are carried by."""
    a, height, tick_s = scenario.air, height_of_catch(scenario), 1.0 / scenario.run.rate_hz
    told["blows"] = told["moves"] = 1
    told["profile"], told["speed"], told["reference"] = PROFILES.index(a.profile), a.wind_mps, a.reference_m
    told["roughness"], told["exponent"], told["floor"] = a.roughness_m, a.exponent, a.floor_m
    told["towards"] = towards(scenario)
    if a.turbulence != "none":
        w20 = W20_MPS.get(a.turbulence, speed_at(scenario, W20_AT_M))
        told["strength"] = intensities(w20, height)
    along, across, up = passing_speed(scenario) * tick_s / lengths(height)
    told["along"] = along_step(along)
    told["across"][0], told["across_root"][0] = across_step(across)
    told["up"][0], told["up_root"][0] = across_step(up)


@njit(cache=True)
def blow(told: Record, kept: Record, faults: Record, given: tuple[Array, Array, Array], t: Record) -> None:
    """One tick.

    Args:
        told: of `told_layout`.
        kept: of `kept_layout`, updated.
        faults: what fails, of `faults.table.kept_layout`: its wind comes on top, m/s, W.
        given: standard normal numbers (3,) of the gusts and (5,) of the turbulence; wind (3,) that is known by the clock, m/s, W.
        t: truth of the tick.
    """
    noise, fresh, known = given
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
    if told.blows:
        _blow_on(told, kept, fresh, known, t)
    kept.begun = 1
    if told.ground > 0.0:
        height, R = 0.0, matrix(t.deck_quat)
        for i in range(3):
            height += R[i, 2] * (t.r_cm[i] - t.deck[i])
        near = gain(height, told.radius)
        if np.isfinite(told.rails):
            near += told.over * gain(height - told.rails, told.radius)
        kept.lift += told.ground * near


@njit(cache=True)
def _blow_on(told: Record, kept: Record, fresh: Array, known: Array, t: Record) -> None:
    # Mean wind and turbulence along their own axes, and what is known by the clock.
    speed = mean_speed(told.floor + t.r_cm[2], told.profile, told.speed, told.reference, told.roughness, told.exponent)
    kept.along = told.along[0] * kept.along + told.along[1] * fresh[0] if kept.begun else fresh[0]
    across = _turned_over(told.across, told.across_root, kept.across, fresh[1], fresh[2], kept.begun)
    up = _turned_over(told.up, told.up_root, kept.up, fresh[3], fresh[4], kept.begun)
    u, v = speed + told.strength[0] * kept.along, told.strength[1] * across
    kept.velocity[0] += told.towards[0] * u - told.towards[1] * v + known[0]
    kept.velocity[1] += told.towards[1] * u + told.towards[0] * v + known[1]
    kept.velocity[2] += told.strength[2] * up + known[2]


@njit(cache=True)
def _turned_over(step: Array, root: Array, state: Array, a: float, b: float, begun: int) -> float:
    # One tick of the second filter of `wind.dryden`; begins with its stationary covariance.
    x, y = 0.5 * a, 0.5 * b
    if begun:
        x = step[0, 0] * state[0] + step[0, 1] * state[1] + root[0, 0] * a
        y = step[1, 0] * state[0] + step[1, 1] * state[1] + root[1, 0] * a + root[1, 1] * b
    state[0], state[1] = x, y
    return float(x + np.sqrt(3.0) * y)


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
    beside = np.sqrt((t.r_cm[0] - t.ee[0]) ** 2 + (t.r_cm[1] - t.ee[1]) ** 2) / told.radius
    below = (t.r_cm[2] - t.ee[2]) / told.radius
    down = _inside(below - 0.5) * _inside(BELOW_RADII - below)
    applied[2] -= told.wash * thrust * down * _inside(told.beside / told.radius - beside)


@njit(cache=True)
def _inside(radii: float) -> float:
    # Share that acts so many radii within an edge: ½ on it, all from half a radius on.
    return min(max(0.5 + radii, 0.0), 1.0)
