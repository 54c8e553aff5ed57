"""The platform in a tank has the published statistics."""

import numpy as np
import pytest

from armland.plant.sea.tank import tank_motion


def test_tank_moves_as_was_published(landing):
    """1.4 degrees significant, zero-crossings of 0.8 s, a peak at 2.2 s; x and y of 4 to 7 mm."""
    q = np.concatenate([tank_motion(landing().with_seed(seed)).sampled(50.0, 0, 15000) for seed in range(6)])
    assert np.rad2deg(2.0 * q[:, 3:5].std(axis=0)) == pytest.approx([1.4, 1.4], rel=0.05)
    assert ((q[:, :2].std(axis=0) > 0.004) & (q[:, :2].std(axis=0) < 0.007)).all()
    roll = q[:, 3]
    crossings = ((roll[1:] > 0.0) & (roll[:-1] <= 0.0)).sum()
    assert len(q) / 50.0 / crossings == pytest.approx(0.8, rel=0.05)
    power = np.abs(np.fft.rfft(roll[:15000])) ** 2
    f = np.fft.rfftfreq(15000, 0.02)
    assert power[(f > 0.35) & (f < 0.56)].sum() == pytest.approx(0.5 * power.sum(), rel=0.15)
