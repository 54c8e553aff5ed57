"""Attitude, rate and acceleration sensors on board the UAV.

| symbol | name | unit, frame |
|---|---|---|
| b | `bias` (4,): q_imu = b ⊗ q_true ⊗ noise: heading and tilt that the UAV gets wrong | 1, W |
| ω₀ | `rate_bias` (3,) | rad/s, B |
| | `drift`: rate at which the heading that it believes runs away | rad/s |
| f | `force` (3,) = Rᵀ((v − v′)/T − g) + bias + noise: specific force, mean over a sample; v′ a sample, T, before | m/s², B |
"""

import numpy as np
from numba import njit

from armland.plant.draw import Draw
from armland.records import Record, Records
from armland.rotations import Array, from_rotation_vector, matrix, multiply
from armland.scenario import Scenario


def told_layout(joints: int) -> np.dtype:
    """What the sensor is told."""
    return np.dtype(
        [
            ("period", "i8"),  # ticks
            ("sigma_attitude", "f8"),  # rad
            ("sigma_rate", "f8"),  # rad/s
            ("bias", "f8", (4,)),
            ("rate_bias", "f8", (3,)),
            ("drift", "f8"),
            ("tick_s", "f8"),
            ("sigma_force", "f8"),  # m/s²
            ("force_bias", "f8", (3,)),
            ("gravity", "f8", (3,)),  # m/s², W
        ]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the sensor keeps: its newest sample, attitude, rates and specific force, and the velocity, m/s, W, at it."""
    return np.dtype([("quat", "f8", (4,)), ("rate", "f8", (3,)), ("force", "f8", (3,)), ("before", "f8", (3,))])


def tell(told: Records, scenario: Scenario, drawn: Draw, noisy: bool) -> None:
    """Fill `told` (1,); `drawn` has the biases, `noisy` says whether there is white noise."""
    told["period"], told["bias"] = scenario.run.rate_hz // scenario.onboard.rate_hz, drawn.imu_bias
    told["tick_s"], told["force_bias"] = 1.0 / scenario.run.rate_hz, drawn.force_bias
    told["gravity"] = scenario.environment.gravity_mps2
    if noisy:
        told["sigma_force"] = scenario.sensors.acceleration_mps2
        told["sigma_attitude"], told["sigma_rate"] = scenario.sensors.attitude_rad, scenario.sensors.rate_rad_s


@njit(cache=True)
def sample(k: int, told: Record, kept: Record, noise: Array, shaken: Array, t: Record) -> None:
    """Sample attitude, rates and specific force, where tick `k` is one of the sensor's.

    Args:
        k: present tick.
        told: of `told_layout`.
        kept: of `kept_layout`, written.
        noise: standard normal numbers (6,).
        shaken: standard normal numbers (3,), of the specific force.
        t: truth, of which `quat`, `omega` and `v_cm` are read.
    """
    if k % told.period:
        return
    tilt = np.empty(3)
    for i in range(3):
        tilt[i] = told.sigma_attitude * noise[i]
        kept.rate[i] = t.omega[i] + told.rate_bias[i] + told.sigma_rate * noise[3 + i]
    quat = multiply(multiply(told.bias, t.quat), from_rotation_vector(tilt))
    if told.drift != 0.0:
        quat = multiply(from_rotation_vector(np.array([0.0, 0.0, told.drift * told.tick_s * k])), quat)
    for i in range(4):
        kept.quat[i] = quat[i]
    _feel(k, told, kept, shaken, t)


@njit(cache=True)
def _feel(k: int, told: Record, kept: Record, shaken: Array, t: Record) -> None:
    R, span, push = matrix(t.quat), told.period * told.tick_s, np.empty(3)
    for i in range(3):
        # Nothing is known from before the first sample: then it hovers.
        push[i] = (t.v_cm[i] - kept.before[i]) / span - told.gravity[i] if k > 0 else -told.gravity[i]
        kept.before[i] = t.v_cm[i]
    for i in range(3):
        along = R[0, i] * push[0] + R[1, i] * push[1] + R[2, i] * push[2]
        kept.force[i] = along + told.force_bias[i] + told.sigma_force * shaken[i]
