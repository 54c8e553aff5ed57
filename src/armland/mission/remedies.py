"""What a mission that has not reached its goal tells the person beside it: what was found, what holds now, what to do."""

from armland.mission.supervisor import FAULTS

REMEDIES: dict[str, tuple[str, str]] = {
    "non_finite": ("a device sends numbers that are none", "look at the device whose samples are flagged"),
    "arm_stale": ("the joints' samples stay away or leap", "check encoders and the arm's bus, then release the brakes"),
    "uav_silent": (
        "the UAV's link is silent in one direction or both, or its attitude leaps",
        "restore the link, look at the UAV's attitude sensor",
    ),
    "camera_stale": ("the camera has not seen the marker for too long", "clean or light the marker, check the camera"),
    "wrench_stale": ("the force-torque sensor's samples stay away", "check the sensor's bus"),
    "wrench_drift": (
        "the hinge force is not what load and thrust explain",
        "check the force sensor's zero and whether the UAV obeys its thrust command",
    ),
    "magnet_coil": ("the magnet's coil does not carry its current", "check coil and supply, repeat the self-test"),
    "overload": ("the hinge force exceeds what the magnet may be loaded with", "look for what pushes or has jammed"),
    "rotor_lost": (
        "the UAV begins to fall over on its hinge: a rotor is lost",
        "look at its motors before it flies again",
    ),
    "uav_tilt": ("the UAV is tilted beyond control", "stop its rotors and look at it"),
    "slip": ("the plate has slid off the magnet or the load is gone", "clean magnet and plate, check the rating"),
    "near_limit": (
        "a joint is near its end or too fast, or the arm near a singularity",
        "move the arm away by hand and look for what drove it there",
    ),
}
"""Fault -> what was found; what helps."""

STANDING: dict[str, str] = {
    "done": "the arm holds",
    "refused": "nothing has begun: the arm holds, the magnet is off, the UAV does what it did before",
    "abort": "the arm has drawn back and holds, the magnet is off, the UAV flies by itself",
    "holding": "the arm holds the UAV by the magnet, the UAV stays level with the thrust it has",
    "balancing": "the arm balances the UAV upright on its hinge, or has set it down on the rails, its rotors stopped, the magnet on",
    "let_fly": "the arm has drawn back, the magnet is off, the UAV flies by itself",
    "secured": "the UAV stands on the cradle with its rotors stopped, the magnet on, the arm gives way",
    "braked_refused": "nothing has begun: the arm's brakes are on, the magnet is off, the UAV does what it did before",
    "braked_free": "the arm's brakes are on, the magnet is off, the UAV flies by itself",
    "braked_held": "the arm's brakes are on, the magnet holds the UAV, which stays level with the thrust it has",
    "braked_down": "the arm's brakes are on, the UAV stands on the cradle with its rotors stopped, the magnet on",
}
"""End -> what arm, magnet and UAV do in it."""

TIMEOUTS: dict[str, str] = {
    "self_test": "magnet, bias of the force sensor or sight of the UAV were not ready: check magnet and camera",
    "guide": "the UAV did not come to its station: check that it obeys and has room",
    "miss": "the capture was missed too often: check wind, marker and magnet",
    "reach": "the arm did not arrive below the UAV: look for what is in its way",
    "touch": "the arm did not feel the plate: check that the UAV stands in the cradle",
    "grip": "the hinge did not come free of force: look for what has jammed",
    "spin_up": "the rotors did not come up to their share, or the camera does not see the marker",
    "lift": "the arm did not feel the UAV's weight: check the force sensor and whether the UAV obeys",
    "hand_over": "the arm did not take the weight over: check that the UAV obeys its thrust command",
    "carry": "the arm did not arrive: look for what is in its way",
    "carry_up": "the arm did not arrive: look for what is in its way",
    "set_down": "the cradle was not felt: check its place",
    "hand_back": "the hinge did not come free of force, or the camera does not see the marker",
    "unload": "the cradle did not take the weight over",
    "release": "the hinge did not come free of force: the plate may stick",
    "withdraw": "the plate may stick to the magnet",
    "clear": "the UAV did not come to its station: check that it obeys and has room",
}
"""Phase -> why it can run out of time, and what helps."""


def stopped(end: str, before: str, fault: str) -> str:
    """One sentence on a mission that ended in `end` after phase `before`; `fault` is `none` after a time-out."""
    if fault not in FAULTS[1:]:
        return f"ended in {end} after {before}: {TIMEOUTS.get(before, 'time was over')}; now {STANDING[end]}"
    found, remedy = REMEDIES[fault]
    return f"ended in {end} after {before}: {fault}, {found}; now {STANDING[end]}; {remedy}"
