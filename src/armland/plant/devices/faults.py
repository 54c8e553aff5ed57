"""Failures of the devices, switched on and off by phase and time: a table of fault records, compiled.

A fault is armed when its phase first begins (or the run does) and acts from `after` on for `lasts`. What it does is one of three
things: it sets a field of `kept_layout` that a device reads, it changes the measurement behind the device, or it pushes a body.
"""

import numpy as np
from numba import njit

from armland.errors import ConfigurationError
from armland.plant.scene.composition import Scene
from armland.records import Record, Records
from armland.rotations import Array, from_rotation_vector, multiply
from armland.scenario import Scenario
from armland.scenario.faults import DEVICES, FAILURES, Fault

MOST = 100
"""Most faults of a scenario."""

ROW = np.dtype(
    [
        ("kind", "i8"),  # index into FAILURES
        ("phase", "i8"),  # at whose begin it is armed; -1: the run's
        ("after", "f8"),  # s
        ("lasts", "f8"),  # s
        ("size", "f8"),
        ("direction", "f8", (3,)),
        ("rotor", "i8"),  # from 0
        ("joint", "i8"),  # from 0
        ("device", "i8"),  # index into DEVICES
        ("body", "i8"),  # row of xfrc_applied
        ("alone", "i8"),  # 1 where nothing else writes that row
    ]
)

FLAGS = ("uplink_lost", "downlink_lost", "wrench_frozen", "arm_stale", "deaf", "camera_frozen", "camera_lost")

NEEDS = {"camera_frozen": "camera", "camera_lost": "camera", "magnet_coil": "magnet", "magnet_slip": "magnet"}
"""Part of the scene without which a fault could not act."""

LINK_LOSS, UPLINK_LOSS, DOWNLINK_LOSS = (FAILURES.index(f"{n}_loss") for n in ("link", "uplink", "downlink"))
CAMERA_FROZEN, CAMERA_LOST = FAILURES.index("camera_frozen"), FAILURES.index("camera_lost")
WRENCH_FROZEN, WRENCH_DRIFT = FAILURES.index("wrench_frozen"), FAILURES.index("wrench_drift")
ARM_STALE, ROTOR_LOSS = FAILURES.index("arm_stale"), FAILURES.index("rotor_loss")
MAGNET_COIL, MAGNET_SLIP = FAILURES.index("magnet_coil"), FAILURES.index("magnet_slip")
OVERLOAD, UNREACHABLE, TWIST = FAILURES.index("overload"), FAILURES.index("unreachable"), FAILURES.index("twist")
NON_FINITE, PUSH = FAILURES.index("non_finite"), FAILURES.index("push")
ENCODER_OFFSET, ATTITUDE_OFFSET = FAILURES.index("encoder_offset"), FAILURES.index("attitude_offset")
ENCODERS, WRENCH, ATTITUDE, CAMERA = (DEVICES.index(n) for n in ("encoders", "wrench", "attitude", "camera"))


def told_layout(joints: int) -> np.dtype:
    """The table of faults."""
    return np.dtype([("count", "i8"), ("rate_hz", "i8"), ("row", ROW, (MOST,))])


def kept_layout(joints: int) -> np.dtype:
    """Which faults are armed, act and have acted, and what fails at present."""
    return np.dtype(
        [
            ("armed", "i8", (MOST,)),  # tick; -1: not yet
            ("acting", "i8", (MOST,)),
            ("acted", "i8", (MOST,)),
            ("turned", "i8"),  # UAV sample that was turned last
            *((name, "i8") for name in FLAGS),
            ("drift", "f8"),  # N on the force sensor's z
            ("rotor", "f8", (4,)),  # share of its thrust that each rotor gives
            ("coil", "f8"),  # share of its current that the magnet's coil lets through
            ("rating", "f8"),  # share of its rating that the magnet keeps
            ("force", "f8", (3,)),  # N, W, on the UAV
            ("torque", "f8", (3,)),  # N·m, W, on the UAV
            ("away", "f8", (3,)),  # m, W, by which a UAV that does not obey hovers elsewhere
        ]
    )


def tell(told: Records, scenario: Scenario, scene: Scene, phases: tuple[str, ...]) -> None:
    """Fill `told` (1,); `phases` are the names of the mission's phases, in the order of the numbers that `act` gets.

    Raises:
        ConfigurationError: a fault in a phase that the mission does not have, of a joint that the arm does not have, or of a
            device that the scene does not have.
    """
    for fault in scenario.faults:
        _check(fault, scene, phases)
    model = scene.model
    elbow = int(model.dof_bodyid[scene.joint_dof[scene.joints // 2]])
    bodies = {"uav": scene.uav_body, "tool": scene.tool_body, "elbow": elbow}
    alone = {"elbow"} if "magnet" in scene.parts else {"elbow", "tool"}
    told["count"], told["rate_hz"] = len(scenario.faults), scenario.run.rate_hz
    for row, f in zip(told["row"][0], scenario.faults, strict=False):
        row["kind"], row["phase"] = FAILURES.index(f.kind), -1 if f.phase is None else phases.index(f.phase)
        row["after"], row["lasts"], row["size"], row["direction"] = f.after_s, f.lasts_s, f.size, f.direction
        row["rotor"], row["joint"], row["device"] = f.rotor - 1, f.joint - 1, DEVICES.index(f.device)
        row["body"], row["alone"] = bodies[f.body], f.body in alone


def _check(fault: Fault, scene: Scene, phases: tuple[str, ...]) -> None:
    if fault.phase is not None and fault.phase not in phases:
        raise ConfigurationError(f"faults: no phase {fault.phase!r}; the mission's phases are {', '.join(phases)}")
    if fault.joint > scene.joints:
        raise ConfigurationError(f"faults: joint {fault.joint} does not exist; the arm has joints 1 to {scene.joints}")
    needed = "camera" if fault.kind == "non_finite" and fault.device == "camera" else NEEDS.get(fault.kind)
    if needed is not None and needed not in scene.parts:
        raise ConfigurationError(f"faults: {fault.kind} cannot act: the mission flies without a {needed}")


def reset(kept: Records, told: Records) -> None:
    """Put `kept` (1,) to the run's begin: nothing fails, and what waits for no phase is armed."""
    kept[:] = np.zeros_like(kept)
    kept["armed"] = np.where(told["row"]["phase"] < 0, 0, -1)
    kept["turned"] = -1
    kept["rotor"], kept["coil"], kept["rating"] = 1.0, 1.0, 1.0


@njit(cache=True)
def act(k: int, phase: int, told: Record, kept: Record) -> None:
    """Find what fails at tick `k` in `phase`, and set the fields that the devices read.

    Args:
        k: present tick.
        phase: number of the mission's phase.
        told: of `told_layout`.
        kept: of `kept_layout`, updated.
    """
    kept.uplink_lost = kept.downlink_lost = kept.wrench_frozen = kept.arm_stale = 0
    kept.deaf = kept.camera_frozen = kept.camera_lost = 0
    kept.drift, kept.coil, kept.rating = 0.0, 1.0, 1.0
    for i in range(3):
        kept.force[i] = kept.torque[i] = kept.away[i] = 0.0
    for i in range(4):
        kept.rotor[i] = 1.0
    for i in range(told.count):
        row = told.row[i]
        if kept.armed[i] < 0 and row.phase == phase:
            kept.armed[i] = k
        since = (k - kept.armed[i]) / told.rate_hz - row.after
        acts = kept.armed[i] >= 0 and 0.0 <= since < row.lasts
        kept.acting[i] = acts
        if acts:
            kept.acted[i] = 1
            _act(row, since, kept)


@njit(cache=True)
def _act(row: Record, since: float, kept: Record) -> None:
    kind = row.kind
    if kind in (LINK_LOSS, UPLINK_LOSS):
        kept.uplink_lost = 1
    if kind in (LINK_LOSS, DOWNLINK_LOSS):
        kept.downlink_lost = 1
    elif kind == CAMERA_FROZEN:
        kept.camera_frozen = 1
    elif kind == CAMERA_LOST:
        kept.camera_lost = 1
    elif kind == WRENCH_FROZEN:
        kept.wrench_frozen = 1
    elif kind == WRENCH_DRIFT:
        kept.drift = row.size * since
    elif kind == ARM_STALE:
        kept.arm_stale = 1
    elif kind == MAGNET_COIL:
        kept.coil = 1.0 - row.size
    elif kind == MAGNET_SLIP:
        kept.rating *= 1.0 - row.size
    elif kind == ROTOR_LOSS:
        kept.rotor[row.rotor] = 1.0 - row.size
    elif kind == OVERLOAD:
        kept.force[2] = -row.size
    elif kind == UNREACHABLE:
        kept.deaf = 1
        for i in range(3):
            kept.away[i] = row.size * row.direction[i]
    elif kind == TWIST:
        for i in range(3):
            kept.torque[i] = row.size * row.direction[i]


@njit(cache=True)
def corrupt(told: Record, kept: Record, m: Record) -> None:
    """Put into the measurement `m` what devices that fail would write; from the tick after `act` on."""
    for i in range(told.count):
        row = told.row[i]
        if not kept.acting[i]:
            continue
        if row.kind == NON_FINITE:
            _lose(row.device, m)
        elif row.kind == ENCODER_OFFSET:
            m.q[row.joint] += row.size
        elif row.kind == ATTITUDE_OFFSET and m.uav_tick != kept.turned:
            # The sample stays in the measurement until the next one arrives.
            kept.turned = m.uav_tick
            turn = np.empty(3)
            for j in range(3):
                turn[j] = row.size * row.direction[j]
            quat = multiply(from_rotation_vector(turn), m.uav_quat)
            for j in range(4):
                m.uav_quat[j] = quat[j]


@njit(cache=True)
def _lose(device: int, m: Record) -> None:
    if device == ENCODERS:
        _fill(m.q)
        _fill(m.qd)
    elif device == WRENCH:
        _fill(m.wrench)
    elif device == ATTITUDE:
        _fill(m.uav_quat)
        _fill(m.uav_rate)
    else:
        _fill(m.camera_position)


@njit(cache=True)
def _fill(a: Array) -> None:
    for i in range(a.shape[0]):
        a[i] = np.nan


@njit(cache=True)
def push(told: Record, kept: Record, xfrc: Array) -> None:
    """Add the pushes of this tick, after all others have written their rows.

    Args:
        told: of `told_layout`.
        kept: of `kept_layout`.
        xfrc: MuJoCo's `xfrc_applied` (nbody, 6), N, N·m, W, written.
    """
    for i in range(told.count):
        row = told.row[i]
        if row.kind == PUSH and row.alone:
            for j in range(6):
                xfrc[row.body, j] = 0.0
    for i in range(told.count):
        row = told.row[i]
        if row.kind == PUSH and kept.acting[i]:
            for j in range(3):
                xfrc[row.body, j] += row.size * row.direction[j]
