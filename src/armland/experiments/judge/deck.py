"""A flight as the deck sees it: what is judged at sea is motion against the deck, as a touchdown, a catch, a rest are."""

from collections.abc import Mapping
from typing import overload

import numpy as np
from scipy.spatial.transform import Rotation

from armland.experiments.judge.brief import Ticks
from armland.records import Records

PLACES = {"r": "v", "r_cm": "v_cm", "ee": "ee_v"}
"""Positions in W and their velocities."""

FORCES = ("hinge_force", "cradle_force")


@overload
def seen_from_deck(ticks: Mapping[str, Records]) -> Mapping[str, Records]: ...


@overload
def seen_from_deck(ticks: Ticks) -> Ticks: ...


def seen_from_deck(ticks: Ticks) -> Ticks:
    """The ticks with their truth in D, and velocities against the deck; on land as they are."""
    truth: Records = ticks["truth"]
    if "deck_quat" not in (truth.dtype.names or ()) or not _moves(truth):
        return ticks
    own, R = truth.copy(), Rotation.from_quat(truth["deck_quat"], scalar_first=True)
    back = R.inv()
    for place, speed in PLACES.items():
        apart = truth[place] - truth["deck"]
        own[place] = back.apply(apart)
        own[speed] = back.apply(truth[speed] - truth["deck_v"] - np.cross(truth["deck_omega"], apart))
    for name in ("quat", "plate_quat", "ee_quat"):
        own[name] = (back * Rotation.from_quat(truth[name], scalar_first=True)).as_quat(scalar_first=True)
    own["omega"] -= Rotation.from_quat(truth["quat"], scalar_first=True).inv().apply(truth["deck_omega"])
    for name in FORCES:
        own[name] = back.apply(truth[name])
    names = ticks.dtype.names if isinstance(ticks, np.ndarray) else tuple(ticks)
    return {**{name: ticks[name] for name in names or ()}, "truth": own}


def deck_speed(truth: np.ndarray) -> float:
    """Largest speed of the deck, m/s, over the ticks of `truth`; 0 on land, and in logs that know no deck."""
    if "deck_v" not in (truth.dtype.names or ()):
        return 0.0
    return float(np.linalg.norm(truth["deck_v"], axis=1).max())


def _moves(truth: Records) -> bool:
    return bool(truth["deck"].any() or truth["deck_quat"][:, 1:].any())
