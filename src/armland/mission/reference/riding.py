"""How a UAV that keeps its station above a deck goes along with the deck: with its slow motion and not with its fast one; compiled.

| symbol | name | unit, frame |
|---|---|---|
| r_s, v_s | station, and its velocity as one with the deck | m, D; m/s, W |
| δ, v̄, ā | `ride.apart`, `.v`, `.a` (3,): of what is followed, from the station; its velocity and acceleration | m, m/s, m/s², W |
| d, ḋ, d̈ | `ride.aside`, `.aside_v`, `.aside_a` (3,): δ as seen from the deck | m, m/s, m/s², D |
| λ | `told.rides` | rad/s |

No UAV follows what is faster than its attitude: with the deck's own acceleration fed forward it leans by 10 degrees, late, where
the deck rolls by one in half a second. What is followed is the station behind a low pass without an error of place at a constant speed,

    ā˙ = −λ³ δ + 3λ² (v_s − v̄) − 3λ ā,  δ˙ = v̄ − v_s,   p̄/p_s = (3λ² s + λ³)/(s + λ)³            (K.2)

so a constant error of the velocity does no harm, and no place of the deck need be known. Seen from the deck, with γ of (X.5) at
r_s + d and R W<-D: d = Rᵀδ, ḋ = Rᵀ(v̄ − v_s) − ω_b × d, d̈ = Rᵀā − g + γ(r_s + d, ḋ). In K.1 the deck's acceleration then cancels.
"""

import numpy as np
from numba import njit

from armland.models.environment import apparent_gravity
from armland.records import Record
from armland.rotations import Array, cross, matrix, turned, turned_back


def kept_layout() -> np.dtype:
    """What going along is remembered by; zeros on land."""
    names = ("apart", "v", "a", "aside", "aside_v", "aside_a")
    return np.dtype([("begun", "i8"), *((name, "f8", (3,)) for name in names)])


@njit(cache=True)
def ride(station: Array, rate: float, tick_s: float, environment: Record, s: Record) -> None:
    """One tick of (K.2).

    Args:
        station: r_s (3,), m, D.
        rate: λ, rad/s.
        tick_s: s.
        environment: of `models.environment.environment_layout`, of a deck that moves.
        s: of `kept_layout`, updated.
    """
    R, carried = matrix(environment.base_quat), cross(environment.base_omega, station)
    for i in range(3):
        carried[i] += environment.base_v[i]
    along = turned(R, carried)
    if not s.begun:
        pushed, s.begun = turned(R, environment.base_a), 1
        for i in range(3):
            s.v[i], s.a[i] = along[i], pushed[i]
    apart_v = np.empty(3)
    for i in range(3):
        jerk = rate**2 * (3.0 * (along[i] - s.v[i]) - rate * s.apart[i]) - 3.0 * rate * s.a[i]  # (K.2)
        s.a[i] += jerk * tick_s
        s.v[i] += s.a[i] * tick_s
        apart_v[i] = s.v[i] - along[i]
        s.apart[i] += apart_v[i] * tick_s
    aside, aside_v, aside_a = turned_back(R, s.apart), turned_back(R, apart_v), turned_back(R, s.a)
    turns = cross(environment.base_omega, aside)
    for i in range(3):
        aside_v[i] -= turns[i]
    gravity = apparent_gravity(environment, station + aside, aside_v)
    for i in range(3):
        s.aside[i], s.aside_v[i] = aside[i], aside_v[i]
        s.aside_a[i] = aside_a[i] - environment.gravity[i] + gravity[i]
