"""The wireless link between ground and UAV: two delay lines with one length, lateness and loss.

Upwards the command of every tick is sent and the UAV takes, at each of its samples, the one that has been under way for the
delay. Downwards the UAV's sample of every link period is sent. No message overtakes another: what is older than what has
arrived is dropped.

| name | what | unit |
|---|---|---|
| `up`, `down` | delay | ticks |
| `jitter_up`, `jitter_down` | largest further delay, drawn anew at every tick | ticks |
| `loss_up`, `loss_down` | probability that a message is lost | 1 |
| `burst` | correlation of a message's loss with that of the one before | 1 |
| `stamp` | by how much the UAV's stamps are late | ticks |

A fault adds its own lateness, `faults.late`; a delay never exceeds what the lines hold.
"""

import numpy as np
from numba import njit

from armland.errors import ConfigurationError
from armland.plant.noise import uniform
from armland.records import MOST_ROTORS, Record, Records
from armland.rotations import Array
from armland.scenario import Scenario

WEAK_SAMPLES = 2
"""Samples in a row that make a weak rotor a lost one."""

RING = 1024
"""Length of the delay lines in ticks; the longest delay that can be simulated is one tick less."""

MESSAGE = np.dtype(
    [
        ("quat", "f8", (4,)),
        ("delta_tau", "f8", (3,)),
        ("thrust", "f8"),
        ("step", "f8", (3,)),
        ("mode", "i8"),
        ("sent", "i8"),
    ]
)
"""Upwards: set-point, Δτ_att in N·m, thrust in N, step of its own hover in m, mode, and the tick at which it was sent; -1: lost, or
none yet."""

SAMPLE = np.dtype(
    [
        ("quat", "f8", (4,)),
        ("rate", "f8", (3,)),
        ("force", "f8", (3,)),
        ("heard", "i8"),
        ("echo", "i8"),
        ("rotors", "f8", (MOST_ROTORS,)),
        ("weak", "i8"),
        ("sent", "i8"),
    ]
)
"""Downwards: attitude, rates in rad/s, specific force in m/s², tick at which the UAV had heard its newest command and at which that was
sent, thrusts asked of the rotors in N, whether one is weak, and tick of the sample."""


def told_layout(joints: int) -> np.dtype:
    """What the link is told."""
    whole = [(name, "i8") for name in ("up", "down", "period", "jitter_up", "jitter_down", "stamp")]
    return np.dtype([*whole, ("loss_up", "f8"), ("loss_down", "f8"), ("burst", "f8")])


def kept_layout(joints: int) -> np.dtype:
    """What the link keeps: its lines, the newest message on board with the tick of its arrival, the newest sample's tick."""
    lines = [("up", MESSAGE, (RING,)), ("down", SAMPLE, (RING,)), ("arrived", MESSAGE)]
    lost = [("lost_up", "i8"), ("lost_down", "i8")]
    return np.dtype([*lines, ("heard", "i8"), ("received", "i8"), *lost])


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
    kept.lost_up = _lost(told.loss_up, told.burst, kept.lost_up, noise[0])
    lost = faults.uplink_lost or kept.lost_up
    message.sent = -1 if lost else k
    message.quat = c.uav_quat
    message.delta_tau = c.delta_tau
    message.step = c.uav_step
    message.thrust, message.mode = c.thrust, c.uav_mode


@njit(cache=True)
def arrive(k: int, told: Record, kept: Record, faults: Record, noise: Array) -> None:
    """Put what arrives on board at tick `k` into `kept.arrived`; `noise` (4,) is standard normal."""
    sent = k - min(told.up + _lateness(told.jitter_up, noise[1]) + faults.late, RING - 1)
    if sent < 0 or faults.unpowered:
        return
    message, newest = kept.up[sent % RING], kept.arrived
    if message.sent != sent or sent <= newest.sent:
        return
    kept.heard = k
    newest.quat = message.quat
    newest.delta_tau = message.delta_tau
    newest.step = message.step
    newest.thrust, newest.mode, newest.sent = message.thrust, message.mode, sent


@njit(cache=True)
def report(k: int, world: Record, noise: Array) -> None:
    """Send the UAV's sample down where tick `k` is one of the link's: of attitude, rates and rotors, as the record `world` keeps them.

    `noise` (4,) is standard normal.
    """
    told, kept = world.told.link, world.kept.link
    if k % told.period:
        return
    row = kept.down[k % RING]
    kept.lost_down = _lost(told.loss_down, told.burst, kept.lost_down, noise[2])
    row.sent = -1 if kept.lost_down or world.kept.faults.unpowered else k
    row.quat = world.kept.imu.quat
    row.rate = world.kept.imu.rate
    row.force = world.kept.imu.force
    row.rotors = world.kept.rotors.asked
    row.weak = 1 if world.kept.onboard.weak >= WEAK_SAMPLES or world.kept.onboard.cut else 0
    row.heard, row.echo = kept.heard, kept.arrived.sent


@njit(cache=True)
def receive(k: int, told: Record, kept: Record, faults: Record, noise: Array, m: Record) -> None:
    """Put what arrives on the ground at tick `k` into the measurement `m`: `uav_quat`, `uav_rate` rad/s, `uav_tick`, `uav_heard`.

    `noise` (4,) is standard normal.
    """
    taken = k - min(told.down + _lateness(told.jitter_down, noise[3]) + faults.late, RING - 1)
    if taken < 0:
        if kept.received < 0:
            # Before the first sample has arrived the ground knows the attitude from before the run.
            m.uav_quat = kept.down[0].quat
            m.uav_rotors = kept.down[0].rotors
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
    m.uav_tick, m.uav_heard, m.uav_echo = taken + told.stamp, row.heard, row.echo
    m.uav_quat = row.quat
    m.uav_rate = row.rate
    m.uav_force = row.force
    m.uav_rotors = row.rotors
    m.uav_weak = row.weak


@njit(cache=True)
def _lateness(most: int, normal: float) -> int:
    return int(uniform(normal) * (most + 1)) if most > 0 else 0


@njit(cache=True)
def _lost(loss: float, burst: float, before: int, normal: float) -> int:
    # A chain of two states with the mean `loss` and the correlation `burst` from one message to the next.
    if loss <= 0.0:
        return 0
    return 1 if uniform(normal) < loss + burst * (before - loss) else 0
