"""Force-torque sensor without its bias and without the tool: what the end effector puts on the UAV; compiled.

| symbol | name | unit, frame |
|---|---|---|
| w | `measured` (6,): force, torque of the flange on the tool, torque about the sensor's origin | N, N·m, sensor |
| m_t, c | `mass`, `com` (3,): the tool beyond the sensor | kg, m, sensor |
| R, a | `R` (3, 3) world<-sensor, `acceleration` (3,) of the tool's centre of mass | 1, m/s², world |
| β | `bias` (6,), of which `target` is the newest estimate | N, N·m, sensor |

Balance of the tool: w = β + (f_t, c × f_t) + w_EE with f_t = m_t Rᵀ(a + g e₃) (W.1), where w_EE is what the end effector puts
on what it carries. The tool's own angular momentum is neglected: with a radius of gyration of 3 cm it has 3e-4 kg·m².

β is learnt while the caller knows the end effector to be free: means of whole blocks, of which the newest one waits until the next is
complete, so that a contact that is noticed within one block teaches nothing. The output follows the estimate at a limited
rate and stands still otherwise: it never jumps because of β.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.records import Record
from armland.rotations import Array, cross

PARAMETERS = np.dtype(
    [
        ("tick_s", "f8"),
        ("gravity", "f8"),
        ("mass", "f8"),
        ("com", "f8", (3,)),
        ("block", "i8"),  # ticks
        ("gain", "f8"),  # of a block, once the first ones have been averaged
        ("rate", "f8", (6,)),  # N/s, N·m/s
        ("plausible", "f8", (6,)),  # N, N·m
        ("sigma", "f8", (6,)),  # of one reading, as it comes out of the sensor's filter
        ("correlation", "f8"),  # variance of a long mean over that of independent readings
        ("drift", "f8", (6,)),  # N/√s, N·m/√s
    ]
)

MEMORY = np.dtype(
    [
        ("bias", "f8", (6,)),
        ("target", "f8", (6,)),
        ("variance", "f8", (6,)),  # of the target
        ("sum", "f8", (6,)),
        ("waiting", "f8", (6,)),
        ("count", "i8"),
        ("has_waiting", "i8"),
        ("blocks", "i8"),
        ("implausible", "i8"),  # 1: free, says the caller, but the reading is far from the bias
    ]
)


class Wrench(NamedTuple):
    """Settings. The published data of the demonstrator's sensor name neither noise nor drift: assumptions, all of them."""

    mass: float = 0.30
    """kg."""
    com: tuple[float, float, float] = (0.0, 0.0, 0.025)
    """m."""
    block_s: float = 0.2
    """Longer than a contact goes unnoticed."""
    gain: float = 0.1
    rate: tuple[float, float] = (0.5, 0.02)
    """N/s, N·m/s."""
    plausible: tuple[float, float] = (3.0, 0.2)
    """N, N·m: a free end effector that reads further from its bias touches something, and teaches nothing."""
    sigma: tuple[float, float] = (0.05, 0.002)
    """N, N·m: white noise of one reading before the sensor's low pass."""
    filter_gain: float = 1.0
    """Share of a step that the sensor's low pass makes in one tick; 1 without one."""
    drift: tuple[float, float] = (0.01, 0.0003)
    """N/√s, N·m/√s: random walk of the bias."""


def wrench_parameters(settings: Wrench, tick_s: float, gravity: float = 9.81) -> NDArray[np.void]:
    """`PARAMETERS` (1,) for a loop with ticks of `tick_s` seconds."""
    p: NDArray[np.void] = np.zeros(1, PARAMETERS)
    p["tick_s"], p["gravity"], p["mass"], p["com"] = tick_s, gravity, settings.mass, settings.com
    p["block"], p["gain"] = round(settings.block_s / tick_s), settings.gain
    for name in ("rate", "plausible", "sigma", "drift"):
        p[name] = np.repeat(getattr(settings, name), 3)
    # A first-order low pass keeps the mean of white noise but narrows a single reading to √(g/(2 − g)).
    share = settings.filter_gain / (2.0 - settings.filter_gain)
    p["sigma"] *= np.sqrt(share)
    p["correlation"] = 1.0 / share
    return p


def identify_tool(wrenches: Array, rotations: Array, gravity: float = 9.81) -> tuple[float, Array, Array]:
    """Mass (kg), centre of mass (3,) m and bias (6,) of a free tool at rest in several orientations, by least squares.

    Args:
        wrenches: readings (k, 6), N, N·m, sensor; means over some time each.
        rotations: (k, 3, 3), world<-sensor.
        gravity: m/s².

    Raises:
        ValueError: the orientations do not tell the ten numbers apart: three or more, not all about one axis, do.
    """
    rows = []
    for R in np.asarray(rotations):
        x, y, z = up = gravity * R[2]
        turn = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])  # c × f = turn c
        rows.append(np.block([[up[:, None], np.zeros((3, 3)), np.eye(3), np.zeros((3, 3))]]))
        rows.append(np.block([[np.zeros((3, 1)), turn, np.zeros((3, 3)), np.eye(3)]]))
    A = np.vstack(rows)
    solution, _, rank, _ = np.linalg.lstsq(A, np.ravel(wrenches), rcond=1e-6)
    if rank < 10:
        raise ValueError(f"{len(rotations)} orientations tell {rank} of 10 numbers apart; add one about another axis")
    return float(solution[0]), solution[1:4] / solution[0], solution[4:]


def tare(memory_: NDArray[np.void], bias: Array, sigma: Array) -> None:
    """Begin with a known bias (6,) and its standard deviations (6,): before the run, when nothing hangs on the output."""
    memory_["bias"] = memory_["target"] = bias
    memory_["variance"], memory_["blocks"] = np.square(sigma), 1


@njit(cache=True)
def compensate(
    measured: Array,
    R: Array,
    acceleration: Array,
    free: bool,
    p_: NDArray[np.void],
    s_: NDArray[np.void],
    external: Array,
    sigma: Array,
) -> None:
    """One tick: the wrench of the end effector on the UAV, and the bias a little better known where the end effector is free.

    Args:
        measured: (6,), N, N·m, sensor.
        R: (3, 3), world<-sensor.
        acceleration: of the tool's centre of mass (3,), m/s², world; zeros neglect it.
        free: whether the end effector is known to touch nothing.
        p_: `PARAMETERS` (1,).
        s_: `MEMORY` (1,), updated.
        external: receives w_EE (6,) about the sensor's origin, N, N·m, sensor.
        sigma: receives the standard deviations (6,) of `external`: noise of the reading and of the bias's estimate.
    """
    p, s = p_[0], s_[0]
    lifted = acceleration.copy()
    lifted[2] += p.gravity
    weight = np.zeros(3)
    for i in range(3):
        for k in range(3):
            weight[i] += p.mass * R[k, i] * lifted[k]
    turn = cross(p.com, weight)
    s.implausible = 0
    for i in range(6):
        tool = weight[i] if i < 3 else turn[i - 3]
        external[i] = measured[i] - tool  # (W.1)
        if free and not abs(external[i] - s.bias[i]) <= p.plausible[i]:
            s.implausible = 1
    _learn(external, free and s.implausible == 0, p, s)
    for i in range(6):
        external[i] -= s.bias[i]
        sigma[i] = np.sqrt(p.sigma[i] ** 2 + s.variance[i])


@njit(cache=True)
def _learn(reading: Array, free: bool, p: Record, s: Record) -> None:
    for i in range(6):
        s.variance[i] += p.drift[i] ** 2 * p.tick_s
    if not free:
        # What has not been learnt by now may already hold a contact.
        s.count = s.has_waiting = 0
        s.sum[:] = 0.0
        return
    for i in range(6):
        step = p.rate[i] * p.tick_s
        s.bias[i] += min(max(s.target[i] - s.bias[i], -step), step)
        s.sum[i] += reading[i]
    s.count += 1
    if s.count < p.block:
        return
    if s.has_waiting:
        s.blocks += 1
        gain = max(1.0 / s.blocks, p.gain)
        for i in range(6):
            s.target[i] += gain * (s.waiting[i] - s.target[i])
            block = p.sigma[i] ** 2 * p.correlation / p.block
            s.variance[i] = (1.0 - gain) ** 2 * s.variance[i] + gain**2 * block
    for i in range(6):
        s.waiting[i] = s.sum[i] / p.block
        s.sum[i] = 0.0
    s.count, s.has_waiting = 0, 1


@njit(cache=True)
def at_pivot(external: Array, R: Array, lever: Array) -> tuple[Array, Array]:
    """Force (3,) N and torque (3,) N·m, world, about a point `lever` (3,) m, sensor axes, from the sensor's origin.

    Args:
        external: (6,), N, N·m, sensor, about its origin.
        R: (3, 3), world<-sensor.
        lever: m, sensor.
    """
    force, torque = external[:3], external[3:] - cross(lever, external[:3])
    return R @ force, R @ torque
