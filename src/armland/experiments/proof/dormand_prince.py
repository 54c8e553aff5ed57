"""One step of the Dormand–Prince pair: fifth order, with an embedded fourth order that says how far to trust it; compiled.

| symbol | name | unit |
|---|---|---|
| y | `y` (m,) | state, SI |
| kᵢ | `slopes` (7, m) | rate of y at each stage |
| h | `h` | s |
| c, a | `TIMES` (7,), `STAGES` (7, 6) | 1 |

The seventh stage stands at the step's end, so it is also the first of the next step (first same as last).

Source: Dormand, Prince, "A family of embedded Runge–Kutta formulae", 1980; step control: Hairer, Nørsett, Wanner,
"Solving Ordinary Differential Equations I", II.4.
"""

import numpy as np
from numba import njit

from armland.rotations import Array

TIMES = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])  # c: where in the step each stage stands

STAGES = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
"""a: the last row makes the fifth-order result."""

ERROR = np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
"""Fifth-order weights less fourth-order ones."""

SAFETY, SHRINK, GROW = 0.9, 0.2, 5.0
"""Of the step that the error allows, how much is taken; smallest and largest change from step to step."""


@njit(cache=True)
def stage(y: Array, slopes: Array, i: int, h: float, out: Array) -> None:
    """State `out` (m,) of stage i = 1…6 from y (m,) and the slopes of the stages before; i = 6 is the step's result."""
    for n in range(y.shape[0]):
        change = 0.0
        for j in range(i):
            change += STAGES[i, j] * slopes[j, n]
        out[n] = y[n] + h * change


@njit(cache=True)
def excess(y: Array, y_new: Array, slopes: Array, h: float, relative: float, absolute: float) -> float:
    """The step's estimated error over what is allowed, the largest of all elements; up to 1 the step is good.

    Allowed is relative·|y| + absolute, with the larger |y| of the step's two ends.
    """
    worst = 0.0
    for n in range(y.shape[0]):
        error = 0.0
        for j in range(7):
            error += ERROR[j] * slopes[j, n]
        worst = max(worst, abs(h * error) / (absolute + relative * max(abs(y[n]), abs(y_new[n]))))
    return worst


@njit(cache=True)
def next_step(h: float, over: float) -> float:
    """The step to try after one of h whose `excess` was `over`."""
    if over == 0.0:
        return h * GROW
    return h * min(max(SAFETY * over**-0.2, SHRINK), GROW)
