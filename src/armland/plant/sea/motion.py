"""The deck's motion as a sum of harmonics: smooth in time, with velocity and acceleration in closed form.

| symbol | name | unit |
|---|---|---|
| q = q₀ + v₀ t + Re Σ A e^{iωt} | surge, sway, heave, roll, pitch, yaw (6,) | m, rad |
| ω (n,), A (n, 6) | `omega`, `amplitude` | rad/s; m, rad |
| q₀, v₀ | `origin`, `drift` (6,) | m, rad; m/s, rad/s |

Attitude of the deck is R_z(yaw) R_y(pitch) R_x(roll).
"""

from typing import NamedTuple

import numpy as np

from armland.rotations import Array

FINE = 100
"""Ticks between two phases that are worked out anew; between them they are carried on, which is as exact."""


class Motion(NamedTuple):
    """What the deck does, for all times."""

    omega: Array
    amplitude: Array
    origin: Array
    drift: Array

    def at(self, times: Array, derivative: int = 0) -> Array:
        """q (k, 6), or its first or second `derivative`, m and rad per s and s², at `times` (k,), s."""
        amplitude = (1j * self.omega[:, None]) ** derivative * self.amplitude
        steady = (self.origin + np.outer(times, self.drift), self.drift, 0.0)[derivative]
        return np.real(np.exp(1j * np.outer(times, self.omega)) @ amplitude) + steady

    def sampled(self, rate: float, first: int, count: int) -> Array:
        """q (count, 6), m, rad, at the ticks from `first` on of a clock with `rate`, Hz."""
        coarse = np.arange(-(-count // FINE)) * FINE + first
        turns = np.exp(1j * np.outer(np.arange(FINE), self.omega) / rate)
        # For each tick between two coarse ones the amplitudes that it turns.
        turned = (turns[:, :, None] * self.amplitude).transpose(1, 0, 2).reshape(len(self.omega), -1)
        out = np.real(np.exp(1j * np.outer(coarse, self.omega) / rate) @ turned).reshape(-1, 6)[:count]
        return out + self.origin + np.outer((np.arange(count) + first) / rate, self.drift)

    def significant(self) -> Array:
        """Significant single amplitude (6,) of each motion, m, rad: twice its standard deviation."""
        return 2.0 * np.sqrt(0.5 * np.sum(np.abs(self.amplitude) ** 2, axis=0))
