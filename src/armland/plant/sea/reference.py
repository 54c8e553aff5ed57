"""Motion reference unit on the deck, at the arm's base: attitude, rates, velocity and acceleration, late, biased and noisy.

| symbol | name | unit, frame |
|---|---|---|
| b | `bias` (4,): q_mru = q_true ⊗ b, what alignment and filter leave wrong | 1, D |
| | `rate_bias`, `v_bias`, `a_bias` (3,) | rad/s, m/s, m/s², D |
| σ | `sigma` (4,) of attitude, rates, velocity, acceleration, of one sample | rad, rad/s, m/s, m/s² |

Acceleration is that of the deck's origin in its own axes, gravity taken off by the attitude that the unit believes.
"""

import numpy as np
from numba import njit

from armland.errors import ConfigurationError
from armland.plant.noise import stream
from armland.plant.scene.composition import Scene
from armland.records import Record, Records
from armland.rotations import Array, from_rotation_vector, matrix, multiply, turned_back
from armland.scenario import Scenario

RING = 64
"""Samples that are under way."""

SAMPLE = np.dtype([("quat", "f8", (4,)), ("rate", "f8", (3,)), ("v", "f8", (3,)), ("a", "f8", (3,)), ("tick", "i8")])


def told_layout(joints: int) -> np.dtype:
    """What the unit is told."""
    biases = [(name, "f8", (3,)) for name in ("rate_bias", "v_bias", "a_bias", "gravity")]
    return np.dtype(
        [("fitted", "i8"), ("period", "i8"), ("late", "i8"), ("bias", "f8", (4,)), *biases, ("sigma", "f8", (4,))]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the unit keeps: its samples, and how many it has taken and given."""
    return np.dtype([("ring", SAMPLE, (RING,)), ("taken", "i8"), ("given", "i8")])


def tell(told: Records, scenario: Scenario, scene: Scene, noisy: bool) -> None:
    """Fill `told` (1,); on land there is none. `noisy` says whether there are noise and biases.

    Raises:
        ConfigurationError: more samples under way than there is room for.
    """
    if scene.deck_dof < 0:
        return
    u, rate = scenario.motion_reference, scenario.run.rate_hz
    told["fitted"], told["period"], told["late"] = 1, rate // u.rate_hz, round(u.delay_ms * rate / 1000.0)
    if told["late"][0] >= (RING - 1) * told["period"][0]:
        raise ConfigurationError(
            f"motion_reference.delay_ms = {u.delay_ms:g}: at {u.rate_hz} Hz at most {1000.0 * (RING - 1) / u.rate_hz:g} ms "
            "can be under way"
        )
    told["bias"][0, 0], told["gravity"] = 1.0, scenario.environment.gravity_mps2
    if not noisy:
        return
    # Twice a standard deviation at most, each axis by itself.
    drawn = np.clip(stream(scenario.run.seed, "reference.bias").standard_normal(12), -2.0, 2.0)
    told["bias"] = from_rotation_vector(np.deg2rad([u.tilt_deg, u.tilt_deg, u.heading_deg]) * drawn[:3])
    told["rate_bias"], told["v_bias"] = np.deg2rad(u.rate_bias_deg_s) * drawn[3:6], u.velocity_mps * drawn[6:9]
    told["a_bias"] = u.acceleration_bias_mps2 * drawn[9:12]
    told["sigma"] = (
        np.deg2rad(u.tilt_noise_deg),
        np.deg2rad(u.rate_noise_deg_s),
        u.velocity_noise_mps,
        u.acceleration_noise_mps2,
    )


@njit(cache=True)
def sample(k: int, told: Record, kept: Record, noise: Array, m: Record, t: Record) -> None:
    """Take a sample where it is time, and put what arrives into the measurement.

    Args:
        k: present tick.
        told: of `told_layout`, of a unit that is fitted.
        kept: of `kept_layout`, updated.
        noise: standard normal numbers (12,).
        m: measurement, whose fields of the deck are written.
        t: truth of the tick.
    """
    if k % told.period == 0:
        _take(k, told, kept.ring[kept.taken % RING], noise, t)
        kept.taken += 1
    while kept.given < kept.taken and (kept.given == 0 or kept.ring[kept.given % RING].tick + told.late <= k):
        # The first one is known from before the run.
        row = kept.ring[kept.given % RING]
        m.deck_known, m.deck_tick = 1, row.tick
        m.deck_quat, m.deck_rate, m.deck_v, m.deck_a = row.quat, row.rate, row.v, row.a
        kept.given += 1


@njit(cache=True)
def _take(k: int, told: Record, row: Record, noise: Array, t: Record) -> None:
    tilt, felt = np.empty(3), np.empty(3)
    for i in range(3):
        tilt[i] = told.sigma[0] * noise[i]
        felt[i] = t.deck_a[i] - told.gravity[i]
    R = matrix(t.deck_quat)
    quat = multiply(multiply(t.deck_quat, told.bias), from_rotation_vector(tilt))
    rate, v, f = turned_back(R, t.deck_omega), turned_back(R, t.deck_v), turned_back(R, felt)
    believed = turned_back(matrix(quat), told.gravity)
    row.tick = k
    for i in range(4):
        row.quat[i] = quat[i]
    for i in range(3):
        row.rate[i] = rate[i] + told.rate_bias[i] + told.sigma[1] * noise[3 + i]
        row.v[i] = v[i] + told.v_bias[i] + told.sigma[2] * noise[6 + i]
        row.a[i] = f[i] + believed[i] + told.a_bias[i] + told.sigma[3] * noise[9 + i]
