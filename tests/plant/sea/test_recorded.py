"""A recorded deck: what was recorded, nothing added, and what no deck does refused with row, value and bound."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.plant.sea.recorded import recorded_motion

TIMES = np.arange(0.0, 60.0, 0.1)


def written(tmp_path, times=TIMES, **columns):
    file = tmp_path / "deck.csv"
    rows = np.column_stack([times, *columns.values()])
    file.write_text("\n".join([",".join(["time_s", *columns]), *(",".join(f"{x:.9g}" for x in row) for row in rows)]))
    return file


def swell(t):
    return 0.3 * np.sin(0.9 * t + 1.0) + 0.05 * np.sin(3.1 * t)


def test_deck_does_what_was_recorded(tmp_path):
    """Between its samples too, with the speed and acceleration of the smooth motion that was sampled."""
    motion = recorded_motion(
        written(tmp_path, heave_m=swell(TIMES) + 4.0, roll_deg=np.rad2deg(0.1 + 0.2 * swell(TIMES))), 45.0
    )
    t = np.arange(2.0, 45.0, 0.033)
    mean = swell(TIMES[TIMES <= 55.0]).mean()
    np.testing.assert_allclose(motion.at(t)[:, 2], swell(t) - mean, atol=2e-3)
    np.testing.assert_allclose(motion.at(t)[:, 3], 0.1 + 0.2 * swell(t), atol=4e-4)
    speed = 0.27 * np.cos(0.9 * t + 1.0) + 0.155 * np.cos(3.1 * t)
    np.testing.assert_allclose(motion.at(t, 1)[:, 2], speed, atol=6e-3)
    acceleration = -0.243 * np.sin(0.9 * t + 1.0) - 0.4805 * np.sin(3.1 * t)
    np.testing.assert_allclose(motion.at(t, 2)[:, 2], acceleration, atol=0.03)
    assert not motion.at(t)[:, [0, 1, 4, 5]].any()


def test_acceleration_is_integrated_without_drift(tmp_path):
    t = np.arange(10.0, 45.0, 0.1)
    recorded = -(0.9**2) * 0.3 * np.sin(0.9 * TIMES + 1.0) + 0.02
    motion = recorded_motion(written(tmp_path, heave_mps2=recorded), 45.0)
    # A constant error of the sensor would be 20 m after 45 s.
    apart = motion.at(t)[:, 2] - 0.3 * np.sin(0.9 * t + 1.0)
    assert np.abs(apart).max() < 0.1
    np.testing.assert_allclose(motion.at(t, 2)[:, 2], recorded[100:450] - 0.02, atol=0.03)


@pytest.mark.parametrize("seed", range(4))
def test_resampling_adds_no_energy(tmp_path, seed):
    """White noise of 10 Hz: what is made of it has no more variance, and none above the samples' half rate or 3 Hz."""
    random = np.random.default_rng(seed)
    times = np.cumsum(random.uniform(0.05, 0.15, 700))
    noise = 0.02 * random.standard_normal(700)
    motion = recorded_motion(written(tmp_path, times=times, sway_m=noise), 45.0)
    q = motion.sampled(1000.0, 0, 45000)[:, 1]
    assert q.std() < noise.std()
    power = np.abs(np.fft.rfft(q * np.hanning(len(q)))) ** 2
    assert power[np.fft.rfftfreq(len(q), 1e-3) > 3.2].sum() < 1e-6 * power.sum()


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (
            {"heave_m": 30.0 * swell(TIMES) / 0.3},
            r"row \d+: heave_m = \S+, \S+ from its mean; at most 10 is a deck's: .* other units",
        ),
        ({"roll_rad": 30.0 * swell(TIMES)}, r"roll_rad = .* at most 1.05"),
        ({"heave_mps2": 9.81 * 30.0 * swell(TIMES)}, r"heave_mps2 = .* at most 20"),
        ({"height": swell(TIMES)}, "has no motion; a recorded deck has one or more of heave_m or heave_mps2"),
        ({"heave_m": swell(TIMES), "heave_mps2": swell(TIMES)}, "heave_m, heave_mps2; .* each motion once"),
        ({"heave_m": 5.0 * np.sin(3.0 * TIMES)}, r"heave at up to 15\S* m/s; at most 6 m/s is a deck's"),
        ({"heave_m": np.where(TIMES == 7.0, np.inf, 0.0)}, "row 71: heave_m = inf is not a finite number"),
    ],
)
def test_what_no_deck_does_is_refused(tmp_path, columns, message):
    with pytest.raises(ConfigurationError, match=f"^deck.csv: .*{message}"):
        recorded_motion(written(tmp_path, **columns), 45.0)


@pytest.mark.parametrize(
    ("times", "message"),
    [
        (
            np.where(TIMES > 20.0, TIMES + 3.0, TIMES),
            r"row \d+: a gap of 3.1 s; the median step is 0.1 s, and 5 times that is allowed",
        ),
        (0.5 * TIMES, "lasts 29.95 s, and run.duration_s = 45; a longer record, or a shorter run"),
        (TIMES[::-1], "times must rise"),
        (10.0 * TIMES, "a sample every 1 s; a deck needs one every 0.5 s"),
    ],
)
def test_times_of_no_recording_are_refused(tmp_path, times, message):
    with pytest.raises(ConfigurationError, match=f"^deck.csv: .*{message}"):
        recorded_motion(written(tmp_path, times=times, heave_m=swell(TIMES)), 45.0)
