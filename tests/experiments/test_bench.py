"""The AR.Drone from published data: what its gains answer with, what its rotors give, and that it is one in paper and landing."""

import numpy as np
import pytest

from armland.experiments.bench import DATA, central, derived
from armland.scenario import load_scenario


@pytest.fixture(scope="module")
def paper():
    return load_scenario("paper")


@pytest.mark.parametrize("scenario", [("paper_bench", {}), ("landing", {"airframe": "ardrone2_bench"})])
def test_scenario_holds_what_follows_from_the_data(paper, scenario):
    flown, values_by_section = load_scenario(*scenario), derived(paper, central())
    if scenario[0] == "landing":
        # The thrust of a UAV on the hinge for good, and unequal rotors: not the airframe's.
        del values_by_section["control"], values_by_section["disturbance"]
    for section, values in values_by_section.items():
        for key, value in values.items():
            is_ = getattr(getattr(flown, section), key)
            assert is_ == (value if isinstance(value, str) else pytest.approx(value, rel=1e-3)), f"{section}.{key}"


@pytest.mark.parametrize("lag", [0.0, 0.05])
def test_gains_answer_with_the_published_delay_and_spread(paper, lag):
    """Mean and variance of the impulse response, integrated: d + T₁, and T₁² for the first-order lag."""
    data = central() | {"linear": 0.0}
    kp, kd = (derived(paper, data)["onboard"][name][0] for name in ("kp_nm", "kd_nms"))
    inertia, step, state = 0.006, 1e-4, np.array([1.0, 0.0, 0.0])  # error against a set-point of 0, rate, torque
    moments = np.zeros(3)
    for n in range(30_000):
        angle, rate, torque = state
        asked = -kp * angle - kd * rate
        torque = torque + (step / lag) * (asked - torque) if lag else asked
        rate = rate + step * torque / inertia
        state = np.array([angle + step * rate, rate, torque])
        # The step response falls short by the angle: its integral is the mean delay, its first moment half the mean square.
        moments += step * angle * np.array([1.0, n * step, 0.0])
    mean, square = moments[0], 2.0 * moments[1]
    d, t1 = data["dead_s"], 1.0 / data["attitude_1ps"]
    assert mean == pytest.approx(d + t1, rel=2e-3)
    # E[t²] = d² + 2dT₁ + 2T₁² of the published response; k_p matches the term in s² of the transfer function's inverse.
    assert square == pytest.approx(2.0 * ((d + t1) ** 2 - (0.5 * d**2 + d * t1)), rel=5e-3)
    assert square == pytest.approx(d**2 + 2.0 * d * t1 + 2.0 * t1**2, rel=5e-3)


def test_rotors_have_most_room_in_the_middle(paper):
    def limit(thrust):
        return derived(paper, central() | {"thrust_n": thrust})["link"]["torque_limit_nm"][0]

    # Bench: about 0.34 N·m in hover at 0.480 kg.
    assert limit(0.48 * 9.81) == pytest.approx(0.347, abs=0.002)
    assert limit(3.9) > max(limit(2.35), limit(4.7))


def test_every_range_holds_its_value():
    assert all(d.low <= d.value <= d.high and d.low < d.high and d.source for d in DATA.values())
