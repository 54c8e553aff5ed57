"""A law of one's own for the UAV that the arm holds: computed force for the arm, a PD controller for the attitude.

Fly it, and compare it with the laws that come with armland:

    armland run E3 --law examples/own_law.py:my_law
    armland land --law examples/own_law.py:my_law
    armland paper --compare --law examples/own_law.py:my_law
"""

import numpy as np

from armland.rotations import matrix

BANDWIDTH = 30.0  # rad/s, of the pivot's position, critically damped
STIFFNESS, DAMPING = 0.3, 0.2  # N·m/rad and N·m·s/rad, of the attitude
GRAVITY = np.array([0.0, 0.0, -9.81])  # m/s²


def my_law(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    """Torque delta_tau (3,), N·m, body, that the UAV shall add, and force (3,), N, deck, of the arm on it at the pivot."""
    R = matrix(q)
    # The pivot moves with the centre of mass and turns about it.
    v_pivot = v + R @ np.cross(omega, uav.lever)
    a = reference.a_d + 2.0 * BANDWIDTH * (reference.v_d - v_pivot) + BANDWIDTH**2 * (reference.r_d - r)
    force = uav.mass * (a - GRAVITY) - thrust * R[:, 2]
    # Twice the sine of the angle is what R_dᵀR and its transpose differ by.
    E = matrix(reference.q_d).T @ R
    turn = 0.5 * np.array([E[2, 1] - E[1, 2], E[0, 2] - E[2, 0], E[1, 0] - E[0, 1]])
    # What the force makes at the lever arm would turn the UAV.
    moment = np.cross(uav.lever, force @ R)
    delta_tau = -STIFFNESS * turn - DAMPING * (omega - reference.omega_d) - moment
    return delta_tau, force
