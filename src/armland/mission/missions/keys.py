"""Which keys of a scenario missions use: prefixes of dotted paths. A key that a mission does not use is refused by name."""

SHARED = (
    "run",
    "arm",
    "tool",
    "hinge",
    "uav",
    "rotors",
    "onboard",
    "link",
    "sensors",
    "environment",
    "imperfections.noise",
    "disturbance",
    "faults",
    "belief",
    "control.law",
    "control.orientation_kp",
    "control.orientation_kd",
    "control.elbow_force_n",
    "control.null_space_damping_nms",
    "control.range_margin_rad",
    "control.range_stiffness_nm",
    "control.free_rad_s",
    "control.free_damping",
    "control.approach.coast_s",
)
"""Keys of the hardware and of what every controller does."""

GEAR = (
    "plate",
    "magnet",
    "skids",
    "cradle",
    "camera",
    "imperfections",
    "bounds",
    "estimation",
    "limits",
    "control.approach",
    "control.station",
    "control.thrust",
    "place.catch_m",
    "place.put_down_m",
    "place.home_deg",
    "place.wait_below_m",
    "place.standoff_m",
    "place.above_m",
    "place.withdraw_m",
    "place.start_offset_m",
    "place.start_above_m",
    "place.start_speed_mps",
    "place.start_heading_deg",
)
"""Keys of missions with a UAV that flies and a cradle."""

HELD = ("control.position_rad_s", "control.position_damping")
"""Keys of the law of a UAV that the magnet holds."""

LAUNCH = ("place.takeoff_velocity_mps", "place.launch_m", "place.fly_on")
"""Keys of a take-off that gives the UAV a speed."""

HINGED = (
    "trajectory",
    "harder",
    "experiments",
    "limits.sigma_min",
    "control.k1",
    "control.k2",
    "control.k3",
    "control.k3_attitude",
    "control.thrust_n",
    "control.observer_rad_s",
    "control.observer_limit_n",
    "control.observer_limit_nm",
    "control.takeover_limit_n",
    "control.coriolis_feedforward",
)
"""Keys of missions with the UAV bound to the arm; `harder` is the comparison's second path."""
