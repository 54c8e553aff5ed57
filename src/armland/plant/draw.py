"""What a seed makes of the imperfections: where the UAV is at the start, and what sensors and rotors get wrong."""

from typing import Literal, NamedTuple

import numpy as np

from armland.plant.noise import stream
from armland.rotations import Array, from_rotation_vector, multiply
from armland.scenario import Scenario

Start = Literal["hinged", "air", "cradle"]
"""Where the UAV is at the start: on the arm's hinge, above the catch, or on the cradle with its rotors stopped."""


class Draw(NamedTuple):
    """Start and imperfections of one seed: offsets in space, biases of sensors, strength of the rotors."""

    position: Array
    """(3,) m, pivot at the start in the air, W."""
    velocity: Array
    """(3,) m/s, W."""
    heading: float
    """rad."""
    wrench_bias: Array
    """(6,) N, N·m, of the force-torque sensor."""
    imu_bias: Array
    """(4,), see `devices.imu`."""
    thrust_factor: float
    """Thrust given over thrust asked for."""
    force_bias: Array
    """(3,) m/s², B, of the UAV's accelerometers."""


def draw(scenario: Scenario, start: Start) -> Draw:
    """Start and imperfections of the scenario's seed; independent of everything else that is random.

    A UAV that is hinged on the arm has been calibrated there: for it nothing is drawn.
    """
    u = stream(scenario.run.seed, "landing").uniform(-1.0, 1.0, 20)
    if start == "hinged":
        u[:] = 0.0
    place, bad = scenario.place, scenario.imperfections
    tilt = np.deg2rad(bad.tilt_error_deg) * np.array([u[7], u[8], 0.0])
    heading = np.array([0.0, 0.0, np.deg2rad(bad.heading_error_deg) * u[9]])
    return Draw(
        position=np.array(place.catch_m) + [0.0, 0.0, place.start_above_m] + u[:3] * place.start_offset_m,
        velocity=u[3:6] * place.start_speed_mps,
        heading=float(np.deg2rad(place.start_heading_deg) * u[6]),
        wrench_bias=np.concatenate([bad.force_bias_n * u[10:13], bad.torque_bias_nm * u[13:16]]),
        imu_bias=multiply(from_rotation_vector(heading), from_rotation_vector(tilt)),
        thrust_factor=float(1.0 + bad.thrust_error * u[16]),
        force_bias=bad.acceleration_bias_mps2 * u[17:20],
    )
