"""The fault table: what the supervisor can find, and in which end it leads each kind of phase. It may only reduce authority.

What arm, UAV and magnet do in an end stands in `ends`. A fault that comes when the mission has ended already may lead on to a
graver end, see `ESCALATION`.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from armland.mission.table.arrays import FAULT_ROWS, PHASES
from armland.mission.table.phases import KINDS, Phase

FAULT_TABLE: dict[str, dict[str, str]] = {
    fault: dict(zip(KINDS, row.split(), strict=True))
    for fault, row in {
        #              ground         flight      touch       held        cradle      grip        hinge
        "non_finite": "refused        abort       abort       holding     secured     secured     -",
        "encoder_frozen": "braked_refused braked_free braked_free braked_held braked_down braked_down -",
        "arm_stale": " braked_refused braked_free braked_free braked_held braked_down braked_down -",
        "power_lost": "-              abort       holding     holding     -           -           -",
        "link_late": " refused        abort       abort       holding     secured     secured     -",
        "uav_silent": "refused        abort       abort       holding     secured     secured     -",
        "camera_stale": "refused      abort       abort       -           -           secured     -",
        "camera_leap": "refused       abort       abort       -           -           secured     -",
        "camera_noise": "refused      abort       abort       -           -           secured     -",
        "wrench_stale": "refused      abort       abort       holding     secured     secured     -",
        "wrench_wrong": "refused      abort       abort       holding     secured     secured     -",
        "wrench_drift": "refused      abort       abort       holding     secured     secured     -",
        "magnet_coil": "refused       -           abort       holding     -           secured     -",
        "thrust_short": "-            holding     holding     -           -           -           -",
        "magnet_stuck": "-            holding     holding     -           secured     secured     -",
        "arm_blocked": "braked_refused braked_free braked_free -           -           -           -",
        "overload": "  refused        abort       abort       holding     secured     secured     -",
        "rotor_lost": "-              -           balancing   balancing   -           -           -",
        "thrust_lost": "refused       abort       holding     holding     -           -           -",
        "uav_tilt": "  refused        abort       abort       -           secured     secured     -",
        "slip": "      -              -           -           let_fly     -           -           -",
        "near_limit": "braked_refused braked_free braked_free braked_held braked_down braked_down -",
        "law_failed": "refused        abort       abort       holding     secured     secured     resting",
    }.items()
}
"""Fault × kind of phase -> final phase; `-` where the fault does not matter there.

The gravest fault stands first. Near a joint's end, near a singularity and beyond the joints' speed no law of the end effector is
defined: the brakes are.
"""

FAULTS = ("none", *FAULT_TABLE)
"""What the supervisor can find, by number."""

FAULT = {name: i for i, name in enumerate(FAULTS)}

ESCALATION: dict[str, dict[str, str]] = {
    "done": {"arm_stale": "braked_down", "encoder_frozen": "braked_down"},
    "refused": {"arm_stale": "braked_refused", "encoder_frozen": "braked_refused"},
    "abort": {"arm_stale": "braked_free", "encoder_frozen": "braked_free"},
    "let_fly": {"arm_stale": "braked_free", "encoder_frozen": "braked_free"},
    "holding": {
        "arm_stale": "braked_held",
        "encoder_frozen": "braked_held",
        "rotor_lost": "balancing",
        "slip": "let_fly",
        # No impedance holds an arm that something drives there.
        "near_limit": "braked_held",
    },
    "balancing": {"arm_stale": "braked_held", "encoder_frozen": "braked_held"},
    # A blow may throw a UAV off the cradle while its rotors still run.
    "secured": {"arm_stale": "braked_down", "encoder_frozen": "braked_down", "slip": "let_fly"},
    "braked_held": {"slip": "braked_free"},
}
"""Final phase × second fault -> graver final phase; whatever is not here changes nothing."""

GRAVITY_OF = {
    "done": 0,
    "refused": 1,
    "abort": 1,
    "holding": 1,
    "secured": 1,
    "resting": 1,
    "balancing": 2,
    "let_fly": 2,
    "braked_refused": 3,
    "braked_held": 3,
    "braked_down": 3,
    "braked_free": 4,
}
"""How little authority each end leaves the ground: over arm, UAV and grip; over arm and one of them; over grip and UAV with the
arm braked; over nothing. Escalation only ever goes up, so it ends."""

DEBOUNCE_S = {
    "non_finite": 0.02,
    "wrench_drift": 0.3,
    "magnet_coil": 0.02,
    "encoder_frozen": 0.012,
    "power_lost": 0.03,
    # What tells a UAV without power from one without link takes this long.
    "uav_silent": 0.05,
    "camera_leap": 0.0,
    "wrench_wrong": 0.04,
    "link_late": 0.05,
    "thrust_short": 0.002,
    "magnet_stuck": 0.002,
    "arm_blocked": 0.05,
    "thrust_lost": 0.15,
    "overload": 0.003,
    "rotor_lost": 0.005,
    "uav_tilt": 0.04,
    "slip": 0.05,
    "near_limit": 0.02,
}
"""Time for which a fault's sign must be seen; one tick where nothing is said: ages are debounced by themselves."""


def debounce_ticks(tick_s: float) -> NDArray[np.int64]:
    """Ticks (32,) for which each fault's sign must be seen, at ticks of `tick_s` s."""
    out = np.zeros(FAULT_ROWS, np.int64)
    for fault, i in FAULT.items():
        out[i] = max(round(DEBOUNCE_S.get(fault, 0.0) / tick_s), 1) if i else 0
    return out


def fault_rows(
    phases: tuple[Phase, ...],
    faults: Mapping[str, Mapping[str, str]] = FAULT_TABLE,
    escalation: Mapping[str, Mapping[str, str]] = ESCALATION,
) -> NDArray[np.int64]:
    """Final phase (32, 32) by index for each fault in each phase; −1 where the fault does not matter.

    Args:
        phases: of a mission, its ends included.
        faults: fault -> kind of phase -> end.
        escalation: end -> second fault -> graver end.
    """
    names = [p.name for p in phases]
    rows = np.full((FAULT_ROWS, PHASES), -1, dtype=np.int64)
    for fault, f in FAULT.items():
        for k, p in enumerate(phases):
            row = escalation.get(p.name, {}) if p.kind == "end" else faults.get(fault, {})
            target = row.get(fault if p.kind == "end" else p.kind, "-")
            if target != "-" and (p.sight or fault != "camera_stale"):
                rows[f, k] = names.index(target)
    return rows
