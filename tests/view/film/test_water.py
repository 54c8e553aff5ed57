import mujoco
import numpy as np
import pytest

from armland.scenario import load_scenario
from armland.view.film.stage import stage_of
from armland.view.film.water import CELLS, HALF_M, Water, add_water, ripples


@pytest.fixture(scope="module")
def stage(sea_log):
    return stage_of(sea_log, 16 / 9)


def test_water_lies_below_the_deck_by_its_freeboard_all_the_time(stage, sea_log) -> None:
    """The contour hull rides on the water: its deck stays as high above it, which a water at rest would not."""
    truth, model = sea_log.messages["truth"], stage.model
    field = model.geom("water")
    at = np.linspace(-HALF_M, HALF_M, CELLS)
    near = np.abs(at) < 1.0
    high = []
    for k in range(0, len(truth), 100):
        surface = stage.surface(k / 1000).reshape(CELLS, CELLS)
        z = field.pos[2] + surface[np.ix_(near, near)].mean() * model.hfield_size[0, 2]
        high.append(truth["deck"][k, 2] - z)
    assert np.mean(high) == pytest.approx(0.45, abs=0.03)
    assert np.ptp(high) < 0.25 * np.ptp(truth["deck"][:, 2])


def test_rows_of_the_field_lie_along_y(stage) -> None:
    waves = stage.water.waves
    at = np.linspace(-HALF_M, HALF_M, CELLS)
    direct = waves.elevation(2.0, at[[70]], at[[20]])[0, 0]
    surface = stage.surface(2.0).reshape(CELLS, CELLS)
    assert (surface[20, 70] - 0.5) * 2.0 * stage.water.half == pytest.approx(direct, abs=1e-6)
    assert abs((surface[70, 20] - 0.5) * 2.0 * stage.water.half - direct) > 1e-3


def test_heights_stay_in_the_field() -> None:
    steep = Water(None, np.zeros(3), 0.1)
    assert np.array_equal(steep.surface(3.0), np.full(CELLS * CELLS, 0.5, np.float32))


def test_platform_whose_waves_nobody_knows_has_flat_water() -> None:
    from armland.plant.scene.composition import scene_spec

    scenario = load_scenario("landing", {"sea": {"state": "tank"}})
    spec, _ = scene_spec(scenario, "free")
    assert add_water(spec, scenario).waves is None


def test_ripples_fit_edge_to_edge() -> None:
    tile = ripples().astype(float)
    inside = np.abs(np.diff(tile, axis=0)).mean()
    assert np.abs(tile[0] - tile[-1]).mean() < 1.5 * inside
    assert tile.std() > 3.0


def test_hull_carries_arm_and_cradle(stage) -> None:
    model = stage.model
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    half, middle = model.geom("floor").size, data.geom("floor").xpos
    assert (np.abs(data.body("stand").xpos - middle)[:2] + 0.2 < half[:2]).all()
    assert (half[:2] < 5.0).all()
