"""What the landing's controller is told and what it keeps: parameters and memory as structured records of shape (1,)."""

from functools import lru_cache

import numpy as np

RING = 256
"""Ticks of thrust commands that the ground remembers, to know which one acts."""


@lru_cache
def parameters_layout(joints: int, phases: int) -> np.dtype:
    """Parameters of the landing's controller for an arm with `joints` joints and a mission of `phases` phases."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            # UAV
            ("mass", "f8"),  # kg, that flies: plate included
            ("body_mass", "f8"),  # kg, that the hinge carries
            ("inertia", "f8", (3, 3)),
            ("lever", "f8", (3,)),
            ("weight", "f8"),  # N, of all that flies
            ("station", "f8", (3,)),  # m, pivot [w]
            ("heading", "f8"),  # rad
            ("uplink", "i8"),  # ticks until a thrust command acts on board
            ("rotor_gain", "f8"),
            ("thrust_rate", "f8"),  # N/s
            ("thrust_max", "f8"),  # N
            ("thrust_min", "f8"),  # N
            ("force_slack", "f8"),  # N, hinge force behind its expectation that stops the ramp
            ("station_period", "i8"),  # ticks
            ("drag", "f8"),  # N·s/m, horizontal
            ("launch", "f8", (3,)),  # m/s, velocity that a take-off gives to the UAV [w]
            ("fly_on", "i8"),  # 1 where the UAV keeps it with all its thrust
            # Arm
            ("k_free", "f8"),  # 1/s², position error to acceleration while nothing is held
            ("d_free", "f8"),  # 1/s
            ("k1", "f8", (6,)),
            ("k2", "f8", (6,)),
            ("k3", "f8"),
            ("k3_attitude", "f8"),
            ("observer", "f8"),  # rad/s
            ("force_limit", "f8"),  # N, of the observer
            ("orientation_kp", "f8"),
            ("orientation_kd", "f8"),
            ("R_d", "f8", (3, 3)),
            ("elbow", "i8"),
            ("elbow_force", "f8"),
            ("null_damping", "f8"),
            ("range_margin", "f8"),
            ("range_stiffness", "f8"),
            ("q_min", "f8", (joints,)),
            ("q_max", "f8", (joints,)),
            ("tau_max", "f8", (joints,)),
            ("qd_max", "f8", (joints,)),
            # Reference
            ("standoff", "f8"),  # m
            ("beyond", "f8"),  # m, how far beyond the plate's face the arm would close
            ("depth", "f8"),  # m, that the arm backs off
            ("launch_s", "f8"),  # s, of the run-up, and of coming to rest
            ("leave_s", "f8"),  # s, in which the arm goes down by the depth
            ("targets", "f8", (phases, 3)),  # m, end effector [w], of the phases that move
            ("track", "f8"),  # rad/s, of the filter on the plate's motion
            ("track_a", "f8"),  # m/s², its largest acceleration
            ("coast", "f8"),  # s, in which the reference comes to rest
            ("admittance", "f8"),  # m/s/N, of a yielding arm
            ("admittance_max", "f8"),  # m
            # Balance
            ("balance", "f8", (4,)),  # gains of (B.3)
            ("fall_rate", "f8"),  # rad/s
            ("push_max", "f8"),  # m/s²
            ("sway_max", "f8"),  # m
            ("swing", "f8"),  # share of the pivot's way that the wrist makes
            ("wrist", "f8"),  # m, from the wrist to the pivot
            ("attitude_age", "i8"),  # ticks, of an attitude that can be balanced by
            ("down", "f8"),  # m, height of the pivot when the UAV stands on the cradle
            ("lost", "f8"),  # rad, capture point beyond which it cannot be balanced
            ("settle", "f8"),  # m, height above it below which a UAV is set down and not balanced
            ("near", "f8"),  # m, height above it at which the rails may touch
            ("tip", "f8"),  # rad per m/s²: how far the arm's acceleration tilts the UAV on its hinge
            ("capture_max", "f8"),  # rad, capture point at which a held UAV counts as falling
            # Camera
            ("camera", "f8", (3,)),  # m, end effector frame
            # Supervisor
            ("torque_rate", "f8"),  # N·m/s
            ("speed_share", "f8"),
            ("joint_margin", "f8"),  # rad
            ("sigma_min", "f8"),
            ("uav_age", "i8"),  # ticks
            ("camera_age", "f8"),  # s
            ("arm_age", "i8"),  # ticks
            ("wrench_age", "i8"),  # ticks
            ("hinge_max", "f8"),  # N
            ("tilt_max", "f8"),  # rad
            ("slip", "f8"),  # m
            ("rated", "f8"),  # N
            ("magnet_share", "f8"),
            ("free_tolerance", "f8"),  # N
            ("clear_z", "f8"),  # m, height of the end effector above which the cradle carries nothing
        ]
    )


@lru_cache
def memory_layout(joints: int) -> np.dtype:
    """What the controller keeps from tick to tick."""
    return np.dtype(
        [
            ("started", "i8"),
            ("phase", "i8"),
            ("begin", "i8"),  # tick at which the phase began
            ("retries", "i8"),
            ("fault", "i8"),
            ("held", "i8"),
            ("tip", "f8"),  # rad, that the arm's acceleration explains
            ("jolted", "i8"),  # tick at which the end effector last missed its reference by a jolt
            ("caught", "i8"),  # tick at which the UAV was held first
            # Reference of the arm
            ("r0", "f8", (3,)),
            ("v0", "f8", (3,)),
            ("p", "f8", (3,)),  # plate as tracked
            ("pv", "f8", (3,)),
            ("pa", "f8", (3,)),
            ("grip", "f8", (3,)),  # end effector where the magnet was switched off last
            ("yielded", "f8", (3,)),
            # Balance
            ("balancing", "i8"),  # see `landing_balance`
            ("sway", "f8", (2,)),  # m [w]
            ("sway_v", "f8", (2,)),  # m/s
            ("sway_a", "f8", (2,)),  # m/s²
            ("sway_log", "f8", (RING, 2)),  # m/s, the pivot's velocity
            ("lean", "f8", (3,)),  # rad [w]
            ("lean_v", "f8", (3,)),  # rad/s
            ("lean_a", "f8", (3,)),  # rad/s²
            # UAV
            ("thrust_log", "f8", (RING,)),
            ("thrust", "f8"),  # command
            ("acting", "f8"),  # as far as is known
            ("hover", "f8"),  # N, command that carries the weight
            ("integral", "f8", (3,)),
            ("anchor", "f8", (3,)),  # m, where its centre of mass was when it began to fly on [w]
            ("cruising", "i8"),  # tick of that; 0: not yet
            ("q_d", "f8", (4,)),  # set-point [w]
            # Observer (X.3)
            ("d", "f8", (3,)),  # N
            ("linear", "f8", (3,)),  # N·s
            ("force", "f8", (3,)),  # N, asked last
            ("observing", "i8"),
            # Supervisor
            ("tau", "f8", (joints,)),
            ("good_q", "f8", (joints,)),
            ("counts", "i8", (16,)),  # ticks for which each fault's sign has been seen
            ("sigma", "f8"),
            ("seen", "i8"),  # 1 once the plate has been seen
            ("grip_offset", "f8"),  # m, of the plate's pivot from the end effector, in the newest image
            ("grip_tick", "i8"),  # that image's exposure
            ("grip_far", "i8"),  # images in a row in which it was too far off
        ]
    )
