"""The deck at the ticks of a run, moving as MuJoCo's own step would move it.

A step of MuJoCo gives the speed first and the place with the new speed. So speed and acceleration at a tick are the differences that
lead from place to place: the deck then meets what lies on it as a body would that was simulated, half a step late in its speed.
"""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from armland.plant.sea.measured import measured_motion
from armland.plant.sea.motion import Motion
from armland.plant.sea.recorded import recorded_motion
from armland.plant.sea.waves import wave_motion
from armland.rotations import Array
from armland.scenario import Scenario

TO_JOINTS = [0, 1, 2, 5, 4, 3]
"""Surge, sway, heave, yaw, pitch, roll: the order of the deck's joints."""


def deck_motion(scenario: Scenario) -> Motion:
    """The deck's motion for the scenario's seed; of a calm sea none.

    Raises:
        ConfigurationError: a file of the sea that cannot be used.
    """
    sea = scenario.sea
    if sea.trace is not None:
        return recorded_motion(Path(sea.trace), scenario.run.duration_s)
    if sea.waves:
        return wave_motion(scenario)
    if sea.moves:
        return measured_motion(scenario)
    return Motion(np.zeros(0), np.zeros((0, 6), complex), np.zeros(6), np.zeros(6))


def timed_deck(scenario: Scenario) -> Array:
    """Positions, speeds and accelerations (ticks, 18) of the deck's joints, m, rad, per s and s²; (0, 18) where the sea is calm.

    Raises:
        ConfigurationError: a file of the sea that cannot be used.
    """
    if not scenario.sea.moves:
        return np.zeros((0, 18))
    rate = scenario.run.rate_hz
    q = deck_motion(scenario).sampled(rate, -1, round(scenario.run.duration_s * rate) + 2)[:, TO_JOINTS]
    lever = np.array(scenario.sea.base_m)
    q[:, :3] += Rotation.from_euler("ZYX", q[:, 3:]).apply(lever) - lever
    v = np.diff(q, axis=0) * rate
    return np.hstack([q[1:-1], v[:-1], np.diff(v, axis=0) * rate])


def on_deck(row: Array, place: Array, quat: Array, level: bool) -> tuple[Array, Array]:
    """Where in W a place on the deck is, (3,), m, and an attitude there, (4,), scalar first.

    Args:
        row: of `timed_deck` (18,), m, rad, per s and s².
        place: (3,), m, D.
        quat: (4,), D<-body, scalar first.
        level: whether it has only the deck's heading.
    """
    turn = Rotation.from_euler("ZYX", row[3:6])
    turned = Rotation.from_euler("Z", row[3]) if level else turn
    out = turned * Rotation.from_quat(quat, scalar_first=True)
    return row[:3] + turn.apply(place), out.as_quat(scalar_first=True)


def velocity_on_deck(row: Array, place: Array, R: Array) -> Array:
    """Velocity (3,), m/s, W, and angular velocity (3,), rad/s, body, of what lies on the deck at `place` (3,), m, W.

    Args:
        row: of `timed_deck` (18,), m, rad, per s and s².
        place: (3,), m, W.
        R: its attitude (3, 3), a rotation W<-body.
    """
    yaw, pitch = Rotation.from_euler("Z", row[3]), Rotation.from_euler("ZY", row[3:5])
    axes = np.array([[0.0, 0.0, 1.0], yaw.apply([0.0, 1.0, 0.0]), pitch.apply([1.0, 0.0, 0.0])])
    omega = row[9:12] @ axes
    return np.concatenate([row[6:9] + np.cross(omega, place - row[:3]), R.T @ omega])
