"""A flight as the deck sees it: what stands on it is at rest, whatever it does."""

import numpy as np
from scipy.spatial.transform import Rotation

from armland.experiments.judge.deck import deck_speed, seen_from_deck
from armland.records import tick_layout


def riding(k=200):
    """Ticks of a UAV that stands on the deck at (0.5, 0.1, 0.3), level with it, while the deck moves."""
    ticks, t = np.zeros(k, tick_layout(7)), np.arange(k) / 100.0
    truth, h, point = ticks["truth"], 1e-5, np.array([0.5, 0.1, 0.3])

    def deck(t):
        p = np.stack([0.1 * np.sin(t), 0.0 * t, 0.4 * np.sin(0.9 * t)], axis=1)
        return p, Rotation.from_euler(
            "ZYX", np.stack([0.1 * np.sin(t), 0.1 * np.cos(t), 0.2 * np.sin(2.0 * t)], axis=1)
        )

    (p, R), (back, R_back), (fore, R_fore) = deck(t), deck(t - h), deck(t + h)
    truth["deck"], truth["deck_quat"] = p, R.as_quat(scalar_first=True)
    truth["deck_v"] = (fore - back) / (2.0 * h)
    truth["deck_omega"] = (R_fore * R_back.inv()).as_rotvec() / (2.0 * h)
    for place, speed in (("r", "v"), ("r_cm", "v_cm"), ("ee", "ee_v")):
        truth[place] = p + R.apply(point)
        truth[speed] = (fore + R_fore.apply(point) - back - R_back.apply(point)) / (2.0 * h)
    for name in ("quat", "plate_quat", "ee_quat"):
        truth[name] = R.as_quat(scalar_first=True)
    truth["omega"] = R.inv().apply(truth["deck_omega"])
    truth["cradle_force"] = R.apply([0.0, 0.0, 5.0])
    return ticks


def test_what_stands_on_the_deck_is_at_rest():
    ticks = riding()
    seen = seen_from_deck(ticks)["truth"]
    np.testing.assert_allclose(seen["r"], np.tile([0.5, 0.1, 0.3], (len(seen), 1)), atol=1e-12)
    for name in ("v", "v_cm", "ee_v", "omega"):
        np.testing.assert_allclose(seen[name], 0.0, atol=1e-9)
    np.testing.assert_allclose(np.abs(seen["quat"][:, 0]), 1.0)
    np.testing.assert_allclose(seen["cradle_force"], np.tile([0.0, 0.0, 5.0], (len(seen), 1)), atol=1e-12)
    # The log's own truth stays what it was.
    assert ticks["truth"]["v"].any()
    assert deck_speed(ticks["truth"]) > 0.3


def test_on_land_the_ticks_are_the_same_object():
    ticks = np.zeros(5, tick_layout(7))
    ticks["truth"]["deck_quat"][:, 0] = 1.0
    assert seen_from_deck(ticks) is ticks
    assert deck_speed(ticks["truth"]) == 0.0
