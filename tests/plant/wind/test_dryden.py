"""Dryden turbulence: lengths and intensities in the units of their source, and steps that have the published spectra exactly."""

import numpy as np
import pytest
from scipy.integrate import quad, quad_vec

from armland.plant.wind.dryden import KNOT_MPS, W20_MPS, across_step, along_step, intensities, lengths

FOOT = 0.3048


@pytest.mark.parametrize(
    ("feet", "level", "sigma"),
    [(10, 23.1, 0.196), (20, 43.8, 0.193), (50, 94.7, 0.184), (100, 154.0, 0.172)],
)
def test_lengths_and_intensities_are_those_of_the_source_in_feet(feet, level, sigma):
    """L_u = L_v, σ_u = σ_v over W20 by hand from MIL-F-8785C; L_w = h, σ_w = 0.1 W20."""
    np.testing.assert_allclose(lengths(feet * FOOT), [level, level, feet * FOOT], rtol=3e-3)
    np.testing.assert_allclose(intensities(7.0, feet * FOOT), [7.0 * sigma, 7.0 * sigma, 0.7], rtol=3e-3)


@pytest.mark.parametrize(("height", "counts_as"), [(0.5, 3.048), (-1.0, 3.048), (3.0, 3.048), (400.0, 304.8)])
def test_heights_beyond_those_of_the_source_count_as_its_ends(height, counts_as):
    np.testing.assert_array_equal(lengths(height), lengths(counts_as))
    np.testing.assert_array_equal(intensities(8.0, height), intensities(8.0, counts_as))
    assert lengths(0.999 * 304.8)[2] < 304.8


def test_named_turbulence_is_that_of_15_30_and_45_knots():
    assert [round(w / (1852.0 / 3600.0)) for w in W20_MPS.values()] == [15, 30, 45]
    assert pytest.approx(1852.0 / 3600.0, rel=1e-6) == KNOT_MPS


def spectrum_8785(name, L, wave):
    """One-sided spectrum over σ² of component `name` at `wave` rad/m, as MIL-F-8785C writes it."""
    if name == "u":
        return 2.0 * L / np.pi / (1.0 + (L * wave) ** 2)
    return L / np.pi * (1.0 + 3.0 * (L * wave) ** 2) / (1.0 + (L * wave) ** 2) ** 2


def spectrum_1797(name, L, wave):
    """The same as MIL-HDBK-1797 writes it, with the lengths of its table: 2 L_w = h, L_u = 2 L_v."""
    if name == "u":
        return spectrum_8785("u", L, wave)
    half = 0.5 * L
    return 2.0 * half / np.pi * (1.0 + 12.0 * (half * wave) ** 2) / (1.0 + 4.0 * (half * wave) ** 2) ** 2


def covariance(name, x, ticks):
    """Of two values that lie `ticks` ticks of V Δt/L = `x` apart, over σ²."""
    if name == "u":
        return along_step(x)[0] ** ticks
    y = np.array([1.0, np.sqrt(3.0)])
    return y @ np.linalg.matrix_power(across_step(x)[0], ticks) @ y / 4.0


@pytest.mark.parametrize("name", ["u", "v", "w"])
@pytest.mark.parametrize("spectrum", [spectrum_8785, spectrum_1797])
@pytest.mark.parametrize(("speed", "tick_s"), [(5.0, 0.001), (5.0, 0.005), (1.0, 0.002)])
def test_steps_have_the_published_spectra(name, spectrum, speed, tick_s):
    """R(τ) = ∫₀^∞ Φ(Ω) cos ΩVτ dΩ, from 0.1 to 3 of the field's times L/V on; the variance is that at τ = 0."""
    L = dict(zip("uvw", lengths(3.0), strict=True))[name]
    assert quad(lambda w: spectrum(name, L, w), 0.0, np.inf)[0] == pytest.approx(1.0, rel=1e-7)
    for share in (0.1, 0.5, 1.0, 3.0):
        ticks = round(share * L / (speed * tick_s))
        lag = ticks * tick_s * speed
        wanted = quad(lambda w: spectrum(name, L, w), 0.0, np.inf, weight="cos", wvar=lag, limlst=200)[0]
        assert covariance(name, speed * tick_s / L, ticks) == pytest.approx(wanted, abs=2e-5)


@pytest.mark.parametrize("x", [1e-6, 1e-3, 0.1, 3.0])
def test_fresh_noise_makes_up_for_what_a_step_loses(x):
    """Φ I/4 Φᵀ + R Rᵀ = I/4; and R Rᵀ is the integral that defines it, where the two nearly cancel too."""
    step, root = across_step(x)
    np.testing.assert_allclose(step @ step.T / 4.0 + root @ root.T, np.eye(2) / 4.0, atol=1e-12)

    def integrand(s):
        # e^(As) b, by hand: A has the double eigenvalue −1.
        response = np.exp(-s) * np.array([s, 1.0 - s])
        return np.outer(response, response)

    np.testing.assert_allclose(root @ root.T, quad_vec(integrand, 0.0, x, epsabs=0.0)[0], rtol=1e-7)
    hold, fresh = along_step(x)
    assert hold**2 + fresh**2 == pytest.approx(1.0, rel=1e-12)
    assert fresh**2 == pytest.approx(2.0 * quad(lambda s: np.exp(-2.0 * s), 0.0, x)[0], rel=1e-9)
