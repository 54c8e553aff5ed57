"""The AR.Drone from published data that have nothing to do with the paper's experiments: what its scenario's values follow from.

| symbol | name | unit |
|---|---|---|
| 1/T₁, d | `attitude_1ps`, `dead_s`: attitude that follows its set-point as e^{−ds}/(T₁s + 1), in hover | 1/s, s |
| τ | `lag_s`: rotor lag, measured on the bench | s |

**Gains.** PD on the body and the rotors' lag answer with k_p/(Jτs³ + Js² + k_d s + k_p). Its mean delay k_d/k_p and its next moment
J/k_p are those of the published response for

    k_p = J/(d²/2 + dT₁),  k_d = k_p (d + T₁)

so τ does not enter. How much of a torque is made at another thrust than hover's is `models.airframe.slope`'s.
**Torque limit.** What the rotors have left at the thrust, up or down, whichever is less; no other limit is published.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from armland.models.parameters import uav_parameters
from armland.scenario import Scenario

MOTOR_M = 0.127
"""Distance of a rotor from the roll and the pitch axis: darenlee/SimulinkARDroneTarget, d512bda."""


class Datum(NamedTuple):
    """A published number: its value, its range, and where they are from."""

    value: float
    low: float
    high: float
    unit: str
    source: str


DATA = {
    "attitude_1ps": Datum(10.0, 7.0, 14.0, "1/s", "tum_ardrone's c3, 10; range: assumption, a factor of √2 either way"),
    "dead_s": Datum(0.05, 0.025, 0.05, "s", "tum_ardrone's base of the control delay; the rest of it is on the link"),
    "way_ms": Datum(25.0, 12.5, 50.0, "ms", "tum_ardrone's delay of navdata each way; half of it; 20 kB packets"),
    "lag_s": Datum(0.05, 0.04, 0.06, "s", "bench, 20/(s + 20); range: assumption, a fifth either way"),
    "integral_s": Datum(
        1.0,
        0.5,
        2.0,
        "s",
        "AR.Drone: P on angles, PI on rates (Bristeau et al. 2011); its time has no source, a factor of 2 either way",
    ),
    "linear": Datum(1.0, 0.0, 1.0, "1", "no source: torque by the slope in hover, or by the whole thrust curve"),
    "strength": Datum(1.0, 0.93, 1.07, "1", "bench: 0.05 N from motor to motor at 0.76 N"),
    "roll_nm": Datum(0.0, -0.011, 0.011, "N·m", "the same four rotors unequal by as much at half the weight"),
    "pitch_nm": Datum(0.0, -0.011, 0.011, "N·m", "likewise"),
    "thrust_n": Datum(2.35, 1.18, 4.7, "N", "no source: half the weight, as in the landing; a quarter to all of it"),
}
"""What the demonstrator follows from, by name. Settled before any experiment was flown with it."""


def derived(scenario: Scenario, data: Mapping[str, float]) -> dict[str, Any]:
    """Changes to a scenario that follow from `data`, values by the names of `DATA`."""
    uav, rotors = uav_parameters(scenario), scenario.rotors
    inertia, one, k = np.diag(uav.inertia), data["thrust_n"] / 4.0, data["strength"]
    d, t1 = data["dead_s"], 1.0 / data["attitude_1ps"]
    kp = inertia / (0.5 * d**2 + d * t1)
    room = 4.0 * min(rotors.max_thrust_n - one, one - rotors.min_thrust_n)
    return {
        "rotors": {"time_constant_s": data["lag_s"]},
        "onboard": {
            "controller": "cascade",
            "lead_s": 0.0,
            "kp_nm": tuple(k * kp),
            "kd_nms": tuple(k * kp * (d + t1)),
            "integral_s": data["integral_s"],
            "slope_share": data["linear"],
        },
        "link": {
            # What of the base's 50 ms is not dead time on board is on the way there.
            "uplink_delay_ms": data["way_ms"] + 1e3 * (DATA["dead_s"].value - d),
            "downlink_delay_ms": data["way_ms"],
            "torque_effectiveness": k,
            "torque_limit_nm": (room * MOTOR_M, room * MOTOR_M, room * rotors.drag_torque_m),
        },
        "control": {"thrust_n": data["thrust_n"]},
        "disturbance": {"torque_nm": (data["roll_nm"], data["pitch_nm"], 0.0)},
    }


def central() -> dict[str, float]:
    """The values of `DATA`."""
    return {name: datum.value for name, datum in DATA.items()}
