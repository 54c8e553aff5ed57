"""From a sea to the deck's motion: one wave for each of many bands of the spectrum, through the hull's response.

A band's wave has the whole band's energy, so that each realisation has the height of the spectrum; its frequency and its phase are
drawn, so that the sea does not come round again within hours; short-crested, it has one direction of the spreading
D = (2/π) cos²θ, |θ| < 90 degrees, since waves of one frequency from two sides would stand still in places (Jefferys 1987).
"""

from typing import NamedTuple

import numpy as np

from armland.plant.noise import stream
from armland.plant.sea.hull import GRAVITY, contour
from armland.plant.sea.motion import Motion
from armland.plant.sea.spectra import bretschneider, jonswap
from armland.plant.sea.tables import Response, read_response, read_spectrum
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.environment import Sea

BANDS = 400

INSIDE = 50
"""Points of a band at which its energy is summed up."""

LOWEST = 0.5
"""Of the modal frequency: below, Bretschneider's spectrum has 2e-9 of its energy."""

SHORTEST = 4.0 * np.pi
"""½ k L of the shortest wave that a hull of length L is moved by: 1 % of its slope is left."""

BEAM = 0.4
"""Beam over length. Assumption."""


def band_edges(sea: Sea, own: tuple[Array, Array] | None, response: Response | None) -> Array:
    """Frequencies (BANDS + 1,), rad/s, between which each wave has its place: equal ratios.

    Args:
        sea: which.
        own: frequencies (k,), rad/s, and densities (k,), m²·s/rad, of a spectrum of its own.
        response: of a hull of its own.
    """
    if own is not None:
        low, high = own[0][0], own[0][-1]
    else:
        middle = 2.0 * np.pi / sea.height_period[1]
        low, high = LOWEST * middle, max(3.0 * middle, np.sqrt(2.0 * SHORTEST * GRAVITY / sea.hull_m))
    if response is not None:
        low, high = max(low, response.omega[0]), min(high, response.omega[-1])
    return np.geomspace(low, high, BANDS + 1)


def density(sea: Sea, omega: Array, own: tuple[Array, Array] | None) -> Array:
    """S (k,), m²·s/rad, of the sea at `omega` (k,), rad/s; `own` as for `band_edges`."""
    if own is not None:
        return np.interp(omega, *own, left=0.0, right=0.0)
    height, period = sea.height_period
    if sea.spectrum == "jonswap":
        return jonswap(omega, height, period, sea.peak)
    return bretschneider(omega, height, period)


class Waves(NamedTuple):
    """The waves of a sea, one for each band, and the response of a hull to them."""

    omega: Array  # (BANDS,) rad/s
    encounter: Array  # (BANDS,) rad/s, as the hull meets them
    towards: Array  # (BANDS,) rad, from the bow counter-clockwise
    amplitude: Array  # (BANDS,) m, complex: elevation at the reference point at t = 0
    response: Array  # (BANDS, 6) m/m, rad/m, complex

    def elevation(self, t: float, x: Array, y: Array) -> Array:
        """Elevation (len(x), len(y)), m, of the water at the time `t`, s, over a grid that goes along with the hull.

        Args:
            t: since the start of the run, s.
            x: places ahead of the reference point (k,), m.
            y: places to port of it (n,), m.
        """
        number = self.omega**2 / GRAVITY
        ahead = np.exp(-1j * np.outer(number * np.cos(self.towards), x))
        aside = np.exp(-1j * np.outer(number * np.sin(self.towards), y))
        now = self.amplitude * np.exp(1j * self.encounter * t)
        return np.real((ahead * now[:, None]).T @ aside)


def wave_motion(scenario: Scenario) -> Motion:
    """The motion of the deck that the waves of the scenario's sea and its seed make; errors as for `drawn_waves`."""
    waves = drawn_waves(scenario)
    return Motion(waves.encounter, waves.amplitude[:, None] * waves.response, np.zeros(6), np.zeros(6))


def drawn_waves(scenario: Scenario) -> Waves:
    """The waves of the scenario's sea that its seed draws.

    Raises:
        ConfigurationError: a table that cannot be used, or a response that leaves out waves of the sea.
    """
    sea, random = scenario.sea, stream(scenario.run.seed, "sea")
    own = None if sea.spectrum_file is None else read_spectrum(sea.spectrum_file)
    response = None if sea.response_file is None else read_response(sea.response_file)
    edges = band_edges(sea, own, response)
    if response is not None:
        response.check_covers(lambda omega: density(sea, omega, own))
    inside = edges[:-1, None] + np.diff(edges)[:, None] * (np.arange(INSIDE) + 0.5) / INSIDE
    energy = density(sea, inside.ravel(), own).reshape(inside.shape).mean(axis=1) * np.diff(edges)
    omega = edges[:-1] + np.diff(edges) * random.uniform(size=BANDS)
    phase, spread = random.uniform(-np.pi, np.pi, BANDS), spreading(random)
    drawn = random.uniform(-np.pi, np.pi)
    main = drawn if sea.towards_deg is None else np.deg2rad(sea.towards_deg)
    towards = main + (spread if sea.crests == "short" else 0.0 * spread)
    if response is not None:
        H = response.at(omega, towards)
    else:
        H = contour(omega, towards, sea.hull_m, BEAM * sea.hull_m if sea.beam_m is None else sea.beam_m)
    amplitude = np.sqrt(2.0 * energy) * np.exp(1j * phase)
    encounter = omega - omega**2 / GRAVITY * sea.speed_mps * np.cos(towards)
    return Waves(omega, encounter, towards, amplitude, H)


def spreading(random: np.random.Generator) -> Array:
    """Angles (BANDS,), rad, of D = (2/π) cos²θ: one of each of as many equal shares, in any order."""
    theta = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2001)
    share = 0.5 + (theta + 0.5 * np.sin(2.0 * theta)) / np.pi
    return np.interp((random.permutation(BANDS) + random.uniform(size=BANDS)) / BANDS, share, theta)
