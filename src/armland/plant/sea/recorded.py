"""A recorded motion of the deck as a sum of sines: smooth, and without energy that is not in the record.

A CSV file with time_s and, of each motion that there is, one column: heave_m or heave_mps2, likewise surge and sway; roll_rad or
roll_deg, likewise pitch and yaw. The mean of all but roll and pitch is taken off. Less the straight line between its ends, the
record is a sum of sines that are zero at both (DST-I): its variance is that of the samples, and nothing is faster than the
samples are. What is faster than `FASTEST_HZ` is left out, since a second derivative makes noise of it; of an acceleration also
what is slower than `SLOWEST_S`, which integrated twice would be drift.
"""

from pathlib import Path

import numpy as np
from scipy.fft import dst
from scipy.signal import detrend

from armland.errors import ConfigurationError
from armland.plant.sea.hull import MOTIONS
from armland.plant.sea.motion import Motion
from armland.rotations import Array
from armland.scenario.files.columns import check_times, read_columns, read_header

FASTEST_HZ, SLOWEST_S = 3.0, 25.0

SLOWEST_SAMPLE_S = 0.5
"""Samples farther apart say too little of a small hull's motion."""

MARGIN_S = 10.0
"""How much of a record beyond the run is used."""

UNITS = {"m": 1.0, "mps2": 1.0, "rad": 1.0, "deg": np.pi / 180.0}

MOST = {"m": 10.0, "mps2": 20.0, "rad": 1.05, "deg": 60.0}
"""Largest value about its mean that a deck has."""

SWIFTEST = np.array([6.0, 6.0, 6.0, 2.0, 2.0, 2.0])
"""Largest speed of a deck, m/s, rad/s."""


def recorded_motion(path: Path, needed_s: float) -> Motion:
    """The recorded motion of `path`, for `needed_s` or longer.

    Raises:
        ConfigurationError: not readable or finite, gaps, too short, too coarse, or in other units; with row, value and bound.
    """
    what = "a recorded deck"
    header = read_header(path, what)
    there = [(i, f"{m}_{u}") for i, m in enumerate(MOTIONS) for u in _units(i) if f"{m}_{u}" in header]
    if not there or len({i for i, _ in there}) < len(there):
        raise ConfigurationError(
            f"{path.name}: has {', '.join(n for _, n in there) or 'no motion'}; {what} has one or more of heave_m or heave_mps2, "
            "roll_rad or roll_deg, and so on, each motion once"
        )
    rows = read_columns(path, ("time_s", *(name for _, name in there)), what)
    check_times(path.name, rows[:, 0], needed_s)
    times = rows[:, 0] - rows[0, 0]
    step, lasts = float(np.median(np.diff(times))), min(float(times[-1]), needed_s + MARGIN_S)
    if step > SLOWEST_SAMPLE_S:
        raise ConfigurationError(
            f"{path.name}: a sample every {step:g} s; a deck needs one every {SLOWEST_SAMPLE_S:g} s"
        )
    even = np.linspace(0.0, lasts, round(lasts / step) + 1)
    k = np.arange(1, len(even) - 1)
    omega = np.pi * k / lasts
    origin, drift, amplitude = np.zeros(6), np.zeros(6), np.zeros((len(k), 6), complex)
    for (i, name), values in zip(there, rows[:, 1:].T, strict=True):
        unit = name.rpartition("_")[2]
        _check_size(path.name, name, values, unit)
        samples = np.interp(even, times, UNITS[unit] * values)
        if unit == "mps2":
            amplitude[:, i] = np.where(omega > 2.0 * np.pi / SLOWEST_S, -_sines(detrend(samples)) / omega**2, 0.0)
            continue
        samples = samples if MOTIONS[i] in ("roll", "pitch") else samples - samples.mean()
        origin[i], drift[i] = samples[0], (samples[-1] - samples[0]) / lasts
        amplitude[:, i] = _sines(samples - origin[i] - drift[i] * even)
    # A smooth end of the band, where a sharp one would ring.
    kept = np.clip((FASTEST_HZ - omega / (2.0 * np.pi)) / (0.2 * FASTEST_HZ), 0.0, 1.0)
    motion = Motion(omega[kept > 0.0], -1j * (kept[:, None] * amplitude)[kept > 0.0], origin, drift)
    _check_speed(path.name, motion, needed_s)
    return motion


def _units(i: int) -> tuple[str, str]:
    return ("m", "mps2") if i < 3 else ("rad", "deg")


def _sines(samples: Array) -> Array:
    # s_k of Σ s_k sin(π k j/N) at the samples j = 1 to N − 1.
    return dst(samples[1:-1], type=1) / (len(samples) - 1)


def _check_size(file: str, name: str, values: Array, unit: str) -> None:
    apart = np.abs(values - values.mean())
    if apart.max() > MOST[unit]:
        row = int(apart.argmax())
        raise ConfigurationError(
            f"{file}: row {row + 1}: {name} = {values[row]:g}, {apart[row]:g} from its mean; at most {MOST[unit]:g} is a deck's: "
            "is it in other units?"
        )


def _check_speed(file: str, motion: Motion, needed_s: float) -> None:
    most = np.abs(motion.at(np.arange(0.0, needed_s, 0.02), 1)).max(axis=0)
    if (most > SWIFTEST).any():
        i = int((most / SWIFTEST).argmax())
        unit = "m/s" if i < 3 else "rad/s"
        raise ConfigurationError(
            f"{file}: {MOTIONS[i]} at up to {most[i]:.3g} {unit}; at most {SWIFTEST[i]:g} {unit} is a deck's: "
            "are time and motion in s, m, rad?"
        )
