"""Attitude and rate sensor on board the UAV.

| symbol | name | unit, frame |
|---|---|---|
| b | `bias` (4,): q_imu = b ⊗ q_true ⊗ noise: heading and tilt that the UAV gets wrong | 1, W |
| ω₀ | `rate_bias` (3,) | rad/s, B |
| | `drift`: rate at which the heading that it believes runs away | rad/s |
"""

import numpy as np
from numba import njit

from armland.records import Record, Records
from armland.rotations import Array, from_rotation_vector, multiply
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
        ]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the sensor keeps: its newest sample, attitude and rates."""
    return np.dtype([("quat", "f8", (4,)), ("rate", "f8", (3,))])


def tell(told: Records, scenario: Scenario, bias: Array, noisy: bool) -> None:
    """Fill `told` (1,); `bias` (4,) as above, `noisy` says whether there is white noise."""
    told["period"], told["bias"] = scenario.run.rate_hz // scenario.onboard.rate_hz, bias
    told["tick_s"] = 1.0 / scenario.run.rate_hz
    if noisy:
        told["sigma_attitude"], told["sigma_rate"] = scenario.sensors.attitude_rad, scenario.sensors.rate_rad_s


@njit(cache=True)
def sample(k: int, told: Record, kept: Record, noise: Array, t: Record) -> None:
    """Sample attitude and rates, where tick `k` is one of the sensor's.

    Args:
        k: present tick.
        told: of `told_layout`.
        kept: of `kept_layout`, written.
        noise: standard normal numbers (6,).
        t: truth, of which `quat` and `omega` are read.
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
