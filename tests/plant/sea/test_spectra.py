"""Spectra against `waveresponse`, which derives them independently, and the height that they promise."""

import numpy as np
import pytest
import waveresponse
from scipy.integrate import quad

from armland.plant.sea.spectra import bretschneider, jonswap

OMEGA = np.linspace(0.3, 6.0, 400)


@pytest.mark.parametrize(("height", "period"), [(0.3, 6.3), (0.88, 7.5), (1.88, 8.8)])
def test_bretschneider_is_that_of_waveresponse(height, period):
    _, theirs = waveresponse.ModifiedPiersonMoskowitz(OMEGA, freq_hz=False)(height, period)
    np.testing.assert_allclose(bretschneider(OMEGA, height, period), theirs, rtol=1e-9)


@pytest.mark.parametrize("peak", [1.0, 3.3, 5.0])
def test_jonswap_is_that_of_waveresponse(peak):
    _, theirs = waveresponse.JONSWAP(OMEGA, freq_hz=False)(0.88, 7.5, gamma=peak)
    np.testing.assert_allclose(jonswap(OMEGA, 0.88, 7.5, peak), theirs, rtol=0.02)


@pytest.mark.parametrize("peak", [None, 1.0, 3.3, 5.0])
def test_spectrum_has_its_height_and_its_period(peak):
    """H_s = 4 √m₀, and the maximum of S lies at the modal period."""

    def density(omega):
        one = np.array([omega])
        return float((bretschneider(one, 2.0, 8.0) if peak is None else jonswap(one, 2.0, 8.0, peak))[0])

    m0 = quad(density, 0.05, 2.0, points=[np.pi / 4], limit=300)[0] + quad(density, 2.0, 60.0, limit=300)[0]
    assert 4.0 * np.sqrt(m0) == pytest.approx(2.0, rel=0.012)
    omega = np.linspace(0.5, 1.2, 7001)
    assert omega[np.argmax([density(w) for w in omega])] == pytest.approx(2.0 * np.pi / 8.0, abs=2e-4)
