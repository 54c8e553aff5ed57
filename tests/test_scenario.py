"""What a scenario may hold: frozen, strict, consistent in itself, the paper's numbers by default."""

import numpy as np
import pytest
from pydantic import ValidationError

from armland.config import load_scenario
from armland.scenario import Control, Rotors, Run, Section, ToolSection, Uav


@pytest.fixture(scope="module")
def paper():
    return load_scenario("paper")


def sections(section):
    yield section
    for value in dict(section).values():
        for inner in value.values() if isinstance(value, dict) else value if isinstance(value, tuple) else (value,):
            if isinstance(inner, Section):
                yield from sections(inner)


def test_defaults_are_the_papers_numbers(paper):
    assert paper.uav.mass_kg == 0.480
    np.testing.assert_array_equal(paper.uav.inertia_kgm2, np.diag([0.006, 0.007, 0.012]))
    # The arm carries the UAV from below: the pivot lies under the centre of mass.
    assert paper.uav.lever_m == (0.0, 0.0, -0.06)
    assert paper.control.k1 == paper.control.k2 == (1.0, 1.0, 1.0, 30.0, 30.0, 30.0)
    assert (paper.control.k3, paper.control.orientation_kp, paper.control.orientation_kd) == (35.0, 25.0, 7.0)
    # Table II's stiffness and damping in (33): K₁K₂ + k₃ and m K₁ + K₂.
    k1, k2 = paper.control.k1[3], paper.control.k2[3]
    assert k1 * k2 + paper.control.k3 == pytest.approx(935.0)
    assert paper.uav.mass_kg * k1 + k2 == pytest.approx(44.4)


def test_calibrated_attitude_loop_can_hold_the_uav_up(paper):
    """k_p above m g l, or it falls; and one set of calibrated values serves every experiment of Table II."""
    assert min(paper.onboard.kp_nm[:2]) > paper.uav.mass_kg * 9.81 * 0.06
    for name in ("E1", "E2", "E3"):
        assert paper.experiments[name].onboard is None


def test_scenario_cannot_be_changed(paper):
    found = list(sections(paper))
    assert len(found) > 15
    for section in found:
        assert section.model_config["frozen"]
        assert section.model_config["extra"] == "forbid"
        assert section.model_config["strict"]
    with pytest.raises(ValidationError):
        paper.run.seed = 3


@pytest.mark.parametrize("value", ["1000", 1000.5, True, None, float("nan")])
def test_whole_number_is_not_guessed(value):
    with pytest.raises(ValidationError):
        Run(rate_hz=value)


@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf"), "35", True])
def test_gain_must_be_a_positive_finite_number(value):
    with pytest.raises(ValidationError):
        Control(k3=value, thrust_n=1.0)


@pytest.mark.parametrize("seed", range(20))
def test_inertia_of_a_cloud_of_masses_is_accepted_and_what_breaks_the_triangle_is_not(seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(10, 3))
    tensor = sum(x @ x * np.eye(3) - np.outer(x, x) for x in points)
    tensor = 0.5 * (tensor + tensor.T)
    rows = tuple(tuple(float(v) for v in row) for row in tensor)
    assert Uav(inertia_kgm2=rows).inertia_kgm2 == rows
    # The same axes, the largest moment beyond the sum of the others.
    values, axes = np.linalg.eigh(tensor)
    values[2] = 1.1 * (values[0] + values[1])
    broken = axes @ np.diag(values) @ axes.T
    broken = 0.5 * (broken + broken.T)
    with pytest.raises(ValidationError, match="no rigid body"):
        Uav(inertia_kgm2=tuple(tuple(float(v) for v in row) for row in broken))


def test_flat_plate_is_a_rigid_body():
    """Its moments meet the triangle's bound exactly."""
    Uav(inertia_kgm2=((0.006, 0.0, 0.0), (0.0, 0.007, 0.0), (0.0, 0.0, 0.013)))


def test_inertia_must_be_symmetric():
    with pytest.raises(ValidationError, match="symmetric"):
        Uav(inertia_kgm2=((0.006, 0.001, 0.0), (0.0, 0.007, 0.0), (0.0, 0.0, 0.012)))


def test_rotors_limits_must_be_in_order():
    with pytest.raises(ValidationError, match=r"min_thrust_n = 2 must be below max_thrust_n = 1\.86"):
        Rotors(min_thrust_n=2.0)


def test_pivot_must_lie_beyond_the_sensor():
    with pytest.raises(ValidationError, match=r"length_m = 0\.05 must exceed sensor_length_m = 0\.0504"):
        ToolSection(length_m=0.05)
