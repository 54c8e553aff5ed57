"""The proof on the coupled demonstrator: V₂ of the recorded truth, and which broken assumption pays for its rise.

With x̄ the mean of two recorded states a tick h apart, and u₀ the input of (29) in x̄,

    ΔV₂/h = V̇₂ of (30) in x̄ + Σ terms + remainder,

where each term is the power that one broken assumption feeds into V₂. A force F and a torque τ on the UAV beyond those of
u₀ feed w·F + z₂ω·τ, w = z₂ᵥ + R(z₂ω × ρ); a velocity κ of r_e beyond −v feeds k₃ r_e·κ − z₂ᵥ·m K₁κ. The chains from the
law's force to the hinge's, and from its torque to the rotors', make the terms add up: each link is the difference that one
device or simplification makes. V₂ is quadratic in the state, so x̄ makes ΔV₂ exact; the remainder holds what is not
recorded (the hinge's friction) and the plant's integrator, which moves the pose with the velocity of the tick's end.

| symbol | name | unit, frame; k ticks |
|---|---|---|
| x̄ = (q, ω, r, v) | `Pose` | 1; rad/s, body; m, world, pivot; m/s, world, centre of mass; (k, ·) |
| z₂ω, z₂ᵥ, w | `z2_omega`, `z2_v`, `pull` (k, 3) | rad/s, body; m/s, world |
| F, τ | `force`, `torque` (k, 3) | N, world, on the UAV at the pivot; N·m, body |
| κ | `slip` (k, 3) | m/s, world |
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.control.laws.attitude import QuaternionPdGains
from armland.control.laws.rigid_body import BacksteppingGains, Gravity
from armland.errors import LogError
from armland.experiments.proof.poses import (
    Pose,
    geometry_along,
    law_along,
    mean_poses,
    poses,
    storage_along,
)
from armland.models.uav import UavParameters
from armland.rotations import Array

TERMS = {
    "reference": "reference moves",
    "lever": "lever arm: ω × ρ left out",
    "estimation": "law fed with estimates",
    "support": "support force by Table II",
    "arm": "arm between law and hinge",
    "unsent": "Δτ not sent by Table II",
    "limit": "Δτ limited",
    "effectiveness": "Δτ arrives in part",
    "delay": "Δτ arrives late",
    "rotors": "rotors lag",
    "disturbance": "disturbance on the UAV",
}
"""What feeds V₂: the assumptions of the proof that the demonstrator breaks."""

CHANNELS = np.dtype([(name, "f8") for name in ("t", "v2", "measured", "law", *TERMS, "remainder")])
"""A row per tick: s; N·m; ΔV₂/h and (30), W; the terms and what they leave, W."""


class Loop(NamedTuple):
    """What stands between law and UAV, and what the law knows."""

    uav: UavParameters
    gains: BacksteppingGains
    onboard: QuaternionPdGains
    torque_limit: Array  # (3,) N·m
    effectiveness: float
    uplink: int  # ticks
    rate_hz: int
    disturbance: Array  # (6,) N, world, at the centre of mass; N·m, body
    gravity: Gravity  # m/s², world


class Power(NamedTuple):
    """Turns what acts beyond the law into power into V₂, W, (k,)."""

    z2_omega: Array  # (k, 3)
    pull: Array  # (k, 3)
    slope: Array  # (k, 3) N, k₃ r_e − m K₁ z₂ᵥ

    def of_force(self, force: Array) -> Array:
        """Power of a force (k, 3) at the pivot."""
        return np.sum(self.pull * force, axis=1)

    def of_torque(self, torque: Array) -> Array:
        """Power of a torque (k, 3)."""
        return np.sum(self.z2_omega * torque, axis=1)

    def of_slip(self, slip: Array) -> Array:
        """Power of a velocity (k, 3) of r_e beyond −v."""
        return np.sum(self.slope * slip, axis=1)


def attribute(ticks: NDArray[np.void], loop: Loop) -> NDArray[np.void]:
    """Channels (k - 2,) of `CHANNELS` of recorded `ticks` (k,) of `tick_layout`; row i is about tick i + 1.

    Raises:
        LogError: fewer than three ticks.
    """
    if len(ticks) < 3:
        raise LogError(f"the record has {len(ticks)} ticks; the rate of V₂ needs at least 3")
    # The truth of a tick is that of a step before, so the forces in it answer the command of the tick before.
    asked, now, after = ticks[:-2], ticks[1:-1], ticks[2:]
    h, out = 1.0 / loop.rate_hz, np.zeros(len(now), CHANNELS)
    at, then = poses(now, "truth", "v_cm"), poses(after, "truth", "v_cm")
    mean = mean_poses(at, then)
    out["t"] = now["truth"]["tick"] * h
    out["v2"] = storage_along(at, loop.uav, loop.gains)[:, 0]
    out["measured"] = (storage_along(then, loop.uav, loop.gains)[:, 0] - out["v2"]) / h
    out["law"] = storage_along(mean, loop.uav, loop.gains)[:, 1]
    _feed(out, mean, (then.r_d - at.r_d) / h, asked, now["truth"], loop)
    out["remainder"] = out["measured"] - out["law"] - sum(out[name] for name in TERMS)
    return out


def _feed(
    out: NDArray[np.void], mean: Pose, v_d: Array, asked: NDArray[np.void], truth: NDArray[np.void], loop: Loop
) -> None:
    """Fill the terms: link by link from the law in the true state to what acted, each as power into V₂."""
    uav, gains, command = loop.uav, loop.gains, asked["command"]
    R, tau_att, z2 = geometry_along(mean, loop.onboard, gains.k1)
    r_e, thrust = mean.r_d - mean.r, command["thrust"]
    z2_omega, z2_v = z2[:, :3], z2[:, 3:]
    pull = z2_v + np.einsum("kij,kj->ki", R, np.cross(z2_omega, uav.lever))
    power = Power(z2_omega, pull, gains.k3 * r_e - uav.mass * gains.k1[3:] * z2_v)
    spin = np.einsum("kij,kj->ki", R, np.cross(mean.omega, uav.lever))
    # Torque and force of the law: in the true state; with the pivot's velocity for v; on estimates.
    torque_0, force_0 = law_along(mean, thrust, tau_att, uav, gains, loop.gravity)
    torque_1, force_1 = law_along(mean._replace(v=mean.v + spin), thrust, tau_att, uav, gains, loop.gravity)
    predicted = np.ascontiguousarray(asked["estimate"]["tau_att"])
    # The law is fed with the pivot's velocity, as the arm measures it.
    known = poses(asked, "estimate", "v")
    torque_2, force_2 = law_along(known, thrust, predicted, uav, gains, loop.gravity)
    out["reference"] = power.of_slip(v_d)
    out["lever"] = power.of_slip(-spin) + power.of_force(force_1 - force_0) + power.of_torque(torque_1 - torque_0)
    out["estimation"] = power.of_force(force_2 - force_1) + power.of_torque(torque_2 - torque_1)
    out["support"] = power.of_force(command["force"] - force_2)
    out["arm"] = power.of_force(truth["hinge_force"] - command["force"])
    out["unsent"] = power.of_torque(command["delta_tau"] - torque_2)
    late = _sent(out, power, command["delta_tau"], loop)
    missing = truth["rotor_thrust"].sum(axis=1) - thrust
    out["rotors"] = power.of_torque(truth["tau_uav"] - tau_att - late) + np.sum(z2_v * R[:, :, 2], axis=1) * missing
    out["disturbance"] = z2_v @ loop.disturbance[:3] + z2_omega @ loop.disturbance[3:]


def _sent(out: NDArray[np.void], power: Power, asked: Array, loop: Loop) -> Array:
    """Fill the terms of what the link does to Δτ_att (k, 3) and return what the onboard controller makes of it (k, 3)."""
    limited = np.clip(asked, -loop.torque_limit, loop.torque_limit)
    late = np.concatenate([np.zeros((loop.uplink, 3)), limited])[: len(limited)]
    out["limit"] = power.of_torque(limited - asked)
    out["effectiveness"] = power.of_torque((loop.effectiveness - 1.0) * limited)
    out["delay"] = power.of_torque(loop.effectiveness * (late - limited))
    return loop.effectiveness * late


NOTICEABLE_W = 1e-3
"""V₂ counts as rising if faster than this: with the arm at rest in E1, the sensors' noise makes less."""


def ledger(channels: NDArray[np.void]) -> dict[str, Any]:
    """Figures of `channels` (k,) of `CHANNELS`: how often and how fast V₂ rises, and what each term feeds it.

    `power_rms_w` is over all ticks, `power_rising_w` the mean over those in which V₂ rises noticeably: there (30), the
    terms and the remainder add up to the mean rate of rise. `closure` is the remainder's RMS over that of the measured rate.
    """
    measured = channels["measured"]
    rising = measured > NOTICEABLE_W
    kinds = ("measured", "law", *TERMS, "remainder")
    rms = {name: float(np.sqrt(np.mean(channels[name] ** 2))) for name in kinds}
    mean = {name: float(channels[name][rising].mean()) if rising.any() else 0.0 for name in kinds}
    return {
        "rising_share": float(rising.mean()),
        "largest_rise_w": float(measured.max()),
        "v2_largest_j": float(channels["v2"].max()),
        "power_rms_w": rms,
        "power_rising_w": mean,
        "closure": rms["remainder"] / rms["measured"] if rms["measured"] else 0.0,
    }


def save_channels(channels: NDArray[np.void], path: Path) -> Path:
    """Write `channels` (k,) of `CHANNELS` as CSV with a header that names units; PlotJuggler opens it. Returns `path`."""
    units = {"t": "s", "v2": "N·m"}
    header = ",".join(f"{name} [{units.get(name, 'W')}]" for name in CHANNELS.names or ())
    np.savetxt(path, channels, fmt="%.9g", delimiter=",", header=header, comments="", encoding="utf-8")
    return path
