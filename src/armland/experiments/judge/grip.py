"""What the magnet has to hold, by direction: pull off its face and shear along it. A push on the face is no load.

| symbol | name | unit |
|---|---|---|
| F | `truth.hinge_force`: of the arm on the UAV | N, W |
| n | the plate's normal, away from the magnet | 1, W |
| P = max(−F·n, 0) | pull | N |
| S = \\|F − (F·n) n\\| | shear | N |
| F₀, μ | rating, `magnet.shear_share` | N, 1 |
| μ (F₀ − P) | shear that the face holds: friction of what presses it on | N |

F is taken at the hinge: the plate between it and the face, 0.05 kg, is left out.
"""

import numpy as np
from numpy.typing import NDArray

from armland.experiments.judge.brief import Hold, Ticks
from armland.rotations import Array

ON = 1  # `command.magnet` of a magnet that has to hold


def loads(ticks: Ticks) -> tuple[Array, Array]:
    """Pull and shear (k,), N, while the magnet holds; 0 where it is off or no pad touches."""
    truth = ticks["truth"]
    force, normal = truth["hinge_force"], _normals(truth["plate_quat"])
    along = np.sum(force * normal, axis=1)
    shear = np.linalg.norm(force - along[:, None] * normal, axis=1)
    held = (truth["touching"] > 0) & (ticks["command"]["magnet"] == ON)
    return np.where(held, np.maximum(-along, 0.0), 0.0), np.where(held, shear, 0.0)


def shear_ratio(pull: Array, shear: Array, hold: Hold) -> Array:
    """Shear (k,) over what the face then holds, 1; infinite where the pull leaves nothing."""
    held = hold.shear_share * (hold.rating_n - pull)
    return np.where(shear > 0.0, np.divide(shear, held, out=np.full_like(shear, np.inf), where=held > 0.0), 0.0)


def _normals(quat: NDArray[np.float64]) -> Array:
    # The third column of the rotation matrix.
    w, x, y, z = quat.T
    return np.stack([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)], axis=1)
