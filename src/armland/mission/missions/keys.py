"""Which keys of a scenario missions use: prefixes of dotted paths. A key that a mission does not use is refused by name."""


def _of(section: str, keys: str) -> tuple[str, ...]:
    return tuple(f"{section}.{key}" for key in keys.split())


SHARED = (
    *("run", "arm", "tool", "hinge", "uav", "rotors", "onboard", "link", "sensors", "environment"),
    *("imperfections.noise", "disturbance", "faults", "belief"),
    *_of("control", "law orientation_kp orientation_kd elbow_force_n null_space_damping_nms range_margin_rad"),
    *_of("control", "posture_rad_s range_stiffness_nm free_rad_s free_damping approach.coast_s"),
)
"""Keys of the hardware and of what every controller does."""

GEAR = (
    *(
        "plate",
        "magnet",
        "skids",
        "cradle",
        "camera",
        "imperfections",
        "deviation",
        "air",
        "sea",
        "motion_reference",
        "forecast",
        "bounds",
        "estimation",
        "limits",
    ),
    *_of("control", "approach station thrust"),
    *_of("place", "catch_m put_down_m home_deg wait_below_m waits_above_m standoff_m above_m search_m withdraw_m"),
    *_of("place", "start_offset_m start_above_m start_speed_mps start_heading_deg"),
)
"""Keys of missions with a UAV that flies and a cradle."""

ON_MAGNET = _of("control", "position_rad_s position_damping")
"""Keys of the law of a UAV that the magnet holds."""

LAUNCH = _of("place", "takeoff_velocity_mps launch_m fly_on")
"""Keys of a take-off that gives the UAV a speed."""

HINGED = (
    *("trajectory", "harder", "experiments", "limits.sigma_min"),
    *_of("control", "k1 k2 k3 k3_attitude thrust_n observer_rad_s observer_limit_n observer_limit_nm"),
    *_of("control", "takeover_limit_n coriolis_feedforward"),
)
"""Keys of missions with the UAV bound to the arm; `harder` is the comparison's second path."""
