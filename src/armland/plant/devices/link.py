"""The wireless link between ground and UAV: two delay lines with one length, lateness and loss.

Upwards the command of every tick is sent and the UAV takes, at each of its samples, the one that has been under way for the
delay. Downwards the UAV's sample of every link period is sent. No message overtakes another: what is older than what has
arrived is dropped.

| name | what | unit |
|---|---|---|
| `up`, `down` | delay | ticks |
| `jitter_up`, `jitter_down` | largest further delay, drawn anew at every tick | ticks |
| `loss_up`, `loss_down` | probability that a message is lost | 1 |
"""

import numpy as np
from numba import njit

from armland.errors import ConfigurationError
from armland.plant.noise import uniform
from armland.records import Record, Records
from armland.rotations import Array
from armland.scenario import Scenario

RING = 1024
"""Length of the delay lines in ticks; the longest delay that can be simulated is one tick less."""

MESSAGE = np.dtype([("quat", "f8", (4,)), ("delta_tau", "f8", (3,)), ("thrust", "f8"), ("mode", "i8"), ("sent", "i8")])
"""Upwards: set-point, Δτ_att in N·m, thrust in N, mode, and the tick at which it was sent; -1: lost, or none yet."""

SAMPLE = np.dtype([("quat", "f8", (4,)), ("rate", "f8", (3,)), ("heard", "i8"), ("sent", "i8")])
"""Downwards: attitude, rates in rad/s, tick at which the UAV had heard its newest command, and tick of the sample."""


def told_layout(joints: int) -> np.dtype:
    """What the link is told."""
    whole = [(name, "i8") for name in ("up", "down", "period", "jitter_up", "jitter_down")]
    return np.dtype([*whole, ("loss_up", "f8"), ("loss_down", "f8")])


def kept_layout(joints: int) -> np.dtype:
    """What the link keeps: its lines, the newest message on board with the tick of its arrival, the newest sample's tick."""
    lines = [("up", MESSAGE, (RING,)), ("down", SAMPLE, (RING,)), ("arrived", MESSAGE)]
    return np.dtype([*lines, ("heard", "i8"), ("received", "i8")])


def tell(told: Records, scenario: Scenario) -> None:
    """Fill `told` (1,).

    Raises:
        ConfigurationError: a delay that the delay lines cannot hold.
    """
    link, rate = scenario.link, scenario.run.rate_hz
    told["up"] = _ticks("link.uplink_delay_ms", link.uplink_delay_ms, rate)
    told["down"] = _ticks("link.downlink_delay_ms", link.downlink_delay_ms, rate)
    told["period"] = rate // link.rate_hz


def _ticks(name: str, delay_ms: float, rate: int) -> int:
    ticks = round(delay_ms * rate / 1000.0)
    if ticks >= RING:
        longest = (RING - 1) * 1000.0 / rate
        raise ConfigurationError(f"{name} = {delay_ms:g} ms is too long; the link's delay line holds {longest:g} ms")
    return ticks


@njit(cache=True)
def send(k: int, told: Record, kept: Record, faults: Record, noise: Array, c: Record) -> None:
    """Send the command `c` of tick `k` up; `noise` (4,) is standard normal."""
    message = kept.up[k % RING]
    lost = faults.uplink_lost or (told.loss_up > 0.0 and uniform(noise[0]) < told.loss_up)
    message.sent = -1 if lost else k
    message.quat = c.uav_quat
    message.delta_tau = c.delta_tau
    message.thrust, message.mode = c.thrust, c.uav_mode


@njit(cache=True)
def arrive(k: int, told: Record, kept: Record, noise: Array) -> None:
    """Put what arrives on board at tick `k` into `kept.arrived`; `noise` (4,) is standard normal."""
    sent = k - told.up - _lateness(told.jitter_up, noise[1])
    if sent < 0:
        return
    message, newest = kept.up[sent % RING], kept.arrived
    if message.sent != sent or sent <= newest.sent:
        return
    kept.heard = k
    newest.quat = message.quat
    newest.delta_tau = message.delta_tau
    newest.thrust, newest.mode, newest.sent = message.thrust, message.mode, sent


@njit(cache=True)
def report(k: int, told: Record, kept: Record, imu: Record, noise: Array) -> None:
    """Send the UAV's sample `imu` (of `imu.kept_layout`) down where tick `k` is one of the link's; `noise` (4,) is standard normal."""
    if k % told.period:
        return
    row = kept.down[k % RING]
    row.sent = -1 if told.loss_down > 0.0 and uniform(noise[2]) < told.loss_down else k
    row.quat = imu.quat
    row.rate = imu.rate
    row.heard = kept.heard


@njit(cache=True)
def receive(k: int, told: Record, kept: Record, faults: Record, noise: Array, m: Record) -> None:
    """Put what arrives on the ground at tick `k` into the measurement `m`: `uav_quat`, `uav_rate` rad/s, `uav_tick`, `uav_heard`.

    `noise` (4,) is standard normal.
    """
    taken = k - told.down - _lateness(told.jitter_down, noise[3])
    if taken < 0:
        if kept.received < 0:
            # Before the first sample has arrived the ground knows the attitude from before the run.
            m.uav_quat = kept.down[0].quat
            for i in range(3):
                m.uav_rate[i] = 0.0
        return
    taken -= taken % told.period
    if taken <= kept.received:
        return
    kept.received = taken
    row = kept.down[taken % RING]
    if faults.downlink_lost or row.sent != taken:
        return
    m.uav_tick, m.uav_heard = taken, row.heard
    m.uav_quat = row.quat
    m.uav_rate = row.rate


@njit(cache=True)
def _lateness(most: int, normal: float) -> int:
    return int(uniform(normal) * (most + 1)) if most > 0 else 0
