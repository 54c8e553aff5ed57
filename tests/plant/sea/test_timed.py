"""The deck at the ticks: a motion that MuJoCo's own step reproduces, the arm's base off the reference point, a calm sea."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.plant.sea.timed import deck_motion, timed_deck


def test_deck_moves_as_steps_of_mujoco_would_move_it(landing):
    """v ← v + a h, q ← q + v h from the first tick on stays on the deck's motion, to a tenth of a micrometre over the run."""
    q, v, a = np.split(timed_deck(landing(sea={"state": "ss3"})), 3, axis=1)
    np.testing.assert_allclose(v[:-1] + a[:-1] * 1e-3, v[1:], atol=1e-9)
    np.testing.assert_allclose(q[:-1] + v[1:] * 1e-3, q[1:], atol=1e-12)


def test_speed_and_acceleration_are_those_of_the_motion(landing):
    scenario = landing(sea={"state": "ss3"})
    q, v, a = np.split(timed_deck(scenario), 3, axis=1)
    motion, times = deck_motion(scenario), np.arange(len(q)) / 1000.0
    order = [0, 1, 2, 5, 4, 3]
    np.testing.assert_allclose(q[::100], motion.at(times[::100])[:, order], atol=1e-11)
    np.testing.assert_allclose(v[::100], motion.at(times[::100] - 5e-4, 1)[:, order], atol=1e-6)
    np.testing.assert_allclose(a[::100], motion.at(times[::100], 2)[:, order], atol=1e-5)


def test_base_beside_the_reference_point_moves_with_the_hull(landing):
    """On a mast of 2 m roll and pitch shift the base: p + R l − l."""
    sea, lever = {"state": "ss2", "towards_deg": 120.0}, np.array([0.5, -0.2, 2.0])
    one, other = (timed_deck(landing(sea=s))[::500] for s in (sea, {**sea, "base_m": lever.tolist()}))
    for q, p in zip(one[:, :6], other[:, :6], strict=True):
        R = Rotation.from_euler("ZYX", q[3:])
        np.testing.assert_allclose(p[:3], q[:3] + R.apply(lever) - lever, atol=1e-12)
        np.testing.assert_array_equal(p[3:], q[3:])


def test_calm_sea_is_none_and_each_kind_of_sea_is_one(landing, tmp_path):
    assert timed_deck(landing()).shape == (0, 18)
    file = tmp_path / "deck.csv"
    file.write_text("time_s,pitch_rad\n" + "".join(f"{0.1 * i},{0.05 * np.sin(0.1 * i)}\n" for i in range(601)))
    s = landing(sea={"trace": str(file)})
    assert timed_deck(s)[1571, 4] == pytest.approx(0.05, abs=1e-3)
    assert len(timed_deck(landing(sea={"state": "tank"}))) == s.run.duration_s * s.run.rate_hz
