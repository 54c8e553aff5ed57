"""What a UAV can do and what is suspicious of its numbers: by hand, and each slip against the same UAV without it."""

import numpy as np
import pytest

from armland.models.airframe.sizing import sized
from armland.models.airframe.survey import differs, survey, suspicious
from armland.scenario import load_scenario


def of(**overrides):
    return sized(load_scenario("landing", overrides))


def test_by_hand():
    found, weight = survey(of()), 9.81 * (0.48 + 7850.0 * np.pi * 0.022**2 * 0.004)
    assert found.weight == pytest.approx(weight)
    assert found.hover_share == pytest.approx(weight / 7.44)
    assert np.cos(np.deg2rad(found.tilt_deg)) == pytest.approx(weight / 7.44)
    assert np.tan(np.deg2rad(found.lean_deg)) == pytest.approx(2.2 / weight)
    assert found.carries == pytest.approx((0.9 * 7.44 - weight) / 9.81)


@pytest.mark.parametrize(
    ("slip", "words"),
    [
        ({"rotors": {"max_thrust_n": 1.35}}, "leaves room for control"),
        ({"rotors": {"max_thrust_n": 186.0}}, "thrust in grams"),
        ({"uav": {"inertia_kgm2": [[6.0, 0, 0], [0, 7.0, 0], [0, 0, 12.0]]}}, "beyond the rotors"),
        ({"uav": {"inertia_kgm2": [[6e-5, 0, 0], [0, 7e-5, 0], [0, 0, 1.2e-4]]}}, "a block of steel"),
        ({"rotors": {"radius_m": 4.0}}, "millimetres, inches"),
        ({"rotors": {"time_constant_s": 1.0}}, "rotor lag of 1 s"),
        ({"rotors": {"drag_torque_m": 0.2}}, "reaction torque"),
    ],
)
def test_slips(slip, words):
    assert any(words in line for line in suspicious(of(**slip), survey(of(**slip))))
    assert suspicious(of(), survey(of())) == []


def test_differences_between_file_and_belief_are_said():
    assert differs(of()) == []
    (line,) = differs(of(belief={"uav": {"mass_kg": 0.4}}))
    assert line == "its file says 0.48 kg, believed are 0.4 kg; the arm weighs it once it hangs there"
    (line,) = differs(of(belief={"rotors": {"max_thrust_n": 1.5}}))
    assert line.startswith("a rotor gives up to 1.86 N, believed are 1.5 N")
