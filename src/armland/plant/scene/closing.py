"""How faces meet: a gap that closes the same at each step size."""

import numpy as np

RATE = 500.0
"""1/s, with which skids and rails, and a magnet's face and its plate, meet: fast beside the buffers, slow enough for a step of 1 ms.
Assumption for the face, where it is 1/T in `models.capture`."""


def closing(rate: float, step: float) -> list[float]:
    """MuJoCo's `solref` of a contact whose gap closes as (1 + λ t) e^(−λ t), sampled exactly: the same at each step size.

    Both roots of a step's recursion z² − (2 − B h − K h²) z + (1 − B h) = 0 are e^(−λ h).

    Args:
        rate: λ, 1/s.
        step: h, s.

    Returns:
        −K in 1/s² and −B in 1/s.
    """
    left = np.exp(-rate * step)
    return [-(((1.0 - left) / step) ** 2), -(1.0 - left**2) / step]
