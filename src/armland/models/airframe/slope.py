"""How much of the torque that a controller on board means its rotors make, where it does not know their thrust curve; compiled.

| symbol | name | unit |
|---|---|---|
| T(p) = c₂p² + c₁p + c₀ | `rotors.curve`: thrust of one rotor at p percent of its motor's command | N |
| T_h | thrust of one rotor that carries the UAV | N |
| s | `onboard.slope_share`: 0 knows the curve, 1 takes its slope for that of hover | 1 |

A controller that turns torque into motor commands by the slope of T in hover gives T′(p)/T′(p_h) of it at another thrust. T solved
for p gives T′ = √(c₁² + 4c₂(T − c₀)).
"""

from typing import Any

import numpy as np
from numba import njit

from armland.errors import ModelError
from armland.records import Record, Records
from armland.scenario import Scenario


def slope_layout() -> list[Any]:
    """Fields that `torque_share` is told."""
    return [
        ("slope_share", "f8"),
        ("slope_square", "f8"),  # T′² without thrust over that in hover
        ("slope_per_n", "f8"),  # 1/N, what each N of thrust of all rotors adds to it
    ]


def tell_slope(told: Records, scenario: Scenario, weight: float, rotors: int) -> None:
    """Fill the fields of `slope_layout` in `told` (1,), for a UAV of `weight`, N, on so many rotors.

    Raises:
        ModelError: the curve does not rise where the UAV hovers, and its slope is asked for.
    """
    c2, c1, c0 = scenario.rotors.curve
    hover = c1**2 + 4.0 * c2 * (weight / rotors - c0)
    told["slope_share"] = scenario.onboard.slope_share
    if hover <= 0.0 or c0 >= weight / rotors:
        if scenario.onboard.slope_share > 0.0:
            raise ModelError(
                f"rotors.curve = {list(scenario.rotors.curve)} does not rise to the {weight / rotors:.3g} N "
                "at which each rotor hovers: c2 or c1 must be above 0, and c0 below that thrust"
            )
        return
    told["slope_square"], told["slope_per_n"] = (c1**2 - 4.0 * c2 * c0) / hover, 4.0 * c2 / rotors / hover


@njit(cache=True)
def torque_share(thrust: float, p: Record) -> float:
    """Torque made over torque meant, 1, at the `thrust` of all rotors together, N.

    Args:
        thrust: set-point.
        p: fields of `slope_layout`.
    """
    return 1.0 + p.slope_share * (np.sqrt(max(p.slope_square + p.slope_per_n * thrust, 0.0)) - 1.0)
