"""The platform in a tank and the small vessel have the published statistics."""

import numpy as np
import pytest

from armland.plant.sea.measured import measured_motion


def test_tank_moves_as_was_published(landing):
    """1.4 degrees significant, zero-crossings of 0.8 s, a peak at 2.2 s; x and y of 4 to 7 mm."""
    q = np.concatenate(
        [measured_motion(landing(sea={"state": "tank"}).with_seed(seed)).sampled(50.0, 0, 15000) for seed in range(6)]
    )
    assert np.rad2deg(2.0 * q[:, 3:5].std(axis=0)) == pytest.approx([1.4, 1.4], rel=0.05)
    assert ((q[:, :2].std(axis=0) > 0.004) & (q[:, :2].std(axis=0) < 0.007)).all()
    roll = q[:, 3]
    crossings = ((roll[1:] > 0.0) & (roll[:-1] <= 0.0)).sum()
    assert len(q) / 50.0 / crossings == pytest.approx(0.8, rel=0.05)
    power = np.abs(np.fft.rfft(roll[:15000])) ** 2
    f = np.fft.rfftfreq(15000, 0.02)
    assert power[(f > 0.35) & (f < 0.56)].sum() == pytest.approx(0.5 * power.sum(), rel=0.15)


def test_small_vessel_moves_as_was_published(landing):
    """Heave of 0.18 m significant, zero-crossings of 1.8 to 3.5 s, peaks at 1.6 to 2.5 s and 6 to 8 s; roll over 12 degrees."""
    runs = [measured_motion(landing(sea={"state": "usv"}).with_seed(seed)).sampled(20.0, 0, 6000) for seed in range(12)]
    q = np.concatenate(runs)
    assert 2.0 * q[:, 2].std() == pytest.approx(0.18, rel=0.05)
    heave = q[:, 2]
    crossings = ((heave[1:] > 0.0) & (heave[:-1] <= 0.0)).sum()
    assert 1.8 < len(q) / 20.0 / crossings < 3.5
    assert np.median([np.rad2deg(np.ptp(run[:, 3])) for run in runs]) == pytest.approx(12.0, abs=1.5)
    f, power = np.fft.rfftfreq(6000, 0.05), np.abs(np.fft.rfft(runs[0][:, 2])) ** 2
    for short, long in ((1.6, 2.5), (6.0, 8.5)):
        assert power[(f > 1.0 / long) & (f < 1.0 / short)].sum() > 0.4 * power.sum()
