"""Failures of a landing's devices, switched on and off by phase and time."""

import numpy as np

from armland.errors import ConfigurationError
from armland.mission.landing_scenario import Fault


class FaultSchedule:
    """The faults of a scenario; false where there are none.

    Args:
        faults: what fails.
        phases: names of the mission's phases, in the order of the numbers that `apply` gets.
        rate_hz: base rate.

    Raises:
        ConfigurationError: a fault in a phase that the mission does not have.

    A fault is armed when its phase first begins (or the run does) and acts from `after_s` on for `lasts_s`.
    """

    def __init__(self, faults: tuple[Fault, ...], phases: tuple[str, ...], rate_hz: int) -> None:
        unknown = sorted({f.phase for f in faults if f.phase is not None} - set(phases))
        if unknown:
            raise ConfigurationError(f"faults: no phase {unknown}; the mission's phases are {', '.join(phases)}")
        self._faults, self._phases, self._rate = faults, phases, rate_hz
        self.reset()

    def reset(self) -> None:
        """Back to the run's begin."""
        self._armed: list[int | None] = [0 if f.phase is None else None for f in self._faults]
        self.camera_frozen = self.camera_lost = False

    def __bool__(self) -> bool:
        return bool(self._faults)

    def apply(self, tick: int, phase: int, state: np.ndarray, magnet: np.ndarray, rated: float) -> None:
        """Write what fails at this tick into the devices' `state` and the `magnet`'s parameters, both (1,)."""
        for name in ("uplink_lost", "downlink_lost", "wrench_frozen", "arm_stale", "deaf", "drift", "force", "away"):
            state[name] = 0
        state["health"], magnet["health"], magnet["rated"] = 1.0, 1.0, rated
        self.camera_frozen = self.camera_lost = False
        for i, fault in enumerate(self._faults):
            if self._armed[i] is None and fault.phase is not None and self._phases[phase] == fault.phase:
                self._armed[i] = tick
            armed = self._armed[i]
            if armed is None:
                continue
            since = (tick - armed) / self._rate - fault.after_s
            if 0.0 <= since < fault.lasts_s:
                self._act(fault, since, state, magnet)

    def _act(self, fault: Fault, since: float, state: np.ndarray, magnet: np.ndarray) -> None:
        match fault.kind:
            case "link_loss":
                state["uplink_lost"] = state["downlink_lost"] = 1
            case "uplink_loss":
                state["uplink_lost"] = 1
            case "downlink_loss":
                state["downlink_lost"] = 1
            case "camera_frozen":
                self.camera_frozen = True
            case "camera_lost":
                self.camera_lost = True
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
                state["deaf"], state["away"][0, 2] = 1, fault.size
