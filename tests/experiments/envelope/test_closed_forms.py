"""Closed forms beside the captures."""

import numpy as np
import pytest

from armland.models.capture import Grip

STEP = {"offset": 0.0005, "speed": 0.017, "tilt": np.deg2rad(1.7), "fastest": 0.05}
"""What is left between a bound and the failure beyond it."""


def test_the_controllers_idea_of_the_gear_is_the_plants(bench):
    assert bench.closed_forms().grip == Grip()


@pytest.mark.parametrize(("name", "factor"), [("offset", 1.15), ("speed", 1.25), ("tilt", 1.15), ("fastest", 1.25)])
def test_closed_forms_agree_with_the_captures(small, name, factor):
    axis = small.axis(name)
    for simulated, form in ((axis.bound.bound, axis.closed), (axis.bound_together.bound, axis.closed_together)):
        assert form / factor - STEP[name] < simulated < factor * form + STEP[name]


def test_the_more_there_is_of_one_the_less_is_left_of_another(bench):
    forms = bench.closed_forms()
    alone = {name: forms.bound(name) for name in ("offset", "speed", "tilt")}
    assert forms.bound("offset", speed=0.06) < alone["offset"]
    assert forms.bound("speed", offset=0.004) < alone["speed"]
    assert forms.bound("tilt", offset=0.0069) < alone["tilt"]
    assert forms.bound("slowest", offset=0.004, speed=0.06) >= forms.bound("slowest")
    # Beyond the speed at which the hinge is overloaded nothing holds.
    assert forms.bound("offset", closing=1.01 * forms.bound("fastest")) == 0.0
