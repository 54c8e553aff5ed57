"""What a whole scenario holds: frozen, strict, consistent in itself, the paper's numbers by default, a belief of its own."""

import json
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from armland.errors import ConfigurationError
from armland.scenario import Scenario, load_scenario
from armland.scenario.control import Control
from armland.scenario.environment import Environment
from armland.scenario.mission import Run
from armland.scenario.quantities import Section
from armland.scenario.sensing import Camera
from armland.scenario.tree import HARDWARE, PLANT_ONLY
from armland.scenario.uav import Hover, Rotors


@pytest.fixture(scope="module")
def paper() -> Scenario:
    return load_scenario("paper")


@pytest.fixture(scope="module")
def landing() -> Scenario:
    return load_scenario("landing")


def sections(section):
    yield section
    for value in dict(section).values():
        for inner in value.values() if isinstance(value, dict) else value if isinstance(value, tuple) else (value,):
            if isinstance(inner, Section):
                yield from sections(inner)


def dump(scenario: Scenario) -> dict[str, Any]:
    return json.loads(scenario.model_dump_json())


def test_defaults_are_the_papers_numbers(paper) -> None:
    assert paper.control.k1 == paper.control.k2 == (1.0, 1.0, 1.0, 30.0, 30.0, 30.0)
    assert (paper.control.k3, paper.control.orientation_kp, paper.control.orientation_kd) == (35.0, 25.0, 7.0)
    # Table II's stiffness and damping in (33) for the paper's 0.48 kg: K₁K₂ + k₃ and m K₁ + K₂.
    k1, k2 = paper.control.k1[3], paper.control.k2[3]
    assert k1 * k2 + paper.control.k3 == pytest.approx(935.0)
    assert 0.48 * k1 + k2 == pytest.approx(44.4)
    np.testing.assert_array_equal(paper.environment.gravity_mps2, [0.0, 0.0, -9.81])


def test_calibrated_attitude_loop_can_hold_the_uav_up(paper) -> None:
    """k_p above m g l, or it falls; and one set of calibrated values serves every experiment of Table II."""
    assert min(paper.onboard.kp_nm[:2]) > 0.48 * 9.81 * 0.06
    for name in ("E1", "E2", "E3"):
        assert paper.experiments[name].onboard is None


def test_scenario_cannot_be_changed(paper) -> None:
    found = list(sections(paper))
    assert len(found) > 25
    for section in found:
        assert section.model_config["frozen"]
        assert section.model_config["extra"] == "forbid"
        assert section.model_config["strict"]
    with pytest.raises(ValidationError):
        paper.run.seed = 3


@pytest.mark.parametrize("value", ["1000", 1000.5, True, None, float("nan")])
def test_whole_number_is_not_guessed(value) -> None:
    with pytest.raises(ValidationError):
        Run(rate_hz=value)


@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf"), "35", True])
def test_gain_must_be_a_positive_finite_number(value) -> None:
    with pytest.raises(ValidationError):
        Control(k3=value)


ODD = {
    "rotors": (lambda: Rotors(min_thrust_n=2.0), r"min_thrust_n = 2 must be below max_thrust_n = 1\.86"),
    "hover": (lambda: Hover(lift_min_n=7.0), r"lift_min_n = 7 must be below thrust_max_n = 7"),
    "delay": (lambda: Camera(delay_ms=(75.0, 50.0)), "the least delay stands first"),
    "depths": (lambda: Camera(reference_m=(0.3, 0.3)), "the smaller depth stands first, and they differ"),
    "focus": (lambda: Camera(depth_min_m=2.0), r"depth_min_m = 2 must be below .* = 1\.65"),
    "no weight": (lambda: Environment(gravity_mps2=(0.0, 0.0, 0.0)), "gravity must point downwards"),
    "falling up": (lambda: Environment(gravity_mps2=(0.0, 0.0, 9.81)), "gravity must point downwards"),
    "falling aside": (lambda: Environment(gravity_mps2=(9.0, 0.0, -4.0)), "within 60 degrees"),
}


@pytest.mark.parametrize("case", ODD)
def test_numbers_of_a_table_that_exclude_each_other_are_refused(case) -> None:
    build, says = ODD[case]
    with pytest.raises(ValidationError, match=says):
        build()


def test_tilted_gravity_and_that_of_the_moon_are_accepted() -> None:
    for gravity in ((4.0, 0.0, -8.9), (0.0, 0.0, -1.62)):
        assert Environment(gravity_mps2=gravity).gravity_mps2 == gravity
    with pytest.raises(ValidationError):
        Environment(gravity_mps2=(0.0, 0.0, 1.62))


THRESHOLDS = [
    ({"bounds": {"lost_offset_m": 0.004}}, "bounds: align_offset_m = 0.004 must be below lost_offset_m = 0.004"),
    ({"bounds": {"pull_seen_n": 0.9}}, "bounds: pull_seen_n = 0.9 must be below pull_test_n = 0.8"),
    (
        {"bounds": {"share_carried": 0.5}},
        "bounds.share_carried = 0.5 must be below 1 - control.thrust.carry_share = 0.5",
    ),
    ({"place": {"standoff_m": 0.3}}, "place: standoff_m = 0.3 must be below wait_below_m = 0.2"),
    (
        {"link": {"rate_hz": 300}},
        "link.rate_hz = 300 does not divide run.rate_hz = 1000; nearest that do: 125, 200, 250",
    ),
    ({"control": {"station": {"rate_hz": 3}}}, "control.station.rate_hz = 3 does not divide"),
    ({"experiments": {"E1": {"onboard": {"rate_hz": 30}}}}, "experiments.E1.onboard.rate_hz = 30 does not divide"),
]


@pytest.mark.parametrize(("changes", "says"), THRESHOLDS)
def test_numbers_of_two_tables_that_exclude_each_other_are_refused(landing, changes, says) -> None:
    with pytest.raises(ConfigurationError) as error:
        landing.replaced(changes)
    assert f"\n  {says}" in str(error.value)


@pytest.mark.parametrize("name", ["E1", "my_law-2.b+c", "x" * 60, "_"])
def test_experiment_whose_name_is_a_file_name_is_accepted(landing, name) -> None:
    assert name in landing.replaced({"experiments": {name: {}}}).experiments


@pytest.mark.parametrize(
    "name", ["", ".", "..", ".hidden", "../../up", "a/b", "a\\b", "x" * 61, "a b", "E1\n", "ü", "a\0b"]
)
def test_experiment_whose_name_would_lead_elsewhere_is_refused_with_its_path(landing, name) -> None:
    with pytest.raises(ConfigurationError, match="part of a file's name") as error:
        landing.replaced({"experiments": {name: {}}})
    assert f"\n  experiments.{name}: " in str(error.value)


def test_belief_equals_the_hardware_unless_said_otherwise(landing) -> None:
    truth, belief = dump(landing), dump(landing.believed())
    for name in HARDWARE:
        assert belief[name] == truth[name]
    # What is foretold follows the plant's mean wind and its sea where the user says nothing.
    assert belief.pop("forecast") == {"wind_mps": landing.foretold_mps, "deck_moves": landing.sea.moves}
    assert {k: v for k, v in belief.items() if k not in PLANT_ONLY} == {
        k: v for k, v in truth.items() if k not in (*PLANT_ONLY, "forecast")
    }


def test_every_section_is_hardware_or_the_plants_own_or_the_controllers() -> None:
    own = {
        "title",
        "calibration",
        "airframe",
        "forecast",
        "run",
        "control",
        "estimation",
        "place",
        "descent",
        "bounds",
        "limits",
        "trajectory",
        "harder",
    }
    assert {*HARDWARE, *PLANT_ONLY, *own, "experiments", "belief"} == set(Scenario.model_fields)


def test_belief_replaces_what_it_names_and_nothing_else(landing) -> None:
    wrong = landing.replaced({"belief": {"uav": {"mass_kg": 0.6}, "onboard": {"hover": {"k_position": 2.0}}}})
    assert wrong.uav.mass_kg is None
    assert wrong.onboard.hover.k_position == 0.8
    belief = wrong.believed()
    assert (belief.uav.mass_kg, belief.onboard.hover.k_position) == (0.6, 2.0)
    assert belief.belief == {}
    difference = {name for name in Scenario.model_fields if getattr(belief, name) != getattr(wrong, name)}
    assert difference == {"uav", "onboard", "belief", "forecast"}
    assert belief.onboard.hover.k_velocity == wrong.onboard.hover.k_velocity


def test_what_only_the_plant_has_never_reaches_the_belief(landing) -> None:
    fault = {"kind": "push", "size": 3.0}
    worse = landing.replaced(
        {
            "imperfections": {"force_bias_n": 7.0, "noise": False},
            "disturbance": {"force_n": [1.0, 2.0, 3.0]},
            "faults": [fault],
        }
    )
    assert dump(worse.believed()) == dump(landing.believed())


def leaves(data, path=()):
    for key, value in data.items():
        if isinstance(value, dict):
            yield from leaves(value, (*path, key))
        elif isinstance(value, int | float) and not isinstance(value, bool):
            yield (*path, key), value


def nested(path, value):
    for key in reversed(path):
        value = {key: value}
    return value


def test_each_number_of_the_hardware_can_be_believed_otherwise(landing) -> None:
    """Every number of the hardware has a place in the belief; there it changes the belief and leaves the plant alone."""
    plant, count = dump(landing), 0
    for section in HARDWARE:
        for path, value in leaves({section: plant[section]}):
            if path[-1] == "rate_hz":
                continue
            changed = landing.replaced(
                {"belief": nested(path, value * 0.99 if isinstance(value, float) else value + 1)}
            )
            assert {k: v for k, v in dump(changed).items() if k != "belief"} == {
                k: v for k, v in plant.items() if k != "belief"
            }
            assert (dump(changed.believed()) == dump(landing.believed())) == (value == 0.0)
            count += 1
    assert count > 70


@pytest.mark.parametrize(
    ("belief", "says"),
    [
        ({"uav": {"mass": 1.0}}, "belief.uav.mass: unknown key; known here: drag_nspm"),
        ({"uav": {"mass_kg": -1.0}}, "belief.uav.mass_kg: -1.0 lies outside 0.0001 to 1000"),
        ({"imperfections": {"noise": False}}, "belief.imperfections: no section of the hardware; those are arm, tool"),
        ({"wings": {}}, "belief.wings: no section of the hardware; those are arm, tool"),
        ({"control": {"k3": 3.0}}, "belief.control: no section of the hardware"),
        ({"camera": 3}, "belief.camera: Input should be a table (got 3)"),
        ({"rotors": {"min_thrust_n": 3.0}}, "belief.rotors: min_thrust_n = 3 must be below max_thrust_n = 1.86"),
        ({"link": {"rate_hz": 300}}, "belief.link.rate_hz = 300 does not divide run.rate_hz = 1000"),
        ({"uav": {"lever_m": [0.0, 0.0]}}, "belief.uav.lever_m.2: is missing"),
    ],
)
def test_belief_in_something_impossible_is_refused_with_its_path(landing, belief, says) -> None:
    with pytest.raises(ConfigurationError) as error:
        landing.replaced({"belief": belief})
    assert f"\n  {says}" in str(error.value)


def test_replaced_changes_one_value_and_keeps_source_and_neighbours(landing) -> None:
    changed = landing.replaced({"uav": {"inertia_kgm2": np.diag([0.006, 0.007, 0.012])}, "run": {"seed": 9}})
    assert changed.uav.inertia_kgm2 == ((0.006, 0.0, 0.0), (0.0, 0.007, 0.0), (0.0, 0.0, 0.012))
    assert changed.run.seed == 9
    assert landing.run.seed == 1
    assert (changed.text, changed.overrides, changed.own) == (landing.text, landing.overrides, landing.own)
    back = changed.replaced({"uav": {"inertia_kgm2": None}, "run": {"seed": 1}})
    assert dump(back) == dump(landing)


def test_with_seed_changes_the_seed_alone(landing) -> None:
    assert landing.with_seed(7) == landing.replaced({"run": {"seed": 7}})
    assert landing.with_seed(7).run.seed == 7
    for seed in (-1, 2**62 + 1, 2**80):
        with pytest.raises(ConfigurationError):
            landing.with_seed(seed)


@pytest.mark.parametrize("name", ["paper", "landing", "compare"])
def test_scenario_survives_writing_and_reading(name) -> None:
    scenario = load_scenario(name)
    assert dump(Scenario.model_validate_json(scenario.model_dump_json())) == dump(scenario)
