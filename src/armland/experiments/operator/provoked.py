"""What has to fail in the plant for the supervisor to find each of its faults."""

from typing import Any

Failure = dict[str, Any]
"""Keys of `Fault` but for phase and time."""

KNOCK: Failure = {"kind": "push", "body": "tool", "size": 115.0, "direction": (0.0, 0.0, -1.0), "lasts_s": 0.05}
"""A blow on the tool, beyond the force sensor."""

JERK: Failure = {"kind": "overload", "size": -125.0, "lasts_s": 0.02}
"""A UAV that stands is jerked upwards: on the cradle a blow downwards is the rails' to bear."""

SHOVE: Failure = {"kind": "push", "body": "uav", "size": 1.5, "direction": (0.0, 1.0, 0.0)}
"""The UAV is pushed aside."""

LEAN: Failure = {"kind": "push", "body": "elbow", "size": 40.0, "direction": (0.0, 1.0, 0.0)}
"""Somebody leans against the elbow: neither the force sensor nor the tool's place shows it."""

WEDGE: Failure = {"kind": "push", "body": "elbow", "size": 200.0, "direction": (0.0, 0.0, 1.0)}
"""The elbow is held up, and stays so."""

PROVOKED: dict[str, Failure] = {
    "non_finite": {"kind": "non_finite", "device": "wrench"},
    "encoder_frozen": {"kind": "encoder_frozen", "joint": 2},
    "arm_stale": {"kind": "arm_stale"},
    "power_lost": {"kind": "power_loss"},
    "link_late": {"kind": "link_delay", "size": 100.0},
    "uav_silent": {"kind": "link_loss"},
    "camera_stale": {"kind": "camera_lost"},
    "camera_leap": {"kind": "wrong_marker", "size": 0.1, "direction": (1.0, 0.0, 0.0)},
    "camera_noise": {"kind": "camera_noise", "size": 6.0},
    "wrench_stale": {"kind": "wrench_frozen"},
    "wrench_wrong": {"kind": "wrench_dead"},
    "wrench_drift": {"kind": "wrench_drift", "size": 6.0},
    "magnet_coil": {"kind": "magnet_coil", "size": 0.5},
    "magnet_stuck": {"kind": "magnet_stuck", "size": 1.0},
    "arm_blocked": LEAN,
    "overload": KNOCK,
    "rotor_lost": {"kind": "rotor_loss", "size": 1.0},
    "thrust_lost": {"kind": "thrust_loss", "size": 0.3},
    "thrust_short": {"kind": "thrust_loss", "size": 0.25},
    "uav_tilt": {"kind": "attitude_offset", "size": 0.8, "direction": (1.0, 0.0, 0.0)},
    "slip": {"kind": "magnet_slip", "size": 1.0},
    # The elbow is pushed: the tool may hardly move, the joints must.
    "near_limit": {"kind": "push", "body": "elbow", "size": 250.0, "direction": (0.0, 1.0, 0.0), "lasts_s": 0.15},
}
"""What fails in the plant, for each fault of the supervisor but the one that is the law's."""
