"""The rotors of a UAV: where each is, which way it pushes, how it turns, and what thrust and torque it makes of its own.

| symbol | name | unit, frame |
|---|---|---|
| p_i | `place` (n, 3), from the centre of mass | m, B |
| a_i | `axis` (n, 3): the way that it pushes | 1, B |
| s_i | `spin` (n,): 1 where it turns counter-clockwise, seen against a_i: from above | 1 |
| k | `drag_torque`: reaction torque per thrust | N·m/N |

    f = Σ a_i T_i,  τ = Σ p_i × a_i T_i − s_i k a_i T_i    (R.1)
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import ModelError
from armland.records import MOST_ROTORS
from armland.rotations import Array

LEAST_ROTORS = 4

ALIKE_RAD = 1e-3
"""Azimuths that count as one: two rotors on one beam."""

LEAST_SHARE = 1e-3
"""Of the largest singular value: what is below it cannot be made."""

NAMES = ("thrust", "roll torque", "pitch torque", "yaw torque")


class RotorSet(NamedTuple):
    """Places, axes and spins as above."""

    place: Array
    axis: Array
    spin: Array

    @property
    def number(self) -> int:
        """n, as far as the arrays go."""
        return len(self.place)

    @property
    def upright(self) -> bool:
        """Whether all push along body z."""
        return bool(np.all(self.axis[:, 2] == 1.0))


def alternating(place: Array) -> Array:
    """Spins (n,) that alternate with the azimuth of `place` (n, 3) m, from clockwise at the first from body x on; of
    two on one beam the
    lower one first."""
    order = by_azimuth(place)
    spin = np.empty(len(place))
    spin[order] = [-1.0 if i % 2 == 0 else 1.0 for i in range(len(place))]
    return spin


def by_azimuth(place: Array) -> NDArray[np.int64]:
    """Indices (n,) of rotors at `place` (n, 3), m, counter-clockwise from body x on."""
    angle = np.mod(np.arctan2(place[:, 1], place[:, 0]), 2.0 * np.pi)
    angle = np.mod(np.round(angle / ALIKE_RAD) * ALIKE_RAD, np.round(2.0 * np.pi / ALIKE_RAD) * ALIKE_RAD)
    return np.asarray(np.lexsort((place[:, 2], angle)), np.int64)


def beams(place: Array) -> list[tuple[Array, Array]]:
    """Ends (3,), m, of the beams that carry rotors at `place` (n, 3): from each to the opposite one, or to the middle where none is."""
    order, n = by_azimuth(place), len(place)
    if n % 2 == 0:
        return [(place[order[i]], place[order[i + n // 2]]) for i in range(n // 2)]
    middle = np.array([0.0, 0.0, float(place[:, 2].mean())])
    return [(place[i], middle) for i in order]


def effect_of(rotors: RotorSet, drag_torque: float) -> Array:
    """(6, n): thrust along body z, torque (3,) about the centre of mass, and lateral force (2,) of a rotor's thrust. Source: (R.1)."""
    force = rotors.axis.T
    torque = np.cross(rotors.place, rotors.axis).T - rotors.spin * drag_torque * force  # (R.1)
    return np.vstack([force[2], torque, force[:2]])


def check_rotors(rotors: RotorSet, drag_torque: float, file: str) -> None:
    """Refuse rotors that cannot make thrust and three torques each by itself.

    Raises:
        ModelError: too few, too many, or what they cannot make, and what would work.
    """
    n = rotors.number
    if not 1 <= n <= MOST_ROTORS:
        raise ModelError(f"UAV file {file!r} has {n} rotors; armland flies {LEAST_ROTORS} to {MOST_ROTORS}")
    wrench = effect_of(rotors, drag_torque)[:4]
    # As accelerations of a body of the rotors' size, so that newtons and newton metres compare.
    reach = max(float(np.abs(wrench[1:3]).max()), 1e-9)
    scaled = wrench / np.array([1.0, reach, reach, max(drag_torque, 1e-9)])[:, None]
    u, size, _ = np.linalg.svd(scaled)
    size = np.append(size, np.zeros(4 - len(size)))
    rank = int(np.sum(size > LEAST_SHARE * size[0]))
    if rank == 4:
        return
    lost = np.abs(u[:, rank:]).max(axis=1)
    names = " and ".join(name for name, share in zip(NAMES, lost, strict=True) if share > 0.5) or "their combination"
    raise ModelError(
        f"UAV file {file!r}: {n} rotors make {rank} of the four independently, thrust, roll, pitch and yaw torque; not by itself: "
        f"{names}. What works: {LEAST_ROTORS} to {MOST_ROTORS} rotors about the centre of mass, spins alternating; "
        "a tricopter whose tail rotor a servo tilts is not modelled"
    )
