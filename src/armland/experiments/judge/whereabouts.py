"""Where the UAV really was when a record ended, and in words what arm, magnet and UAV then did."""

import numpy as np
from numpy.typing import NDArray

from armland.experiments.judge.brief import Brief, Ticks
from armland.experiments.judge.deck import deck_speed
from armland.rotations import Array

FLYING_SPEED_MPS = 0.6  # A UAV that flies off by itself is not faster, unless the arm has given it more
TOPPLED_DEG = 25.0  # Tilt beyond which a UAV does not stand and, beyond what it leans against the wind, does not fly under control
LEANING_DEG = 46.0  # Tilt of one that leans on both of the hinge's stops, 30 degrees each, a little askew
FALL_MPS = 1.2  # Faster than this downwards is a fall: from 7 cm

STILL_MPS, CARRIED_N, CARRIED_SHARE, LOW_M = 0.05, 1.0, 0.2, 0.6
"""Speed of what rests; force on the rails of a UAV that stands, or the share of its weight where that is less; pivot height below
which nothing flies."""

BALANCED_MPS = 0.3  # Speed up to which an arm moves a UAV that it holds: one that it balances in gusts

ARM_REST_M = 0.002  # Displacement of the end effector in the last quarter of a second within which the arm is at rest


def tilt_deg(quat: Array) -> Array:
    """Angle of the body's z axis to the vertical, degrees, of quaternions (k, 4)."""
    return np.rad2deg(np.arccos(np.clip(1.0 - 2.0 * (quat[..., 1] ** 2 + quat[..., 2] ** 2), -1.0, 1.0)))


def least(force: float, share: float, brief: Brief) -> float:
    """`force`, N, or the `share` of the UAV's weight where that is less."""
    return min(force, share * brief.weight)


def state_of(ticks: Ticks, brief: Brief) -> str:
    """How the UAV ended: `flying`, `held`, `standing`, or, where it is none of these or fell before, `lost`."""
    truth = ticks["truth"]
    late = truth[-brief.rate_hz // 4 :]
    speed, tilt = np.linalg.norm(late["v"], axis=1).max(), tilt_deg(late["quat"]).max()
    if brief.start == "hinged":
        return "held" if tilt < TOPPLED_DEG else "lost"
    # What hovers in the world moves against a deck that heaves.
    deck = deck_speed(truth)
    if truth["v"][:, 2].min() < -FALL_MPS - deck:
        return "lost"
    # One that leans on its hinge may press on a rail, too: it does not stand.
    carried = late["cradle_force"][:, 2].min() > least(CARRIED_N, CARRIED_SHARE, brief)
    if speed < STILL_MPS and carried and tilt < TOPPLED_DEG:
        return "standing"
    # One that has toppled over its hinge is not held, even where the magnet grips; least of all one that lies on the arm.
    toppled = late["foul"][:, 2].any() or tilt > LEANING_DEG
    if speed < BALANCED_MPS and late["touching"].min() == 4 and not toppled:
        return "held"
    lean, blown = brief.swayed
    allowed = max(FLYING_SPEED_MPS, 0.25 + float(np.linalg.norm(brief.given))) + blown + deck
    if late["r"][:, 2].min() > LOW_M and speed < allowed and tilt < TOPPLED_DEG + lean:
        return "flying"
    return "lost"


def in_words(ticks: Ticks, brief: Brief) -> str:
    """What arm, magnet and UAV really do at the end, e.g. `the arm rests, the magnet is off, the UAV flies by itself`."""
    ee, command = ticks["truth"]["ee"][-brief.rate_hz // 4 :], ticks["command"][-1]
    arm = "the arm moves"
    if command["brake"]:
        arm = "the arm's brakes are on"
    elif np.ptp(ee, axis=0).max() < ARM_REST_M:
        arm = "the arm holds still"
    magnet = "" if brief.start == "hinged" else f", the magnet is {'on' if command['magnet'] else 'off'}"
    return f"{arm}{magnet}, {_uav(ticks, brief)}"


def _uav(ticks: Ticks, brief: Brief) -> str:
    state, truth = state_of(ticks, brief), ticks["truth"]
    x, y, z = (float(c) for c in truth["r_cm"][-1])
    if state == "flying":
        return f"the UAV flies at a height of {z:.2f} m"
    if state == "held":
        return "the UAV is held by the arm"
    if state == "standing":
        running = truth["rotor_thrust"][-1].sum() > least(CARRIED_N, CARRIED_SHARE, brief)
        return f"the UAV stands on the cradle, its rotors {'running' if running else 'stopped'}"
    return f"the UAV is lost: it {_fate(truth, brief.swayed[0])}, and is now at ({x:.2f}, {y:.2f}, {z:.2f}) m"


def _fate(truth: NDArray[np.void], lean: float) -> str:
    fall, tilt = float(-truth["v"][:, 2].min()), float(tilt_deg(truth["quat"][-1]))
    if fall > FALL_MPS:
        return f"fell at up to {fall:.1f} m/s"
    if truth["foul"][-1, 2]:
        return "lies against the arm"
    if tilt > TOPPLED_DEG + lean:
        return f"has toppled by {tilt:.0f}°"
    return f"is out of control at {float(np.linalg.norm(truth['v'][-1])):.2f} m/s with {tilt:.0f}° of tilt"
