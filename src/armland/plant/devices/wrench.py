"""Force-torque sensor between flange and tool: cross-talk, bias, drift, white noise, and a first-order low-pass.

| symbol | name | unit, frame |
|---|---|---|
| w | true force and torque of the flange on the tool (6,) | N, N·m, sensor |
| G | `gain` (6, 6): 1 on the diagonal is a calibrated channel, what stands beside it is cross-talk | 1, m, 1/m |
| b, ḃ | `bias` (6,), `drift` (6,) | N, N·m; N/s, N·m/s |
| α | `filter_gain`: share of a step that the low-pass makes in one tick | 1 |
| β | `faults.bridge`: what the strain gauges give of what they should; 1 where they are well | 1 |

y ← y + α (β G w + b + ḃ t + noise − y); the first sample starts the filter where the sensor is.
"""

import numpy as np
from numba import njit

from armland.plant.scene.composition import Scene
from armland.records import Record, Records
from armland.rotations import Array
from armland.scenario import Scenario


def told_layout(joints: int) -> np.dtype:
    """What the sensor is told."""
    return np.dtype(
        [
            ("at_force", "i8"),
            ("at_torque", "i8"),
            ("gain", "f8", (6, 6)),
            ("bias", "f8", (6,)),
            ("drift", "f8", (6,)),
            ("sigma", "f8", (6,)),
            ("filter_gain", "f8"),
            ("tick_s", "f8"),
        ]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the sensor keeps."""
    return np.dtype([("filtered", "f8", (6,)), ("filtering", "i8")])


def tell(told: Records, scenario: Scenario, scene: Scene, bias: Array, noisy: bool) -> None:
    """Fill `told` (1,); `bias` (6,) N, N·m comes on top of the scenario's, `noisy` says whether there is white noise."""
    s, rate = scenario.sensors, scenario.run.rate_hz
    told["at_force"], told["at_torque"] = scene.sensor["force"], scene.sensor["torque"]
    told["gain"] = np.eye(6)
    told["bias"] = bias + np.concatenate([s.force_bias_n, s.torque_bias_nm])
    told["filter_gain"] = 1.0 - np.exp(-2.0 * np.pi * s.force_filter_hz / rate)
    told["tick_s"] = 1.0 / rate
    if noisy:
        told["sigma"] = 3 * [s.force_n] + 3 * [s.torque_nm]


@njit(cache=True)
def sample(k: int, data: Array, told: Record, kept: Record, faults: Record, noise: Array, m: Record) -> None:
    """Sample the sensor into the measurement `m`.

    Args:
        k: present tick.
        data: MuJoCo's `sensordata` (nsensordata,), in the units of each sensor: m, rad, N, 1 for quaternions.
        told: of `told_layout`.
        kept: of `kept_layout`, updated.
        faults: what fails, of `faults.table.kept_layout`.
        noise: standard normal numbers (6,).
        m: `wrench` N, N·m and `wrench_tick` are written.
    """
    gain = told.filter_gain if kept.filtering else 1.0
    kept.filtering = 1
    for i in range(6):
        raw = 0.0
        for j in range(3):
            raw += told.gain[i, j] * data[told.at_force + j]
        for j in range(3):
            raw += told.gain[i, 3 + j] * data[told.at_torque + j]
        raw *= faults.bridge
        raw += told.bias[i] + told.sigma[i] * noise[i]
        raw += told.drift[i] * (k * told.tick_s)
        if i == 2:
            raw += faults.drift
        kept.filtered[i] += gain * (raw - kept.filtered[i])
        if not faults.wrench_frozen:
            m.wrench[i] = kept.filtered[i]
    if not faults.wrench_frozen:
        m.wrench_tick = k
