"""The water of the scene: the waves that move the deck, and flat where nobody knows them."""

import numpy as np
import pytest

from armland.console.stage.water import CELLS, EVERY_S, HALF_M, Water
from armland.plant.sea.waves import drawn_waves
from armland.view.film.water import FREEBOARD_M


def heights(water) -> np.ndarray:
    return np.array(water._meshes[0].vertices).reshape(CELLS, CELLS, 3)[..., 2]


@pytest.fixture
def scenario(landing_scenario):
    return landing_scenario.replaced({"sea": {"state": "ss3"}})


def test_heights_are_those_of_the_waves_that_move_the_deck(server, scenario) -> None:
    water = Water(server.viser.scene, "/sea", scenario)
    base = np.array(scenario.sea.base_m)
    for time in (0.0, 3.0):
        water.show(time, 1.0)
        for i, j in ((0, 0), (5, 30), (20, 7)):
            x, y = (-HALF_M + 2.0 * HALF_M * n / (CELLS - 1) for n in (i, j))
            wave = drawn_waves(scenario).elevation(time, np.array([x + base[0]]), np.array([y + base[1]]))[0, 0]
            assert heights(water)[i, j] == pytest.approx(wave - base[2] - FREEBOARD_M, abs=1e-5)
    assert np.ptp(heights(water)) > 0.2


def test_a_share_of_the_sea_is_a_share_of_its_waves(server, scenario) -> None:
    water = Water(server.viser.scene, "/sea", scenario)
    water.show(3.0, 1.0)
    whole = np.ptp(heights(water))
    water.show(3.0, 0.5)
    assert np.ptp(heights(water)) == pytest.approx(0.5 * whole, rel=1e-5)
    water.show(3.0, 0.0)
    assert np.ptp(heights(water)) == 0.0


def test_surfaces_too_close_in_time_are_not_sent(server, scenario) -> None:
    water = Water(server.viser.scene, "/sea", scenario)
    water.show(1.0, 1.0)
    before = heights(water).copy()
    water.show(1.0 + 0.5 * EVERY_S, 1.0)
    np.testing.assert_array_equal(heights(water), before)
    water.show(1.0 + 1.5 * EVERY_S, 1.0)
    assert np.abs(heights(water) - before).max() > 0.0


def test_unknown_waves_are_flat_water(server, landing_scenario, scenario) -> None:
    gone = scenario.model_copy(update={"sea": scenario.sea.model_copy(update={"response_file": "/nowhere/table.csv"})})
    for of in (None, landing_scenario, gone):
        water = Water(server.viser.scene, "/sea", of)
        water.show(5.0, 1.0)
        assert np.ptp(heights(water)) == 0.0
