"""What a mission that has not reached its goal tells the person beside it: what was found, what is so now, what to do."""

from collections.abc import Mapping

from armland.mission.table.phases import SIGNALS
from armland.records import Record

REMEDIES: dict[str, tuple[str, str]] = {
    "non_finite": ("a device sends numbers that are none", "look at the device whose samples are flagged"),
    "encoder_frozen": (
        "a joint's encoder repeats one reading while the others move",
        "look at that encoder, then release the brakes",
    ),
    "power_lost": (
        "the UAV is silent and its rotors carry nothing: it has lost its power",
        "take it off the arm by hand and look at its battery",
    ),
    "camera_leap": (
        "the marker was found elsewhere at once, further than a UAV can fly",
        "look for another marker in view, or for what spoils the images",
    ),
    "camera_noise": (
        "the camera errs by more than five times what it claims",
        "light the marker, look at focus and exposure, state the camera's real noise",
    ),
    "wrench_wrong": (
        "the force-torque sensor does not feel the tool as it should: it is dead, reversed or badly scaled",
        "look at the sensor's wiring, axes and calibration",
    ),
    "link_late": (
        "the UAV's samples and the commands to it come, but later than it can be flown by",
        "look what else uses the radio channel, state the link's real delay",
    ),
    "thrust_short": (
        "the UAV that was let go lies on the arm: its rotors give less than its weight",
        "charge its battery, take off its load, look at its rotors",
    ),
    "magnet_stuck": (
        "the plate does not come off the magnet that was switched off",
        "look at coil, residual force and faces",
    ),
    "arm_blocked": (
        "something touches the arm in free motion or is in its way, or a joint fails or sticks",
        "look for what it touches, and whether masses and torques are as stated, then release the brakes",
    ),
    "thrust_lost": (
        "the UAV sinks, or would, with all the thrust that its rotors give",
        "charge its battery, take off its load, look at its rotors",
    ),
    "arm_stale": ("the joints' samples stay away or leap", "check encoders and the arm's bus, then release the brakes"),
    "uav_silent": (
        "the UAV's link is silent in one direction or both, or its attitude leaps",
        "restore the link, look at the UAV's attitude sensor",
    ),
    "camera_stale": (
        "the camera has not seen the marker for too long",
        "look whether the UAV has left the camera's view; else clean or light the marker, check the camera",
    ),
    "wrench_stale": ("the force-torque sensor's samples stay away", "check the sensor's bus"),
    "wrench_drift": (
        "the hinge force is not what load and thrust explain",
        "check the force sensor's zero and whether the UAV obeys its thrust command",
    ),
    "magnet_coil": ("the magnet's coil does not carry its current", "check coil and supply, repeat the self-test"),
    "overload": ("the hinge force exceeds what the magnet may be loaded with", "look for what pushes or has jammed"),
    "rotor_lost": (
        "the UAV says that a rotor gives less than its due",
        "look at its motors before it flies again",
    ),
    "uav_tilt": ("the UAV is tilted beyond control", "stop its rotors and look at it"),
    "slip": ("the plate has slid off the magnet or the load is gone", "clean magnet and plate, check the rating"),
    "near_limit": (
        "a joint is near its end or too fast, or the arm near a singularity",
        "move the arm away by hand and look for what drove it there",
    ),
    "law_failed": (
        "the law of the held UAV raised an exception or gave numbers that are none",
        "look at the law: tick, law and value are named with it",
    ),
}
"""Fault -> what was found; what helps."""

LEARNT: dict[str, str] = {
    "camera_noise": "by {camera_noise:.1f} times, as its images scatter",
    "link_late": "{uplink_ms:.0f} ms up and {downlink_ms:.0f} ms down, by the stamps",
    "thrust_lost": "they are asked for {hover:.2f} N; its weight was learnt as {weight:.2f} N, of which {force:.2f} N lie on the hinge",
    "thrust_short": "a command of {hover:.2f} N was learnt to carry its {weight:.2f} N",
    "wrench_drift": "{force:.1f} N were felt; the UAV's weight was learnt as {weight:.2f} N",
    "overload": "{force:.1f} N were felt",
}
"""Fault -> what was learnt in flight of its cause, from `learnt_values`."""

UNMET: dict[str, str] = {
    "progress": "the move had not come to its end",
    "elapsed": "the time that it takes was not over",
    "uav_seen": "the UAV was not seen",
    "uav_error": "the UAV was off its station",
    "uav_speed": "the UAV did not rest",
    "offset": "the plate was not above the magnet",
    "relative_speed": "the plate moved against the magnet",
    "tilt": "the UAV was tilted",
    "gap": "the plate was off the magnet",
    "contact": "no contact was felt",
    "pull": "the pull test was not felt",
    "thrust_left": "the rotors had not come to their thrust",
    "arm_share": "the arm did not carry its share",
    "ground_share": "the cradle did not carry its share",
    "hinge_force": "the hinge was not free of force",
    "retreat": "the arm had not drawn back far enough",
    "magnet_ready": "the magnet did not come to its force",
    "magnet_fault": "the magnet's driver did not say what it should",
    "arm_error": "the arm was off its reference",
    "retries": "the retries were not used up",
    "bias_known": "the force sensor's zero did not settle",
    "rotors": "the rotors still gave thrust",
    "lean": "the UAV did not take the attitude that was asked of it",
    "image_offset": "the images showed the plate beside the magnet",
    "image_gap": "the images showed the plate off the magnet",
    "spare": "gusts left the rotors no thrust to spare",
}
"""Signal of `phases.SIGNALS` -> what is so where a phase waits for it in vain."""

NOISE_TOLD = 2.0
"""Error of the camera over the one that it claims from which on a mission that ran out of time says so."""

STANDING: dict[str, str] = {
    "done": "the arm holds",
    "resting": "the arm comes to rest by its own impedance, the UAV stays level on its hinge",
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
"""End -> what arm, magnet and UAV are told to do in it; whether they do, the record of a flight says."""


def learnt_values(estimate: Record) -> dict[str, float]:
    """What `LEARNT` names, of one estimate: a factor, ms, N."""
    force = sum(float(x) ** 2 for x in estimate["hinge_force"]) ** 0.5
    values = {name: float(estimate[name]) for name in ("camera_noise", "weight", "hover")}
    return values | {f"{name}_ms": 1e3 * float(estimate[name]) for name in ("uplink", "downlink")} | {"force": force}


def stopped(
    end: str,
    before: str,
    fault: str,
    now: str,
    timeouts: Mapping[str, str],
    learnt: Mapping[str, float] | None = None,
    unmet: int = 0,
) -> str:
    """One sentence on a mission that ended in `end` after phase `before`.

    Args:
        end: name of the final phase.
        before: phase from which it was entered.
        fault: name of the fault; `none` after a time-out.
        now: what arm, magnet and UAV really do, as the record of the flight has it.
        timeouts: of the mission: phase -> why it can run out of time, and what helps.
        learnt: of `learnt_values`, when the fault was found; it is left out where nothing is given.
        unmet: bit i where the phase waited for signal i of `SIGNALS` in vain.
    """
    if fault == "operator":
        return f"ended in {end} after {before}: the operator aborted it; now {now}"
    if fault not in REMEDIES:
        why = timeouts.get(before, "time was over")
        missing = [UNMET[name] for i, name in enumerate(SIGNALS) if unmet >> i & 1]
        why += f" ({', '.join(missing)})" if missing else ""
        if learnt and learnt["camera_noise"] > NOISE_TOLD:
            why += f"; the camera errs {learnt['camera_noise']:.1f} times what it claims"
        return f"ended in {end} after {before}: {why}; now {now}"
    found, remedy = REMEDIES[fault]
    if learnt and fault in LEARNT:
        found += f" ({LEARNT[fault].format(**learnt)})"
    return f"ended in {end} after {before}: {fault}, {found}; now {now}; {remedy}"
