"""A hull's response and a spectrum of the sea as tables: read, and refused where they cannot be what they say.

A response (RAO) stands in a CSV file with the columns omega_radps, towards_deg and, of each motion that there is, MOTION_re and
MOTION_im, m/m or rad/m, with the conventions of `sea.hull`. Rows are a full grid. A table with directions of 0 to 180 degrees
alone is of a hull that is alike to both sides. Between rows real and imaginary part are linear, never amplitude and phase.
"""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from armland.errors import ConfigurationError
from armland.plant.sea.hull import GRAVITY, MOTIONS
from armland.rotations import Array
from armland.scenario.files.columns import read_columns, read_header

MOST_RATIO = 20.0
"""Most of a motion over the wave's height, or of an angle over its slope k: lightly damped rolling has up to ten times."""

APART_DEG = 46.0
"""Directions farther apart cannot be interpolated."""

EARLY = 0.8
"""Share of an impulse response before its wave from which it is none: what follows the contour has half."""

COVERED = 0.98
"""Share of the waves' energy for which a response must be known."""

ODD = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
"""Motions under waves from the other side over those from this one."""


class Response(NamedTuple):
    """A table of H."""

    name: str
    omega: Array  # (k,) rad/s
    towards: Array  # (m,) rad, −π and π included
    values: Array  # (k, m, 6), complex

    def at(self, omega: Array, towards: Array) -> Array:
        """H (n, 6), complex, m/m and rad/m, at `omega` (n,), rad/s, and `towards` (n,), rad."""
        around = np.mod(towards + np.pi, 2.0 * np.pi) - np.pi
        return RegularGridInterpolator((self.omega, self.towards), self.values)(np.stack([omega, around], axis=1))

    def check_covers(self, density: Callable[[Array], Array]) -> None:
        """Refuse a table that says nothing of the waves that there are.

        Args:
            density: S (k,), m²·s/rad, of frequencies (k,), rad/s.

        Raises:
            ConfigurationError: the share of the waves' energy, the bound, the table's range.
        """
        omega = np.geomspace(0.05, 50.0, 4000)
        energy = density(omega) * np.gradient(omega)
        low, high = self.omega[0], self.omega[-1]
        share = energy[(omega >= low) & (omega <= high)].sum() / energy.sum()
        if share < COVERED:
            raise ConfigurationError(
                f"{self.name}: from {low:g} to {high:g} rad/s are {share:.0%} of the waves' energy; {COVERED:.0%} are needed: "
                "more rows, or another sea"
            )


def read_response(file: str) -> Response:
    """The response in `file`.

    Raises:
        ConfigurationError: not readable, finite, whole or causal, or in other units; with row, value and bound.
    """
    path, what = Path(file), "a hull's response"
    header = read_header(path, what)
    there = [m for m in MOTIONS if {f"{m}_re", f"{m}_im"} <= set(header)]
    if not there:
        raise ConfigurationError(f"{path.name}: no motion; {what} has columns such as heave_re and heave_im")
    names = [f"{m}_{part}" for m in there for part in ("re", "im")]
    rows = read_columns(path, ("omega_radps", "towards_deg", *names), what)
    omega, towards = np.unique(rows[:, 0]), np.unique(rows[:, 1])
    if omega[0] <= 0.0 or len(omega) < 2 or len(rows) != len(omega) * len(towards):
        raise ConfigurationError(
            f"{path.name}: {len(rows)} rows of {len(omega)} frequencies and {len(towards)} directions; a full grid of both, "
            "two or more frequencies and all above 0, is needed"
        )
    order = np.lexsort((rows[:, 1], rows[:, 0]))
    values = np.zeros((len(omega), len(towards), len(MOTIONS)), complex)
    for i, motion in enumerate(there):
        column = rows[order, 2 + 2 * i] + 1j * rows[order, 3 + 2 * i]
        values[:, :, MOTIONS.index(motion)] = column.reshape(values.shape[:2])
    around, values = _all_round(path.name, towards, values)
    _check_units(path.name, omega, around, values)
    _check_causal(path.name, omega, around, values)
    return Response(path.name, omega, np.deg2rad(around), values)


def _all_round(name: str, towards: Array, values: Array) -> tuple[Array, Array]:
    # Directions from −180 to 180 degrees, both included.
    if towards[0] >= 0.0 and towards[-1] <= 180.0:
        towards = np.concatenate([towards, -towards])
        values = np.concatenate([values, values * ODD], axis=1)
    around, at = np.unique(np.mod(towards + 180.0, 360.0) - 180.0, return_index=True)
    around, values = np.append(around, around[0] + 360.0), values[:, [*at, at[0]]]
    if np.diff(around).max() > APART_DEG:
        i = int(np.diff(around).argmax())
        raise ConfigurationError(
            f"{name}: no direction between {around[i]:g} and {around[i + 1]:g} degrees; at most {APART_DEG:g} may lie between two"
        )
    if around[0] > -180.0:
        share = (180.0 - around[-2]) / (around[-1] - around[-2])
        end = (1.0 - share) * values[:, -2] + share * values[:, -1]
        around = np.concatenate([[-180.0], around[:-1], [180.0]])
        values = np.concatenate([end[:, None], values[:, :-1], end[:, None]], axis=1)
    return around, values


def _check_units(name: str, omega: Array, around: Array, values: Array) -> None:
    most = MOST_RATIO * np.where(np.arange(6) < 3, 1.0, omega[:, None, None] ** 2 / GRAVITY)
    if (np.abs(values) > most).any():
        i, j, m = np.unravel_index(int((np.abs(values) / most).argmax()), values.shape)
        bound, unit = float(np.broadcast_to(most, values.shape)[i, j, m]), "m/m" if m < 3 else "rad/m"
        raise ConfigurationError(
            f"{name}: {MOTIONS[m]} of {abs(values[i, j, m]):g} {unit} at {omega[i]:g} rad/s, {around[j]:g} degrees; "
            f"at most {bound:.3g}, {MOST_RATIO:g} times the wave, is a hull's: is it in other units, such as deg/m?"
        )


def _check_causal(name: str, omega: Array, around: Array, values: Array) -> None:
    # A motion that comes before its wave: by inverse Fourier transform of the table, nothing beyond its ends.
    even = np.linspace(0.0, omega[-1], 512)
    for j, angle in enumerate(around):
        for m in range(6):
            H = np.interp(even, omega, values[:, j, m], left=0.0)
            if np.abs(H).max() < 1e-3 * np.abs(values[:, :, m]).max() or not H.any():
                continue
            impulse = np.fft.irfft(H, 2048) ** 2
            late, early = impulse[1:1024].sum(), impulse[1025:].sum()
            if (share := early / (early + late)) > EARLY:
                raise ConfigurationError(
                    f"{name}: {share:.0%} of {MOTIONS[m]}'s response at {angle:g} degrees comes before its wave; at most {EARLY:.0%}: "
                    "with phases of e^(−iωt) the imaginary parts have the other sign"
                )


def read_spectrum(file: str) -> tuple[Array, Array]:
    """Frequencies (k,), rad/s, and densities (k,), m²·s/rad, of the spectrum in `file`.

    Raises:
        ConfigurationError: not readable or finite, frequencies that do not rise, densities below 0, waves of no sea; with the bound.
    """
    path = Path(file)
    omega, density = read_columns(path, ("omega_radps", "density_m2s"), "a wave spectrum").T
    if omega[0] <= 0.0 or (np.diff(omega) <= 0.0).any() or (density < 0.0).any():
        raise ConfigurationError(
            f"{path.name}: frequencies must lie above 0 and rise, and densities must not be negative"
        )
    height = 4.0 * np.sqrt(np.trapezoid(density, omega))
    if not 0.01 <= height <= 15.0:
        raise ConfigurationError(
            f"{path.name}: a significant wave height of {height:.3g} m; from 0.01 to 15 m is a sea's: is it over Hz, or in other units?"
        )
    return omega, density
