"""Failures of a landing's devices, switched on and off by phase and time."""

import numpy as np

from armland.errors import ConfigurationError
from armland.mission.failures import Fault
from armland.rotations import from_rotation_vector, multiply

WRITTEN = (
    "uplink_lost",
    "downlink_lost",
    "wrench_frozen",
    "arm_stale",
    "deaf",
    "drift",
    "force",
    "torque",
    "away",
    "camera_frozen",
    "camera_lost",
)
"""What of the devices' state belongs to the faults, besides the rotors' health."""

DEVICES = {
    "encoders": ("q", "qd"),
    "wrench": ("wrench",),
    "attitude": ("uav_quat", "uav_rate"),
    "camera": ("camera_position",),
}
"""Fields of the measurement that a device fills."""


class FaultSchedule:
    """The faults of a scenario; false where there are none.

    Args:
        faults: what fails.
        phases: names of the mission's phases, in the order of the numbers that `apply` gets.
        rate_hz: base rate.
        joints: of the arm.

    Raises:
        ConfigurationError: a fault in a phase that the mission does not have, or of a joint that the arm does not have.

    A fault is armed when its phase first begins (or the run does) and acts from `after_s` on for `lasts_s`.
    """

    def __init__(self, faults: tuple[Fault, ...], phases: tuple[str, ...], rate_hz: int, joints: int) -> None:
        unknown = sorted({f.phase for f in faults if f.phase is not None} - set(phases))
        if unknown:
            raise ConfigurationError(f"faults: no phase {unknown}; the mission's phases are {', '.join(phases)}")
        beyond = [f.joint for f in faults if f.joint > joints]
        if beyond:
            raise ConfigurationError(f"faults: joint {beyond[0]} does not exist; the arm has joints 1 to {joints}")
        self._faults, self._phases, self._rate = faults, phases, rate_hz
        self.reset()

    def reset(self) -> None:
        """Back to the run's begin."""
        self._armed: list[int | None] = [0 if f.phase is None else None for f in self._faults]
        self._acting: list[Fault] = []
        self._turned = -1

    def __bool__(self) -> bool:
        return bool(self._faults)

    def apply(self, tick: int, phase: int, state: np.ndarray, magnet: np.ndarray, rated: float) -> None:
        """Write what fails at this tick into the devices' `state` and the `magnet`'s parameters, both (1,)."""
        for name in WRITTEN:
            state[name] = 0
        state["health"], magnet["health"], magnet["rated"] = 1.0, 1.0, rated
        self._acting = []
        for i, fault in enumerate(self._faults):
            if self._armed[i] is None and fault.phase is not None and self._phases[phase] == fault.phase:
                self._armed[i] = tick
            armed = self._armed[i]
            if armed is None:
                continue
            since = (tick - armed) / self._rate - fault.after_s
            if 0.0 <= since < fault.lasts_s:
                self._acting.append(fault)
                self._act(fault, since, state, magnet)

    def corrupt(self, measurement: np.ndarray) -> None:
        """Put into `measurement` (1,) what the devices that fail would write; from the tick after `apply` on."""
        for fault in self._acting:
            if fault.kind == "non_finite":
                for name in DEVICES[fault.device]:
                    measurement[name] = np.nan
            elif fault.kind == "encoder_offset":
                measurement["q"][0, fault.joint - 1] += fault.size
            elif fault.kind == "attitude_offset" and measurement["uav_tick"][0] != self._turned:
                # The sample stays in the measurement until the next one arrives.
                self._turned = int(measurement["uav_tick"][0])
                turn = from_rotation_vector(fault.size * np.array(fault.direction))
                measurement["uav_quat"][0] = multiply(turn, measurement["uav_quat"][0])

    def push(self, xfrc_applied: np.ndarray, bodies: dict[str, int]) -> None:
        """Add the pushes of this tick to MuJoCo's `xfrc_applied` (bodies, 6) in the rows that `bodies` names."""
        if any(f.kind == "push" for f in self._faults):
            # The rows of tool and UAV are written by others at every tick.
            xfrc_applied[bodies["elbow"]] = 0.0
        for fault in self._acting:
            if fault.kind == "push":
                xfrc_applied[bodies[fault.body], :3] += fault.size * np.array(fault.direction)

    def _act(self, fault: Fault, since: float, state: np.ndarray, magnet: np.ndarray) -> None:
        match fault.kind:
            case "link_loss":
                state["uplink_lost"] = state["downlink_lost"] = 1
            case "uplink_loss":
                state["uplink_lost"] = 1
            case "downlink_loss":
                state["downlink_lost"] = 1
            case "camera_frozen":
                state["camera_frozen"] = 1
            case "camera_lost":
                state["camera_lost"] = 1
            case "wrench_frozen":
                state["wrench_frozen"] = 1
            case "wrench_drift":
                state["drift"] = fault.size * since
            case "arm_stale":
                state["arm_stale"] = 1
            case "magnet_coil":
                magnet["health"] = 1.0 - fault.size
            case "magnet_slip":
                magnet["rated"] *= 1.0 - fault.size
            case "rotor_loss":
                state["health"][0, fault.rotor - 1] = 1.0 - fault.size
            case "overload":
                state["force"][0, 2] = -fault.size
            case "unreachable":
                state["deaf"], state["away"] = 1, fault.size * np.array(fault.direction)
            case "twist":
                state["torque"] = fault.size * np.array(fault.direction)
