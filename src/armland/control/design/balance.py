"""Gains of the balance by its poles (B.4); not compiled: called once. Symbols as in `control.laws.balance`.

With (B.3) the balance has the polynomial s⁴ + (ω₀²k_ω/g − k_v) s³ + (ω₀²k_θ/g − k_x − ω₀²) s² + ω₀² k_v s + ω₀² k_x, so that four
wanted poles with the polynomial s⁴ + a₃s³ + a₂s² + a₁s + a₀ take

    k_x = a₀/ω₀²,  k_v = a₁/ω₀²,  k_ω = (a₃ + k_v) g/ω₀²,  k_θ = (a₂ + k_x + ω₀²) g/ω₀²      (B.4)

All four gains are positive: a pivot that stands too far to one side first moves further out, and the body leans back.
"""

import numpy as np

from armland.control.design.margins import pendulum
from armland.control.laws.balance import BalanceGains
from armland.control.laws.rigid_body import UavParameters
from armland.errors import ConfigurationError
from armland.models.environment import STANDARD_GRAVITY

POLES = (2.0, 1.5, 2.0 / 3.0, 2.0 / 3.0)
"""Wanted poles over −ω₀: two that right the body as fast as the arm's delays allow, two that bring the pivot back."""


def fall_rate(uav: UavParameters) -> float:
    """ω₀, rad/s, of a body whose pivot is below its centre of mass, by the mean of its two axes.

    Raises:
        ConfigurationError: a body that hangs from its pivot needs no balancing.
    """
    swung, fall = np.mean([pendulum(axis, uav) for axis in range(2)], axis=0)
    if fall <= 0.0:
        raise ConfigurationError(f"the pivot lies {uav.lever[2]:g} m above the centre of mass; it must lie below it")
    return float(np.sqrt(fall / swung))


def balance_gains(rate: float, poles: tuple[float, ...] = POLES) -> BalanceGains:
    """Gains of (B.3) for ω₀ = `rate`, rad/s, and four poles at −ω₀ times `poles`. Source: (B.4)."""
    a3, a2, a1, a0 = np.poly(-rate * np.asarray(poles))[1:]
    w2 = rate**2
    position, speed = a0 / w2, a1 / w2
    tilt, tilt_rate = (a2 + position + w2) * STANDARD_GRAVITY / w2, (a3 + speed) * STANDARD_GRAVITY / w2
    return BalanceGains(float(position), float(speed), float(tilt), float(tilt_rate))  # (B.4)
