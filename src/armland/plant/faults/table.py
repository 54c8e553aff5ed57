"""Failures of the devices as numbers: the table of a scenario's faults, and the fields by which devices learn what fails.

A fault is armed when its phase first begins (or the run does) and acts from `after` on for `lasts`, see `effects`.
"""

import numpy as np

from armland.control.laws.realisation import elbow_of
from armland.errors import ConfigurationError
from armland.models.parameters import arm_model, rotor_count
from armland.plant.devices.camera_numbers import ERRORS, well
from armland.plant.scene.composition import Scene
from armland.records import MOST_ROTORS, Records
from armland.scenario import Scenario
from armland.scenario.faults import DEVICES, FAILURES, SHAPES, Fault

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

FLAGS = ("uplink_lost", "downlink_lost", "wrench_frozen", "arm_stale", "deaf", "unpowered")

DETECTED = ("camera_noise", "camera_outliers", "camera_flip", "wrong_marker")
"""Errors of the camera's measurement model; pictures have their own."""

NEEDS = dict.fromkeys(("camera_frozen", "camera_lost", *DETECTED), "camera") | dict.fromkeys(
    ("magnet_coil", "magnet_slip", "magnet_stuck"), "magnet"
)
"""Part of the scene without which a fault could not act."""


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
            ("late", "i8"),  # ticks, by which the link takes longer both ways
            ("encoder_stuck", "i8", (joints,)),  # 1 where an encoder no longer counts
            ("encoder_off", "f8", (joints,)),  # rad, that each encoder reads too much
            ("encoder_creep", "f8", (joints,)),  # rad/s, by which that grows
            ("drift", "f8"),  # N on the force sensor's z
            ("bridge", "f8"),  # what the force sensor makes of one N or N·m
            ("camera", ERRORS),
            ("rotor", "f8", (MOST_ROTORS,)),  # share of its thrust that each rotor gives
            ("coil", "f8"),  # share of its current that the magnet's coil lets through
            ("rating", "f8"),  # share of its rating that the magnet keeps
            ("residual", "f8"),  # share of that with which it pulls without current
            ("force", "f8", (3,)),  # N, W, on the UAV
            ("torque", "f8", (3,)),  # N·m, W, on the UAV
            ("wind", "f8", (3,)),  # m/s, W, of the air around the UAV, beyond what blows anyway
            ("away", "f8", (3,)),  # m, W, by which a UAV that does not obey hovers elsewhere
        ]
    )


def tell(told: Records, scenario: Scenario, scene: Scene, phases: tuple[str, ...]) -> None:
    """Fill `told` (1,); `phases` are the names of the mission's phases, in the order of the numbers that `act` gets.

    Raises:
        ConfigurationError: a fault in a phase that the mission does not have, of a joint that the arm or of a rotor that the
            UAV does not have, or of a device that the scene does not have.
    """
    rotors = rotor_count(scenario)
    for fault in scenario.faults:
        _check(fault, scene, rotors, phases)
    bodies = {"uav": scene.uav_body, "tool": scene.tool_body}
    if any(f.body == "elbow" for f in scenario.faults):
        # The link that the elbow's joint moves: the file says, or the arm's geometry.
        elbow = elbow_of(scenario, arm_model(scenario))
        bodies["elbow"] = int(scene.model.dof_bodyid[scene.joint_dof[elbow]])
    alone = {"elbow"} if "magnet" in scene.parts else {"elbow", "tool"}
    told["count"], told["rate_hz"] = len(scenario.faults), scenario.run.rate_hz
    for row, f in zip(told["row"][0], scenario.faults, strict=False):
        row["kind"], row["phase"] = FAILURES.index(f.kind), -1 if f.phase is None else phases.index(f.phase)
        row["after"], row["lasts"], row["size"], row["direction"] = f.after_s, f.lasts_s, f.size, f.direction
        row["rotor"], row["joint"], row["device"] = f.rotor - 1, f.joint - 1, DEVICES.index(f.device)
        row["body"], row["alone"] = bodies[f.body], f.body in alone


def _check(fault: Fault, scene: Scene, rotors: int, phases: tuple[str, ...]) -> None:
    if fault.phase is not None and fault.phase not in phases:
        raise ConfigurationError(f"faults: no phase {fault.phase!r}; the mission's phases are {', '.join(phases)}")
    if not scene.joints and _on_arm(fault):
        raise ConfigurationError(f"faults: {fault.kind} cannot act: the mission flies without an arm")
    if fault.joint > max(scene.joints, 1):
        raise ConfigurationError(f"faults: joint {fault.joint} does not exist; the arm has joints 1 to {scene.joints}")
    if fault.kind == "rotor_loss" and fault.rotor > rotors:
        raise ConfigurationError(f"faults: rotor {fault.rotor} does not exist; the UAV has rotors 1 to {rotors}")
    needed = "camera" if fault.kind == "non_finite" and fault.device == "camera" else NEEDS.get(fault.kind)
    if needed is not None and needed not in scene.parts:
        raise ConfigurationError(f"faults: {fault.kind} cannot act: the mission flies without a {needed}")


def _on_arm(fault: Fault) -> bool:
    at_arm = fault.kind == "non_finite" and fault.device in ("encoders", "wrench")
    return at_arm or "joint" in SHAPES[fault.kind].keys or fault.body == "elbow"


def refuse_detected(scenario: Scenario) -> None:
    """Refuse what only the camera's measurement model can get wrong, where pictures are taken in its place.

    Raises:
        ConfigurationError: such a fault.
    """
    for fault in scenario.faults:
        if fault.kind in DETECTED:
            raise ConfigurationError(
                f"faults: {fault.kind} cannot act on pictures; their errors are the detector's own"
            )


def reset(kept: Records, told: Records) -> None:
    """Put `kept` (1,) to the run's begin: nothing fails, and what waits for no phase is armed."""
    kept[:] = np.zeros_like(kept)
    kept["armed"] = np.where(told["row"]["phase"] < 0, 0, -1)
    kept["turned"] = -1
    kept["rotor"], kept["coil"], kept["rating"], kept["bridge"] = 1.0, 1.0, 1.0, 1.0
    kept["camera"] = well()
