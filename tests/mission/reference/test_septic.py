"""The septic: its derivatives, its ends, its integral, by numbers that are not its own."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from armland.mission.reference.septic import PEAK, SWELL, septic, septic_integral

OWN = Polynomial([0, 0, 0, 0, 35, -84, 70, -20])
DURATION = 2.5


@pytest.mark.parametrize("u", np.linspace(0.0, 1.0, 11))
def test_values_and_derivatives_are_the_polynomials(u):
    found = septic(u, DURATION)
    for k in range(3):
        assert found[k] == pytest.approx(OWN.deriv(k)(u) / DURATION**k if k else OWN(u), abs=1e-12)
    assert septic_integral(u) == pytest.approx(OWN.integ()(u), abs=1e-12)


def test_it_is_the_only_septic_at_rest_to_the_third_derivative_at_both_ends():
    """Eight conditions on eight coefficients, solved anew."""
    rows, right = [], []
    for u, value in ((0.0, 0.0), (1.0, 1.0)):
        for k in range(4):
            rows.append([Polynomial.basis(n).deriv(k)(u) if k else Polynomial.basis(n)(u) for n in range(8)])
            right.append(value if k == 0 else 0.0)
    np.testing.assert_allclose(np.linalg.solve(rows, right), OWN.coef, atol=1e-9)


@pytest.mark.parametrize(
    ("u", "expected"), [(-0.5, (0.0, 0.0, 0.0)), (0.0, (0.0, 0.0, 0.0)), (1.0, (1.0, 0.0, 0.0)), (7.0, (1.0, 0.0, 0.0))]
)
def test_it_rests_before_and_after(u, expected):
    assert septic(u, DURATION) == expected


def test_peak_rate_is_over_its_mean_what_is_said():
    u = np.linspace(0.0, 1.0, 2001)
    assert max(septic(x, 1.0)[1] for x in u) == pytest.approx(PEAK, abs=1e-9)


def test_peak_acceleration_is_what_is_said_and_where():
    u = np.linspace(0.0, 1.0, 2001)
    rises = [septic(x, 1.0)[2] for x in u]
    assert max(rises) == pytest.approx(SWELL, abs=1e-4)
    assert u[int(np.argmax(rises))] == pytest.approx((5.0 - 5.0**0.5) / 10.0, abs=1e-3)
