"""A deck whose motion grows or calms down while it moves: its places times a share that changes smoothly."""

import numpy as np

from armland.rotations import Array

SWELLS_S = 3.0
"""Time in which the share changes; as long as a wave."""


def turned(share: Array, tick: int, target: float, rate: int) -> Array:
    """The shares (k,) of each tick, which from `tick` on go over to `target`; place, speed and acceleration stay without a step.

    Args:
        share: as it was (k,), a ratio.
        tick: from which on it changes.
        target: ratio.
        rate: ticks a second.
    """
    x = np.clip((np.arange(len(share)) - tick) / (SWELLS_S * rate), 0.0, 1.0)
    s = x**3 * (10.0 + x * (-15.0 + 6.0 * x))
    return share * (1.0 - s) + target * s


def swelled(timed: Array, share: Array, rate: int) -> Array:
    """The deck's rows (k, 18) of `sea.timed` with their places times `share` (k,), a ratio; speeds and accelerations as they follow.

    Args:
        timed: (k, 18), m, rad, per s and s².
        share: of each tick.
        rate: ticks a second.
    """
    q = timed[:, :6] * share[:, None]
    v, a = timed[:, 6:12] * share[:, None], timed[:, 12:] * share[:, None]
    v[1:] = np.diff(q, axis=0) * rate
    a[:-1] = np.diff(v, axis=0) * rate
    return np.hstack([q, v, a])
