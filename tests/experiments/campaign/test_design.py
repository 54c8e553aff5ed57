"""Designs: the same values however they are asked for, each parameter's by itself, and spread as the design promises."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.experiments.campaign.design import CHUNK, Schedule

WIND = "[parameters]\nair.wind_mps = {uniform = [0.0, 1.0]}\n"
BOTH = WIND + "uav.extra_mass_kg = {uniform = [0.0, 1.0]}\n"


def column(schedule, name="air.wind_mps"):
    return np.array([task.values[name] for task in schedule.tasks()])


@pytest.mark.parametrize("design", ["random", "latin"])
def test_a_further_parameter_moves_no_others_values(described, design):
    head = f'design = "{design}"\n'
    np.testing.assert_array_equal(
        column(Schedule(described(head + WIND), 50)), column(Schedule(described(head + BOTH), 50))
    )


def test_parameters_are_independent(described):
    schedule = Schedule(described(BOTH), 4000)
    a, b = column(schedule), column(schedule, "uav.extra_mass_kg")
    assert abs(np.corrcoef(a, b)[0, 1]) < 0.05


@pytest.mark.parametrize("design", ["random", "sobol"])
def test_more_runs_begin_with_the_same_ones(described, design):
    few, many = (column(Schedule(described(f'design = "{design}"\n{WIND}'), n)) for n in (40, CHUNK + 70))
    np.testing.assert_array_equal(few, many[:40])


@pytest.mark.parametrize("design", ["random", "latin", "sobol"])
def test_a_task_is_the_same_alone(described, design):
    made = described(f'design = "{design}"\n{BOTH}')
    all_of_them = list(Schedule(made, CHUNK + 5).tasks())
    for run in (0, 7, CHUNK - 1, CHUNK + 3):
        assert Schedule(made, CHUNK + 5).task(run) == all_of_them[run]


def test_latin_has_one_flight_in_each_step_of_each_parameter(described):
    schedule = Schedule(described(f'design = "latin"\n{BOTH}'), 64)
    for name in ("air.wind_mps", "uav.extra_mass_kg"):
        assert sorted(int(64 * x) for x in column(schedule, name)) == list(range(64))
    random = column(Schedule(described(BOTH), 64))
    assert sorted(int(64 * x) for x in random) != list(range(64))


def test_sobol_has_one_flight_in_each_square_of_a_power_of_two(described):
    schedule = Schedule(described(f'design = "sobol"\n{BOTH}'), 64)
    squares = {(int(8 * t.values["air.wind_mps"]), int(8 * t.values["uav.extra_mass_kg"])) for t in schedule.tasks()}
    assert len(squares) == 64


def test_points_share_seeds_and_drawn_values(described):
    made = described("first_seed = 100\n" + WIND + "place.start_speed_mps = {sweep = [0.0, 0.1, 0.2]}")
    tasks = list(Schedule(made, 5).tasks())
    assert [t.run for t in tasks] == list(range(15))
    for k in range(5):
        three = tasks[3 * k : 3 * k + 3]
        assert {t.seed for t in three} == {100 + k}
        assert len({t.values["air.wind_mps"] for t in three}) == 1
        assert [t.values["place.start_speed_mps"] for t in three] == [0.0, 0.1, 0.2]


def test_what_is_flown_is_left_out(described):
    schedule = Schedule(described(), 6)
    assert [t.run for t in schedule.tasks({0, 3})] == [1, 2, 4, 5]


def test_another_seed_draws_others(described):
    assert not np.array_equal(
        column(Schedule(described(WIND), 5)), column(Schedule(described("first_seed = 1\n" + WIND), 5))
    )


@pytest.mark.parametrize("runs", [0, -3, 10_000_001])
def test_no_runs_and_too_many_are_refused(described, runs):
    with pytest.raises(ConfigurationError, match=f"--runs {runs}: a campaign has 1 to 10000000 flights"):
        Schedule(described(), runs)
