"""Judges a recorded landing or take-off by what really happened, never by what the controller believed."""

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.mission.landing_setup import Setup
from armland.mission.remedies import stopped
from armland.mission.supervisor import FAULTS
from armland.rotations import Array

TOUCHDOWN_SPEED_MPS = 0.15
TOUCHDOWN_TILT_DEG = 3.0
PLACED_M = 0.010
"""Bounds of a landing."""

FLYING_SPEED_MPS = 0.25
FLYING_TILT_DEG = 10.0
"""Bounds of a UAV that flies off stable, at the end."""

TOPPLED_DEG = 25.0
"""Tilt beyond which a UAV on the magnet, or in the air, is out of control."""

CRADLE_N = 0.2
"""Force on the rails that counts as a touchdown."""


@dataclass(frozen=True)
class PhaseTime:
    """One phase as flown."""

    name: str
    start_s: float
    end_s: float


class Judgement(NamedTuple):
    """The fields of a `LandingOutcome` that come from the records."""

    success: bool
    reason: str
    phases: list[PhaseTime]
    retries: int
    capture: dict[str, float | None]
    touchdown: dict[str, float | None]
    hinge_force_max_n: float
    joint_torque_max_ratio: float
    limits_violated: list[str]
    fault: str
    end: str
    release: dict[str, float | None]
    state: str


def judge_landing(records: NDArray[np.void], setup: Setup, put_down: Array, rate: int) -> Judgement:
    """Judge a landing whose cradle has the pivot at `put_down` (3,) m."""
    truth, end = records["truth"], _end(records, setup)
    capture, touchdown = _capture(records), _touchdown(truth, put_down)
    violated = limits_violated(records, setup)
    why = []
    if end != "done":
        why.append(_stopped(records, setup, end))
    speed, tilt, offset = touchdown["speed_mps"], touchdown["tilt_deg"], touchdown["offset_m"]
    if speed is None or tilt is None or offset is None:
        why.append("the UAV never stood on the cradle")
    else:
        if speed > TOUCHDOWN_SPEED_MPS:
            why.append(f"touchdown at {speed:.3f} m/s, above {TOUCHDOWN_SPEED_MPS} m/s")
        if tilt > TOUCHDOWN_TILT_DEG:
            why.append(f"touchdown with {tilt:.1f}° of tilt, above {TOUCHDOWN_TILT_DEG}°")
        if offset > PLACED_M:
            why.append(f"placed {1e3 * offset:.1f} mm beside the cradle's middle, above {1e3 * PLACED_M:.0f} mm")
        if np.linalg.norm(truth["v"][-1]) > 0.01 or truth["touching"][-1]:
            why.append("not at rest, or not let go")
    if violated:
        why.append(f"limits violated: {', '.join(violated)}")
    return _judgement(records, setup, rate, why, "landed", capture, touchdown, violated, {})


def judge_takeoff(records: NDArray[np.void], setup: Setup, put_down: Array, rate: int) -> Judgement:
    """Judge a take-off: released without a jerk, flying off stable and clear of the arm."""
    truth, end = records["truth"], _end(records, setup)
    violated, why = limits_violated(records, setup), []
    if end != "done":
        why.append(_stopped(records, setup, end))
    free = _released(truth)
    release: dict[str, float | None] = {"hinge_force_n": None, "speed_mps": None, "drop_m": None}
    if free is None:
        why.append("the magnet never let go of a flying UAV")
    else:
        force = float(np.linalg.norm(truth["hinge_force"][_let_go(records, setup, free)]))
        speed = float(np.linalg.norm(truth["v"][free]))
        drop = float(truth["r"][free, 2] - truth["r"][free : free + 2 * rate, 2].min())
        release = {"hinge_force_n": force, "speed_mps": speed, "drop_m": drop}
        late = truth[-rate // 2 :]
        # A UAV that keeps the speed it was given flies steadily at that speed.
        given = np.array(setup.scenario.landing.place.takeoff_velocity_mps)[:2] * setup.scenario.landing.place.fly_on
        late = late.copy()
        late["v"][:, :2] -= given
        if np.linalg.norm(late["v"], axis=1).max() > FLYING_SPEED_MPS or tilt_deg(late["quat"]).max() > FLYING_TILT_DEG:
            why.append("the UAV does not fly steadily at the end")
    if violated:
        why.append(f"limits violated: {', '.join(violated)}")
    nothing: dict[str, float | None] = {"speed_mps": None, "tilt_deg": None, "offset_m": None}
    capture: dict[str, float | None] = {"offset_m": None, "relative_speed_mps": None, "tilt_deg": None}
    return _judgement(records, setup, rate, why, "flies", capture, nothing, violated, release)


def _judgement(
    records: NDArray[np.void],
    setup: Setup,
    rate: int,
    why: list[str],
    praise: str,
    capture: dict[str, float | None],
    touchdown: dict[str, float | None],
    violated: list[str],
    release: dict[str, float | None],
) -> Judgement:
    truth = records["truth"]
    return Judgement(
        success=not why,
        reason="; ".join(why) or praise,
        phases=phase_times(records["mission"]["phase"], setup.table.names, rate),
        retries=int(records["mission"]["retries"][-1]),
        capture=capture,
        touchdown=touchdown,
        hinge_force_max_n=float(np.linalg.norm(truth["hinge_force"], axis=1).max()),
        joint_torque_max_ratio=float((np.abs(truth["tau"]) / setup.arm.tau_max).max()),
        limits_violated=violated,
        fault=FAULTS[int(records["mission"]["fault"][-1])],
        end=_end(records, setup),
        release=release,
        state=safe_end(records, rate, FLYING_SPEED_MPS + _given_speed(setup)),
    )


def phase_times(phase: NDArray[np.int64], names: tuple[str, ...], rate: int) -> list[PhaseTime]:
    """Begin and end of each phase, in the order flown."""
    edges = [0, *(np.flatnonzero(np.diff(phase)) + 1).tolist(), len(phase)]
    return [PhaseTime(names[int(phase[a])], a / rate, b / rate) for a, b in pairwise(edges)]


def limits_violated(records: NDArray[np.void], setup: Setup) -> list[str]:
    """Names of the limits that were really exceeded."""
    truth, p, arm = records["truth"], setup.parameters[0], setup.arm
    q, qd = records["measurement"]["q"], records["measurement"]["qd"]
    # Half a newton metre for what the rate limit does not see: the first tick.
    rate = np.abs(np.diff(truth["tau"][2:], axis=0)).max() / p["tick_s"]
    exceeded = {
        "joint_position": bool((q < arm.q_min).any() or (q > arm.q_max).any()),
        "joint_speed": bool((np.abs(qd) > p["qd_max"]).any()),
        "joint_torque": bool((np.abs(truth["tau"]) > arm.tau_max * (1.0 + 1e-9)).any()),
        "torque_rate": bool(rate > p["torque_rate"] * 1.001),
        "singularity": bool((records["health"]["sigma_min"] < p["sigma_min"]).any()),
        "hinge_force": bool(np.linalg.norm(truth["hinge_force"], axis=1).max() > p["hinge_max"]),
        "arm_touched_cradle": bool(truth["foul"][:, 0].any()),
        "arm_touched_floor": bool(truth["foul"][:, 1].any()),
        "arm_touched_uav": bool(truth["foul"][:, 2].any()),
    }
    return [name for name, is_so in exceeded.items() if is_so]


def _given_speed(setup: Setup) -> float:
    place = setup.scenario.landing.place
    return float(np.linalg.norm(place.takeoff_velocity_mps)) if place.fly_on else 0.0


def safe_end(records: NDArray[np.void], rate: int, speed: float = 0.0) -> str:
    """How the UAV ended: `flying`, `held`, `standing`, or, where it is none of these or fell on its way, `lost`."""
    truth = records["truth"]
    late = truth[-rate // 4 :]
    # Faster than this downwards is a fall: from 7 cm.
    fell = truth["v"][:, 2].min() < -1.2
    still = np.linalg.norm(late["v"], axis=1).max() < 0.05
    if fell:
        return "lost"
    if still and late["cradle_force"][:, 2].min() > 1.0:
        return "standing"
    # One that has toppled over its hinge is not held, even where the magnet grips; least of all one that lies on the arm.
    toppled = late["foul"][:, 2].any() or tilt_deg(late["quat"]).max() > TOPPLED_DEG
    if still and late["touching"].min() == 4 and not toppled:
        return "held"
    if (
        late["r"][:, 2].min() > 0.6
        and np.linalg.norm(late["v"], axis=1).max() < max(speed, 0.6)
        and tilt_deg(late["quat"]).max() < TOPPLED_DEG
    ):
        return "flying"
    return "lost"


def tilt_deg(quat: Array) -> Array:
    """Angle of the body's z axis to the vertical, degrees, of quaternions (k, 4)."""
    return np.rad2deg(np.arccos(np.clip(1.0 - 2.0 * (quat[..., 1] ** 2 + quat[..., 2] ** 2), -1.0, 1.0)))


def _end(records: NDArray[np.void], setup: Setup) -> str:
    return setup.table.names[int(records["mission"]["phase"][-1])]


def _stopped(records: NDArray[np.void], setup: Setup, end: str) -> str:
    fault = FAULTS[int(records["mission"]["fault"][-1])]
    if not setup.phases[setup.table.names.index(end)].final:
        return f"still in phase {end} when the time was over"
    names, phase = setup.table.names, records["mission"]["phase"]
    # An end that a second fault has led on from is no phase of the mission.
    flown = [int(k) for k in phase[np.flatnonzero(np.diff(phase))] if not setup.phases[int(k)].final]
    return stopped(end, names[flown[-1]], fault)


def _capture(records: NDArray[np.void]) -> dict[str, float | None]:
    # The last time that pads came into touch while the UAV flew.
    truth = records["truth"]
    touched = (
        (truth["touching"][1:] > 0) & (truth["touching"][:-1] == 0) & (truth["r"][1:, 2] > truth["r"][-1, 2] + 0.02)
    )
    found = np.flatnonzero(touched)
    if not len(found):
        return {"offset_m": None, "relative_speed_mps": None, "tilt_deg": None}
    # Pads bounce for some ticks: the first touch of the last cluster counts.
    breaks = np.flatnonzero(np.diff(found) >= 500)
    first = int(found[breaks[-1] + 1] if len(breaks) else found[0])
    t = truth[first]
    apart = t["r"] - t["ee"]
    return {
        "offset_m": float(np.hypot(apart[0], apart[1])),
        "relative_speed_mps": float(np.linalg.norm(truth["v"][max(first - 2, 0)] - truth["ee_v"][max(first - 2, 0)])),
        "tilt_deg": float(tilt_deg(t["plate_quat"])),
    }


def _touchdown(truth: NDArray[np.void], put_down: Array) -> dict[str, float | None]:
    touched = np.flatnonzero(truth["cradle_force"][:, 2] > CRADLE_N)
    if not len(touched):
        return {"speed_mps": None, "tilt_deg": None, "offset_m": None}
    before = max(touched[0] - 2, 0)
    apart = truth["r"][-1] - put_down
    return {
        "speed_mps": float(np.linalg.norm(truth["v"][before])),
        "tilt_deg": float(tilt_deg(truth["quat"][before])),
        "offset_m": float(np.hypot(apart[0], apart[1])),
    }


def _let_go(records: NDArray[np.void], setup: Setup, free: int) -> int:
    # Tick at which the magnet was switched off for the release at `free`.
    before = records["mission"]["phase"][:free] != setup.table.number("release")
    return int(np.flatnonzero(before)[-1])


def _released(truth: NDArray[np.void]) -> int | None:
    # Last tick at which the plate left the magnet.
    left = np.flatnonzero((truth["touching"][:-1] > 0) & (truth["touching"][1:] == 0))
    return int(left[-1]) + 1 if len(left) and not truth["touching"][-1] else None
