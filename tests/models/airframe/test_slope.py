"""Torque made over torque meant follows the slope of the thrust curve; the oracle is a difference quotient of the curve itself."""

import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.airframe.slope import slope_layout, tell_slope, torque_share
from armland.scenario import load_scenario


def told(weight, number=4, **changes):
    out = np.zeros(1, np.dtype(slope_layout()))
    tell_slope(out, load_scenario("paper", changes), weight, number)
    return out[0]


def per_percent(curve, thrust):
    """Slope of the thrust curve, N per percent, where it gives `thrust`, N."""
    roots = np.roots(np.array(curve) - [0.0, 0.0, thrust])
    p = float(roots[roots > 0.0][0].real)
    return (np.polyval(curve, p + 1e-4) - np.polyval(curve, p - 1e-4)) / 2e-4


@pytest.mark.parametrize("curve", [(1.112e-4, 7.705e-3, 0.0924), (2e-4, 0.0, 0.0), (0.0, 0.02, 0.0)])
@pytest.mark.parametrize("rotors", [4, 6])
def test_torque_follows_the_slope_of_the_curve(curve, rotors):
    p = told(4.71, rotors, onboard={"slope_share": 1.0}, rotors={"curve": list(curve)})
    for thrust in (1.0, 2.35, 4.71, 6.5):
        expected = per_percent(curve, thrust / rotors) / per_percent(curve, 4.71 / rotors)
        assert torque_share(thrust, p) == pytest.approx(expected, rel=1e-6)


def test_part_of_the_slope_and_none():
    whole, half = (torque_share(2.35, told(4.71, onboard={"slope_share": s})) for s in (1.0, 0.5))
    assert half == pytest.approx(0.5 * (1.0 + whole), rel=1e-12)
    assert torque_share(2.35, told(4.71)) == 1.0


def test_a_curve_that_does_not_reach_hover_is_refused():
    with pytest.raises(ModelError, match=r"rotors.curve.*1.18 N"):
        told(4.71, onboard={"slope_share": 1.0}, rotors={"curve": [1e-4, 0.0, 2.0]})
    assert torque_share(2.35, told(4.71, rotors={"curve": [1e-4, 0.0, 2.0]})) == 1.0
