"""Theory of the take-off weight: what it must not depend on, and how it must order."""

import pytest

from armland.experiments.takeoff_weight.theory import READINGS, theory
from armland.models.inflow import Rotors, advance_of, disc_of

ROTORS = Rotors(4, 7.44, disc_of(0.1, 1.225), 0.7, advance_of(0.7, 0.115))


@pytest.mark.slow
def test_no_speed_lifts_no_more_and_drag_costs():
    still, fast = theory(ROTORS, 0.22, 0.0, 0.0), theory(ROTORS, 0.22, 0.9, 0.5)
    for name in READINGS:
        assert still.sustained[name] == pytest.approx(1.0, abs=1e-9)
        assert fast.sustained[name] > 1.0
        assert fast.sustained[f"{name}, no drag"] > fast.sustained[name]
        assert still.thrown[f"{name}, 0.5 m"]["thrown"] == still.thrown[f"{name}, 0.5 m"]["from rest"]
        assert fast.thrown[f"{name}, 0.5 m"]["thrown"] > fast.thrown[f"{name}, 0.5 m"]["from rest"]
